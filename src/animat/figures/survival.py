"""How long the lives of each cell are: survival curves with their bands, and mean lifespans."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter, PercentFormatter
from numpy.typing import NDArray

from animat.figures.style import (
    GREY,
    HATCHES,
    LINES,
    agent_colours,
    legend_columns,
    new_figure,
    shades,
    styled,
)
from animat.statistics.estimates import Estimate
from animat.statistics.numerals import shortened
from animat.statistics.survival import KaplanMeier

POINTS = 400
"""A curve is drawn through at most so many steps; more than a page can show only weighs."""


class Line(NamedTuple):
    """How a curve is drawn."""

    label: str
    curve: KaplanMeier
    colour: str
    style: str


def survival_figure(curves: Mapping[tuple[str, str], KaplanMeier], *, log: bool = False) -> Figure:
    """Share of lives still going on over steps, for each (world, agent).

    Colour is the agent, line style the world; a dot ends a curve of which some reached the cap.
    `log` draws the steps on a logarithmic axis, for cells that live orders of magnitude apart.
    """
    fills = agent_colours(agent for _, agent in curves)
    worlds = list(dict.fromkeys(world for world, _ in curves))
    lines = [
        Line(f"{agent}, {world} world", curve, fills[agent],
             LINES[worlds.index(world) % len(LINES)])
        for (world, agent), curve in curves.items()
    ]  # fmt: skip
    return _drawn(lines, log)


def level_curves_figure(
    curves: Mapping[str, KaplanMeier], *, ordered: bool = False, log: bool = False
) -> Figure:
    """The same for each level of a factor; `ordered` levels are numbers, pale to dark."""
    fills = shades(list(curves)) if ordered else agent_colours(curves)
    said = shortened(curves)
    lines = [
        Line(said[label], curve, fills[label], LINES[number % len(LINES)])
        for number, (label, curve) in enumerate(curves.items())
    ]
    return _drawn(lines, log)


@styled
def _drawn(lines: Sequence[Line], log: bool) -> Figure:
    fig = new_figure(6.4, 4.2)
    ax = fig.subplots()
    for label, curve, colour, style in lines:
        keep = thinned(len(curve.times))
        times = curve.times[keep]
        ax.fill_between(
            times, curve.low[keep], curve.high[keep], step="post", color=colour, alpha=0.18, lw=0
        )
        ax.step(times, curve.survival[keep], where="post", color=colour, ls=style, label=label)
        if curve.survival[-1] > 0:
            ax.plot(times[-1], curve.survival[-1], "o", color=colour, ms=5, clip_on=False)
    if any(line.curve.survival[-1] > 0 for line in lines):
        ax.plot([], [], "o", color=GREY, ms=5, label="alive at the cap")
    longest = max(line.curve.times[-1] for line in lines)
    if log:
        first = min(line.curve.times[1] for line in lines)
        ax.set_xscale("log")
        ax.xaxis.set_minor_formatter(NullFormatter())
        ax.set_xlim(0.8 * first, 1.05 * longest)
    else:
        ax.set_xlim(0, 1.01 * longest)
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    ax.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    ax.set_ylim(0, 1.02)
    ax.set_xlabel("steps")
    ax.set_ylabel("lives still going on")
    ax.grid()
    columns = legend_columns([line.label for line in lines])
    fig.legend(loc="outside lower center", ncols=columns)
    return fig


def thinned(length: int) -> NDArray[np.int64]:
    """Indices of at most `POINTS` of `length` entries, evenly, first and last included."""
    return np.unique(np.linspace(0, length - 1, min(length, POINTS)).round().astype(np.int64))


class Bar(NamedTuple):
    """The mean lifespan of a cell, in steps."""

    world: str
    agent: str
    mean: Estimate


class Panel(NamedTuple):
    """One set of bars, such as the paper's 20 lives a cell."""

    title: str
    bars: Sequence[Bar]


@styled
def lifespans_figure(panels: Sequence[Panel]) -> Figure:
    """The panels side by side on one scale; whiskers are the confidence intervals."""
    fig = new_figure(3.5 * len(panels) + 0.4, 3.9)
    axes = fig.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    agents = list(dict.fromkeys(bar.agent for panel in panels for bar in panel.bars))
    fills = agent_colours(agents)
    width = 0.8 / len(agents)
    for ax, panel in zip(axes, panels, strict=True):
        worlds = list(dict.fromkeys(bar.world for bar in panel.bars))
        for bar in panel.bars:
            number = agents.index(bar.agent)
            at = worlds.index(bar.world) + (number - (len(agents) - 1) / 2) * width
            value, low, high = bar.mean
            ax.bar(
                at, value, 0.92 * width, color=fills[bar.agent], edgecolor="black", linewidth=0.7,
                hatch=HATCHES[number % len(HATCHES)], label=bar.agent,
            )  # fmt: skip
            ax.errorbar(
                at, value, [[max(0.0, value - low)], [max(0.0, high - value)]],
                color="black", capsize=4, lw=1.2,
            )  # fmt: skip
            ax.annotate(
                f"{value:,.0f}", (at, max(value, high)), (0, 4), textcoords="offset points",
                ha="center", fontsize=8,
            )  # fmt: skip
        ax.set_xticks(range(len(worlds)), worlds)
        ax.set_xlim(-0.6, len(worlds) - 0.4)
        ax.set_title(panel.title)
        ax.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
        ax.grid(axis="y")
    tops = (max(b.mean.value, b.mean.high) for panel in panels for b in panel.bars)
    axes[0].set_ylim(0, 1.12 * max(tops))
    axes[0].set_ylabel("mean lifespan (steps)")
    handles, labels = axes[0].get_legend_handles_labels()
    entries = dict(zip(labels, handles, strict=True))
    fig.legend(
        list(entries.values()), list(entries), loc="outside lower center", ncols=len(entries)
    )
    return fig

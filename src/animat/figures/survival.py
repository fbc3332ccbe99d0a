"""Survival curves of the cells, with their bands."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter, PercentFormatter
from numpy.typing import NDArray

from animat.figures.style import (
    GREY,
    LINES,
    agent_colours,
    legend_columns,
    new_figure,
    shades,
    styled,
)
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

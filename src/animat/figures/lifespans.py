"""Figure 5: mean lifespans, bars paired by world."""

from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.figure import Figure

from animat.figures.style import HATCHES, agent_colours, new_figure, styled
from animat.statistics.estimates import Estimate


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

"""Survival curves of the cells, with their bands."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter, PercentFormatter
from numpy.typing import NDArray

from animat.report.figures.style import GREY, LINES, agent_colours, new_figure, styled
from animat.report.survival import KaplanMeier

POINTS = 400
"""A curve is drawn through at most so many steps; more than a page can show only weighs."""


@styled
def survival_figure(curves: Mapping[tuple[str, str], KaplanMeier], *, log: bool = False) -> Figure:
    """Share of lives still going on over steps, for each (world, agent).

    Colour is the agent, line style the world; a dot ends a curve of which some reached the cap.
    `log` draws the steps on a logarithmic axis, for cells that live orders of magnitude apart.
    """
    fig = new_figure(6.4, 4.2)
    ax = fig.subplots()
    fills = agent_colours(agent for _, agent in curves)
    worlds = list(dict.fromkeys(world for world, _ in curves))
    for (world, agent), curve in curves.items():
        colour = fills[agent]
        keep = thinned(len(curve.times))
        times = curve.times[keep]
        ax.fill_between(
            times, curve.low[keep], curve.high[keep], step="post", color=colour, alpha=0.18, lw=0
        )
        ax.step(
            times, curve.survival[keep], where="post", color=colour,
            ls=LINES[worlds.index(world) % len(LINES)], label=f"{agent}, {world} world",
        )  # fmt: skip
        if curve.survival[-1] > 0:
            ax.plot(times[-1], curve.survival[-1], "o", color=colour, ms=5, clip_on=False)
    if any(curve.survival[-1] > 0 for curve in curves.values()):
        ax.plot([], [], "o", color=GREY, ms=5, label="alive at the cap")
    longest = max(curve.times[-1] for curve in curves.values())
    if log:
        first = min(curve.times[1] for curve in curves.values())
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
    fig.legend(loc="outside lower center", ncols=3)
    return fig


def thinned(length: int) -> NDArray[np.int64]:
    """Indices of at most `POINTS` of `length` entries, evenly, first and last included."""
    return np.unique(np.linspace(0, length - 1, min(length, POINTS)).round().astype(np.int64))

"""One life at a glance: its needs, what it did about them, and where."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pyarrow as pa
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.patches import Patch
from numpy.typing import NDArray

from animat.report.figures.style import (
    BLACK,
    GREEN,
    GREY,
    PALE,
    VERMILLION,
    colours,
    new_figure,
    styled,
    type_colours,
)
from animat.report.figures.worlds import WorldDrawing, draw_world
from animat.report.lives import column

POINTS = 2_000
"""Curves and the strip are drawn through at most so many rows of the trace."""

_NEEDS = ("#E69F00", "#0072B2", "#009E73", "#CC79A7", "#D55E00", "#000000", "#56B4E9")
_BEHAVIOURS = {
    "wander": PALE,
    "approach": "#F0E442",
    "eat": "#E69F00",
    "shelter": "#0072B2",
    "interact": "#009E73",
    "leave": "#CC79A7",
}


_EVENTS = (
    "encounter",
    "reached",
    "success",
    "failure",
    "disregarded",
    "unreached",
    "blocked",
    "trained",
    "death",
)
"""What is marked, from top to bottom; a step's events are joined by blanks."""


@styled
def life_figure(
    trace: pa.Table,
    *,
    set_points: Mapping[str, float],
    drives: Sequence[str],
    world: WorldDrawing | None = None,
    title: str = "",
) -> Figure:
    """Variables with their set points (dashed), drives, behaviours and events, and the path.

    `set_points` names the variables, `drives` the drives in the same order, so that a drive has
    the colour of what it watches. The path is drawn where `world` is given.
    """
    fig = new_figure(10.6 if world else 7.2, 5.4)
    stack: FigureBase = fig
    if world:
        halves: Any = fig.subfigures(1, 2, width_ratios=[1.2, 1])
        stack, right = halves
        _path(right.subplots(), trace, world)
    needs, urges, strip, events = stack.subplots(4, 1, sharex=True, height_ratios=[3, 3, 0.7, 1.3])
    rows = trace.take(pa.array(thinned(trace.num_rows)))
    step = column(rows, "step")
    for number, (name, point) in enumerate(set_points.items()):
        colour = _NEEDS[number % len(_NEEDS)]
        needs.plot(step, column(rows, name), color=colour, label=name)
        needs.axhline(point, color=colour, lw=0.9, ls="--")
    for number, name in enumerate(drives):
        urges.plot(step, column(rows, name), color=_NEEDS[number % len(_NEEDS)], label=name)
    urges.axhline(0, color=GREY, lw=0.8)
    needs.set_ylabel("variable\n(dashed: set point)")
    urges.set_ylabel("drive")
    for ax in (needs, urges):
        ax.legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncols=4, borderaxespad=0.2)
    handles = _strip(strip, rows)
    _events(events, trace)
    events.set_xlabel("step")
    events.xaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
    first, last = step[0], step[-1]
    events.set_xlim(first, last if last > first else first + 1)
    stack.align_ylabels([needs, urges])
    events.legend(
        handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.75), ncols=len(handles),
        handlelength=1.0, handletextpad=0.4, columnspacing=1.0,
    )  # fmt: skip
    if title:
        fig.suptitle(title, fontsize=11)
    return fig


def thinned(length: int) -> NDArray[np.int64]:
    """Indices of at most `POINTS` of `length` rows, evenly, first and last included."""
    return np.unique(np.linspace(0, length - 1, min(length, POINTS)).round().astype(np.int64))


def runs(labels: NDArray) -> list[tuple[int, int, str]]:
    """`labels` [n] as runs of equal ones: (first, past the last, label)."""
    edges = [0, *(np.flatnonzero(labels[1:] != labels[:-1]) + 1).tolist(), len(labels)]
    return [(a, b, labels[a]) for a, b in pairwise(edges)]


def _strip(ax: Axes, rows: pa.Table) -> list[Patch]:
    step = column(rows, "step")
    behaviour = column(rows, "behaviour")
    names = [name for name in _BEHAVIOURS if name in set(behaviour)]
    names += sorted(set(behaviour) - set(names))
    fills = colours(names, _BEHAVIOURS)
    ends = np.append(step[1:], step[-1] + 1)
    bars: dict[str, list[tuple[float, float]]] = {name: [] for name in names}
    for first, past, name in runs(behaviour):
        bars[name].append((step[first], ends[past - 1] - step[first]))
    for name in names:
        ax.broken_barh(bars[name], (0, 1), color=fills[name], lw=0)
    ax.set_ylim(0, 1)
    ax.set_yticks([])
    ax.set_ylabel("does", rotation=0, ha="right", va="center")
    return [Patch(color=fills[name], label=name) for name in names]


def _events(ax: Axes, trace: pa.Table) -> None:
    step = column(trace, "step")
    event = column(trace, "event")
    told = {text: set(text.split()) for text in dict.fromkeys(event.tolist())}
    names = [name for name in _EVENTS if any(name in several for several in told.values())]
    for level, name in enumerate(names):
        at = step[np.isin(event, [text for text, several in told.items() if name in several])]
        ax.plot(at, np.full(at.size, level), "|", color=BLACK, ms=6, mew=0.8, clip_on=False)
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(len(names) - 0.4, -0.6)


def _path(ax: Axes, trace: pa.Table, world: WorldDrawing) -> None:
    draw_world(ax, world, type_colours(sorted(set(world.types))))
    x, y = column(trace, "x"), column(trace, "y")
    ax.plot(x, y, color=BLACK, lw=0.6, alpha=0.55, rasterized=len(x) > 5 * POINTS)
    reward = column(trace, "reward")
    for value, symbol, colour, label in (
        (1, "^", GREEN, "success"),
        (-1, "v", VERMILLION, "failure"),
    ):
        at = reward == value
        if at.any():
            ax.plot(
                x[at], y[at], symbol, color=colour, mec="white", mew=0.6, ms=6, ls="", label=label
            )
    ax.plot(x[:1], y[:1], "o", color="white", mec=BLACK, ms=7, ls="", label="start")
    ax.plot(x[-1:], y[-1:], "X", color=BLACK, mec="white", ms=8, ls="", label="end")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4, handletextpad=0.1)

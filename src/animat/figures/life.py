"""One life at a glance: its needs, what it did about them, and where."""

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pyarrow as pa
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure, FigureBase
from matplotlib.patches import Patch

from animat.figures.columns import Columns, condensed
from animat.figures.style import (
    BLACK,
    GREY,
    HATCHES,
    LINES,
    need_colours,
    new_figure,
    styled,
    type_colours,
)
from animat.figures.worlds import WorldDrawing, draw_world, type_handles
from animat.statistics.lives import column

LEAST = 0.06
"""What runs in a column of the strip at all takes at least so much of its height."""

_MOVING = {"wander": "#E6E6E6", "approach": "#B4B4B4", "leave": "#7D7D7D"}

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
"""What is marked, from top to bottom."""


@styled
def life_figure(
    trace: pa.Table | Iterable[pa.Table],
    *,
    set_points: Mapping[str, float],
    drives: Mapping[str, str],
    behaviours: Mapping[str, str],
    span: tuple[int, int] | None = None,
    world: WorldDrawing | None = None,
    title: str = "",
) -> Figure:
    """Variables with their set points (dashed), drives, behaviours and events, and the path.

    `set_points` names the variables; `drives` and `behaviours` name what each of them is about, and
    have its colour. A `trace` may come in parts, read one after the other; `span` is then its first
    step and the one after its last. The path is drawn where `world` is given.
    """
    if isinstance(trace, pa.Table):
        step = column(trace, "step")
        trace, span = [trace], (int(step[0]), int(step[-1]) + 1)
    if span is None:
        raise ValueError("a trace in parts needs its span")
    seen = condensed(trace, span, [*set_points, *drives])
    fig = new_figure(10.6 if world else 7.2, 5.4)
    stack: FigureBase = fig
    if world:
        halves: Any = fig.subfigures(1, 2, width_ratios=[1.2, 1])
        stack, right = halves
        _path(right, seen, world)
    needs, urges, strip, events = stack.subplots(4, 1, sharex=True, height_ratios=[3, 3, 0.9, 1.3])
    fills = need_colours(set_points)
    for name, point in set_points.items():
        needs.plot(*seen.curves[name], color=fills[name], label=name)
        needs.axhline(point, color=fills[name], lw=0.9, ls="--")
    for name, (need, number) in _numbered(drives).items():
        style = LINES[number % len(LINES)]
        urges.plot(*seen.curves[name], color=fills[need], ls=style, label=name)
    urges.axhline(0, color=GREY, lw=0.8)
    needs.set_ylabel("variable\n(dashed: set point)")
    urges.set_ylabel("drive")
    for ax in (needs, urges):
        ax.legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncols=4, borderaxespad=0.2)
    handles = _strip(strip, seen, behaviours, fills)
    _events(events, seen)
    events.set_xlabel("step")
    events.xaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
    events.set_xlim(seen.first, max(seen.last, seen.first + 1))
    stack.align_ylabels([needs, urges])
    events.legend(
        handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.75),
        ncols=min(6, len(handles)), handlelength=1.0, handletextpad=0.4, columnspacing=1.0,
    )  # fmt: skip
    if title:
        fig.suptitle(title, fontsize=11)
    return fig


def _numbered(about: Mapping[str, str]) -> dict[str, tuple[str, int]]:
    """What each name is about, and how many before it are about the same."""
    before: Counter[str] = Counter()
    numbered = {}
    for name, need in about.items():
        numbered[name] = need, before[need]
        before[need] += 1
    return numbered


def _strip(
    ax: Axes, seen: Columns, behaviours: Mapping[str, str], fills: Mapping[str, str]
) -> list[Patch]:
    """What runs in each column, stacked by its share of the column's steps."""
    looks: dict[str, dict[str, Any]] = {
        name: {"facecolor": colour, "hatch": ""} for name, colour in _MOVING.items()
    } | {
        name: {"facecolor": fills[need], "hatch": HATCHES[number % len(HATCHES)]}
        for name, (need, number) in _numbered(behaviours).items()
    }
    names = sorted(seen.shares, key=list(looks).index)
    shares = np.array([seen.shares[name] for name in names])
    heights = np.where(shares > 0, np.maximum(shares, LEAST), 0.0)
    heights /= heights.sum(axis=0)
    # Columns that look like the one before are one with it.
    begun = np.flatnonzero(np.any(np.diff(heights, axis=1, prepend=-1.0) != 0, axis=0))
    left, right = seen.edges[begun], np.append(seen.edges[begun[1:]], seen.edges[-1])
    tops = np.cumsum(heights[:, begun], axis=0)
    for name, high, tall in zip(names, tops, heights[:, begun], strict=True):
        low = high - tall
        corners = np.stack([[left, low], [right, low], [right, high], [left, high]])
        ax.add_collection(
            PolyCollection(list(corners.transpose(2, 0, 1)[tall > 0]), lw=0, **looks[name])
        )
    ax.set_ylim(0, 1)
    ax.set_yticks([])
    ax.set_ylabel("does", rotation=0, ha="right", va="center")
    return [Patch(label=name, **looks[name]) for name in names]


def _events(ax: Axes, seen: Columns) -> None:
    names = sorted(seen.events, key=_EVENTS.index)
    for level, name in enumerate(names):
        at = seen.events[name]
        ax.plot(at, np.full(at.size, level), "|", color=BLACK, ms=6, mew=0.8, clip_on=False)
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(len(names) - 0.4, -0.6)


def _path(part: FigureBase, seen: Columns, world: WorldDrawing) -> None:
    """The way it went; marks are black and white, which no object is."""
    ax = part.subplots()
    fills = type_colours(sorted(set(world.types)))
    draw_world(ax, world, fills)
    x, y = seen.path.T
    ax.plot(x, y, color=BLACK, lw=0.6, alpha=0.55, rasterized=len(x) > 10_000)
    ax.plot(x[:1], y[:1], "o", color="white", mec=BLACK, ms=9, ls="", label="start")
    ax.plot(x[-1:], y[-1:], "D", color=BLACK, mec="white", ms=10, ls="", label="end")
    for reward, symbol, inside, edge, label in (
        (1, "P", "white", BLACK, "success"),
        (-1, "X", BLACK, "white", "failure"),
    ):
        at = seen.rewards[reward]
        if len(at):
            ax.plot(*at.T, symbol, color=inside, mec=edge, mew=0.6, ms=6, ls="", label=label)
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4, handletextpad=0.1)
    part.legend(handles=type_handles(fills), loc="outside lower center", ncols=2)

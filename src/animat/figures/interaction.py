"""The mean lifespan at the levels of one factor, a line for each level of another."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter, NullLocator
from numpy.typing import NDArray

from animat.figures.style import (
    LINES,
    agent_colours,
    legend_columns,
    new_figure,
    shades,
    spread_out,
    styled,
)
from animat.statistics.estimates import Estimate
from animat.statistics.numerals import shortened

MARKERS = "os^Dv<>P"

TICKS_AT_MOST = 8
"""Of more numeric levels than this not each has a tick."""

WIDTH = 80
"""Letters that fit below the axis; longer words are turned."""

APART = 0.05
"""How far apart lines stand over a word, so that their intervals can be told apart."""


class InteractionLine(NamedTuple):
    """A level of the one factor; `means` in steps by the place of the other's level."""

    label: str
    means: Mapping[int, Estimate]


@styled
def interaction_figure(
    name: str,
    levels: Sequence[str],
    places: Sequence[float] | None,
    lines: Sequence[InteractionLine],
    legend: str,
    *,
    ordered: bool = False,
) -> Figure:
    """Means with their intervals over the levels of the factor `name`, a line for each of `lines`.

    `places` are where levels are numbers, NaN for one that is not set, which stands apart at the
    right; None spreads words evenly. `legend` is the factor whose levels the lines are, `ordered`
    if those are numbers.
    """
    at = np.arange(len(levels), dtype=float) if places is None else np.array(places)
    known = ~np.isnan(at)
    there = at[known]
    log = places is not None and spread_out(there.tolist())
    last = there.max(initial=0.0)
    room = last * 2 if log else last + max(0.15 * np.ptp(there) if len(there) else 0.0, 1e-9)
    at = np.where(known, at, room)
    fig = new_figure(6.4, 4.2)
    ax = fig.subplots()
    labels = [line.label for line in lines]
    said = shortened(labels)
    colour = shades(labels) if ordered else agent_colours(labels)
    for number, line in enumerate(lines):
        shown = sorted(line.means, key=lambda level: at[level])
        mean, low, high = np.array([line.means[level] for level in shown]).T
        whiskers = np.nan_to_num([np.maximum(mean - low, 0.0), np.maximum(high - mean, 0.0)])
        shift = 0.0 if places is not None else APART * (number - (len(lines) - 1) / 2)
        x = at[shown] + shift
        joined = known[shown]
        ink, dash = colour[line.label], LINES[number % len(LINES)]
        mark = MARKERS[number % len(MARKERS)]
        ax.plot(x[joined], mean[joined], color=ink, ls=dash)
        ax.errorbar(x, mean, whiskers, color=ink, ls="none", capsize=3, lw=1.2, ms=5, marker=mark)
        ax.plot([], [], color=ink, ls=dash, marker=mark, ms=5, label=said[line.label])
    if log:
        ax.set_xscale("log")
    if places is None or len(levels) <= TICKS_AT_MOST:
        words = [shortened(levels)[level] for level in levels]
        turn = len("   ".join(words)) > WIDTH
        if not turn:
            words = _apart(words, np.log(at) if log else at)
        ax.set_xticks(at, words, rotation=30 if turn else 0, ha="right" if turn else "center")
        ax.xaxis.set_minor_locator(NullLocator())
    else:
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.xaxis.set_minor_formatter(NullFormatter())
    values = [number for line in lines for each in line.means.values() for number in each]
    if spread_out([number for number in values if np.isfinite(number)]):
        ax.set_yscale("log")
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    ax.set_xlabel(name)
    ax.set_ylabel("mean lifespan (steps)")
    ax.grid(axis="y")
    columns = legend_columns([line.label for line in lines])
    fig.legend(loc="outside lower center", ncols=columns, title=legend)
    return fig


def _apart(words: Sequence[str], at: NDArray[np.float64]) -> list[str]:
    """The words at their places [n], those left out that would run into the one before."""
    kept, end = list(words), -np.inf
    letter = max(float(np.ptp(at)), 1e-9) / WIDTH
    for level in np.argsort(at, kind="stable"):
        half = letter * (len(words[level]) + 1) / 2
        if at[level] - half < end:
            kept[level] = ""
        else:
            end = at[level] + half
    return kept

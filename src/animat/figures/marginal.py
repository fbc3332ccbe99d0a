"""What each reading does: to every claim in points, to the gains as a factor."""

from collections.abc import Mapping, Sequence

import numpy as np
import pyarrow as pa
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from animat.figures.style import (
    BLACK,
    BLUE,
    GREY,
    VERMILLION,
    new_figure,
    styled,
)
from animat.statistics.numerals import shortened

_POINTS = LinearSegmentedColormap.from_list("points", [VERMILLION, "white", BLUE])
_UNSURE = "#666666"
_TICKS = (
    (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0),
    (0.5, 0.7, 1.0, 1.4, 2.0),
    (0.8, 0.9, 1.0, 1.1, 1.2),
)
_FARTHEST = 30.0  # factors beyond it, of a few universes, are not worth the room


@styled
def points_figure(effects: pa.Table, claims: Sequence[str]) -> Figure:
    """Points by which a value of a reading changes the share of universes in which a claim holds.

    `effects` is of `multiverse.marginal.marginal_effects`. Only cells whose interval excludes 0
    are coloured; the numbers of the others are grey.
    """
    found = _by_contrast(effects)
    fig = new_figure(7.2, 0.21 * len(found) + 0.9)
    ax = fig.subplots()
    points, low, high = (
        np.array([[rows[claim][part] for claim in claims] for rows in found.values()])
        for part in ("effect", "low", "high")
    )
    sure = (low > 0.0) | (high < 0.0)
    ax.imshow(np.where(sure, points, 0.0), cmap=_POINTS, vmin=-1.0, vmax=1.0, aspect="auto")
    for place, number in np.argwhere(~np.isnan(points)).tolist():
        told = round(100 * float(points[place, number]))
        ax.text(
            number, place, f"{told:+d}", ha="center", va="center", fontsize=8,
            color=BLACK if sure[place, number] else _UNSURE,
            fontweight="bold" if sure[place, number] else "normal",
        )  # fmt: skip
    ax.set_xticks(range(len(claims)), claims)
    ax.xaxis.tick_top()
    ax.set_yticks(range(len(found)), _words(found), fontsize=8)
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    return fig


@styled
def factors_figure(effects: pa.Table, outcomes: Mapping[str, str]) -> Figure:
    """Factors by which a value of a reading changes ratios of lifespans, with their intervals.

    `outcomes` are ratios of the table of universes, each in words.
    """
    found = _by_contrast(effects)
    fig = new_figure(7.2, 0.2 * len(found) + 1.0)
    axes = fig.subplots(1, len(outcomes), sharey=True, squeeze=False)[0]
    at = np.arange(len(found))
    for ax, (name, words) in zip(axes, outcomes.items(), strict=True):
        value, low, high = (
            np.array([rows[name][part] for rows in found.values()])
            for part in ("effect", "low", "high")
        )
        sure = (low > 1.0) | (high < 1.0)
        ax.axvline(1.0, color=BLACK, lw=0.8)
        for chosen, colour in ((sure, BLUE), (~sure, GREY)):
            ax.hlines(at[chosen], low[chosen], high[chosen], color=colour, lw=1.6)
            ax.plot(value[chosen], at[chosen], "o", color=colour, ms=4)
        ax.set_xscale("log")
        ends = np.nanmin(np.append(low, 0.95)) / 1.1, np.nanmax(np.append(high, 1.05)) * 1.1
        ax.set_xlim(max(ends[0], 1.0 / _FARTHEST), min(ends[1], _FARTHEST))
        ax.xaxis.set_major_locator(FixedLocator(_ticks(*ax.get_xlim())))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda factor, _: f"{factor:g}"))
        ax.xaxis.set_minor_locator(NullLocator())
        ax.set_xlabel(words)
        ax.grid(axis="x")
    axes[0].set_yticks(at, _words(found), fontsize=8)
    axes[0].set_ylim(len(found) - 0.5, -0.5)
    for ax in axes:
        ax.tick_params(axis="y", length=0)
    return fig


def _ticks(low: float, high: float) -> list[float]:
    """Round factors between the ends of an axis, closer ones where few others lie there."""
    inside = [[tick for tick in ticks if low <= tick <= high] for ticks in _TICKS]
    return next((ticks for ticks in inside if len(ticks) >= 3), inside[-1])


def _by_contrast(effects: pa.Table) -> dict[tuple[str, str], dict[str, dict]]:
    """The rows by the reading and the value that are compared, and by outcome."""
    found: dict[tuple[str, str], dict[str, dict]] = {}
    for row in effects.to_pylist():
        found.setdefault((row["reading"], row["value"]), {})[row["outcome"]] = row
    return found


def _words(found: Mapping[tuple[str, str], Mapping[str, dict]]) -> list[str]:
    """What is compared, in words that leave room for the drawing."""
    against = [next(iter(rows.values()))["against"] for rows in found.values()]
    readings = shortened((reading for reading, _ in found), 22)
    values = shortened([*against, *(value for _, value in found)], 14)
    return [
        f"{readings[reading]}: {values[value]}, not {values[other]}"
        for (reading, value), other in zip(found, against, strict=True)
    ]

"""The specification curve: universes sorted by an effect, and the readings each has taken."""

from collections.abc import Sequence

import numpy as np
import pyarrow as pa
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from animat.figures.style import BLACK, BLUE, GREY, new_figure, styled
from animat.figures.verdicts import VERDICT_COLOURS
from animat.statistics.lives import column
from animat.statistics.numerals import shortened
from animat.statistics.readings import Readings, codes

MOST_COLUMNS = 100
"""Columns of the dashboard; more universes than this share one."""

_MARKS = {"holds": "o", "undecided": "s", "fails": "v"}
_SHADES = LinearSegmentedColormap.from_list("shades", ["white", BLUE])


@styled
def specification_figure(
    universes: pa.Table,
    readings: Readings,
    effect: str,
    claim: str,
    *,
    label: str,
    marks: Sequence[float] = (1.0,),
) -> Figure:
    """Universes from the smallest to the largest `effect`, a column of the table of universes.

    Above: each with its interval, coloured by the verdict on `claim`; lines at `marks`. Below: a
    row for every value of every reading; the darker, the more of the universes there have it.
    """
    value = column(universes, effect).astype(np.float64)
    order = np.argsort(value, kind="stable")
    code = codes(universes, readings)[order]
    names = shortened(readings, 24)
    rows = [
        f"{names[name]}: {value}"
        for name, values in readings.items()
        for value in shortened(values, 16).values()
    ]
    fig = new_figure(7.2, 3.0 + 0.165 * len(rows))
    above, below = fig.subplots(
        2, 1, sharex=True, height_ratios=[2.6, 0.165 * len(rows)], squeeze=True
    )
    _curve(above, universes.take(pa.array(order)), effect, claim)
    for mark in marks:
        above.axhline(mark, color=BLACK, lw=0.8, ls="--" if mark != 1.0 else "-", zorder=1)
    above.set_ylabel(label)
    above.grid(axis="y")
    fig.legend(loc="outside upper center", ncols=4, markerscale=2.5)
    _dashboard(below, code, readings, rows)
    below.set_xlabel(f"universes, from the smallest to the largest, of {len(value):,}")
    return fig


def _curve(ax, universes: pa.Table, effect: str, claim: str) -> None:
    value, low, high = (
        column(universes, effect + part).astype(np.float64) for part in ("", "_low", "_high")
    )
    at = np.arange(len(value)) + 0.5
    ax.fill_between(at, low, high, color=GREY, alpha=0.35, lw=0, step="mid", label="95 % interval")
    verdicts = column(universes, claim)
    for verdict, colour in VERDICT_COLOURS.items():
        here = verdicts == verdict
        face = BLACK if verdict == "undecided" else colour
        ax.plot(
            at[here], value[here], _MARKS[verdict], color=face, ms=2.5, mew=0,
            label=f"{claim} {verdict}" if verdict != "undecided" else f"{claim} is undecided",
        )  # fmt: skip
    if np.all(value > 0.0) and value.max() > 5.0 * value.min():
        ax.set_yscale("log")
        ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        ax.yaxis.set_major_formatter(FuncFormatter(lambda number, _: f"{number:g}"))
        ax.yaxis.set_minor_locator(NullLocator())
    ax.set_xlim(0, len(value))
    ax.tick_params(axis="x", length=0)


def _dashboard(ax, code: np.ndarray, readings: Readings, rows: Sequence[str]) -> None:
    """Shade each value by its share in a column, from none to all."""
    count = len(code)
    edges = np.linspace(0, count, min(count, MOST_COLUMNS) + 1).round().astype(int)
    shares = np.array(
        [
            [(code[start:stop, place] == value).mean() for start, stop in zip(edges, edges[1:])]  # noqa: B905, RUF007
            for place, values in enumerate(readings.values())
            for value in range(len(values))
        ]
    )
    ax.pcolormesh(edges, np.arange(len(rows) + 1), shares, cmap=_SHADES, vmin=0.0, vmax=1.0,
                  rasterized=True)  # fmt: skip
    ends = np.cumsum([len(values) for values in readings.values()])
    for end in ends[:-1]:
        ax.axhline(end, color=GREY, lw=0.6)
    ax.set_yticks(np.arange(len(rows)) + 0.5, rows, fontsize=8)
    ax.set_ylim(len(rows), 0)
    ax.tick_params(axis="y", length=0)

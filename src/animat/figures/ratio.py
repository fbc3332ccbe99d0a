"""How much knowing affordances is worth, over the number of objects and random layouts."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

from animat.figures.style import (
    BLACK,
    BLUE,
    GREY,
    VERMILLION,
    new_figure,
    styled,
)
from animat.statistics.lives import column

PAPER = {"paper, abundant: nearly 100%": 2.0, "paper, scarce: nearly 50%": 1.5}


class Mark(NamedTuple):
    """A layout worth a name, such as World 1."""

    label: str
    objects: int
    ratio: float


@styled
def ratio_figure(table: pa.Table, *, marks: Sequence[Mark] = ()) -> Figure:
    """Ratio of mean lifespans AF / BLIND against the number of objects.

    `table` has the columns objects, layout, ratio: a row is one random layout. A dot is a layout,
    the line their median, the bands the middle half and the whole range of them.
    """
    objects = column(table, "objects")
    ratio = column(table, "ratio").astype(np.float64)
    counts = np.unique(objects)
    at = [ratio[objects == count] for count in counts]
    low, first, middle, third, high = np.array(
        [np.percentile(values, [0, 25, 50, 75, 100]) for values in at]
    ).T
    fig = new_figure(6.8, 4.3)
    ax = fig.subplots()
    ax.fill_between(counts, low, high, color=BLUE, alpha=0.12, lw=0, label="all layouts")
    ax.fill_between(counts, first, third, color=BLUE, alpha=0.25, lw=0, label="middle half")
    ax.plot(objects, ratio, "o", color=BLUE, ms=2.5, alpha=0.5, mew=0, label="one random layout")
    ax.plot(counts, middle, color=BLUE, lw=2, label="median")
    for (label, value), style in zip(PAPER.items(), ("--", ":"), strict=True):
        ax.axhline(value, color=VERMILLION, lw=1.2, ls=style, label=label)
    ax.axhline(1.0, color=GREY, lw=0.8)
    for mark, symbol in zip(marks, "DsP^v" * len(marks), strict=False):
        ax.plot(
            mark.objects, mark.ratio, symbol, color="white", mec=BLACK, mew=1.4, ms=8, zorder=5,
            label=mark.label,
        )  # fmt: skip
    ax.set_yscale("log")
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.yaxis.set_minor_locator(NullLocator())
    lowest = min([low.min(), 1.0, *(mark.ratio for mark in marks)])
    highest = max([high.max(), 2.0, *(mark.ratio for mark in marks)])
    ticks = [t for decade in (0.1, 1, 10, 100, 1000) for t in (decade, 2 * decade, 5 * decade)]
    ax.set_yticks([tick for tick in ticks if 0.8 * lowest <= tick <= 1.3 * highest])
    ax.set_ylim(0.85 * lowest, 1.2 * highest)
    ax.set_xlabel("objects in the world")
    ax.set_ylabel("mean lifespan AF / BLIND")
    ax.grid(axis="y")
    fig.legend(loc="outside lower center", ncols=3)
    return fig

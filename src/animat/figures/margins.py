"""What each factor does to the mean lifespan, over all the others."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from animat.figures.style import (
    BLUE,
    GREY,
    PALE,
    new_figure,
    spread_out,
    styled,
)
from animat.statistics.estimates import Estimate
from animat.statistics.numerals import shortened


@styled
def margins_figure(factors: Mapping[str, Mapping[str, Estimate]], overall: float) -> Figure:
    """A dot with its interval for each level, factor under factor.

    `factors` has the mean lifespan in steps of each level; `overall`, that of all lives, is a line.
    """
    rows = sum(len(levels) + 1 for levels in factors.values())
    fig = new_figure(7.2, 0.21 * rows + 0.8)
    ax = fig.subplots()
    ax.axvline(overall, color=GREY, lw=1.0, ls="--")
    ticks: list[tuple[float, str, bool]] = []
    place = 0
    for name, levels in factors.items():
        ticks.append((place, name, True))
        ax.axhline(place - 0.5, color=PALE, lw=0.8)
        for label, (value, low, high) in levels.items():
            place += 1
            ticks.append((place, label, False))
            ax.plot([low, high], [place, place], color=BLUE, lw=1.6, solid_capstyle="butt")
            ax.plot(value, place, "o", color=BLUE, ms=5)
        place += 1
    said = shortened(label for _, label, _ in ticks)
    ax.set_yticks([at for at, _, _ in ticks], [said[label] for _, label, _ in ticks])
    for text, (_, _, heading) in zip(ax.get_yticklabels(), ticks, strict=True):
        text.set_fontweight("bold" if heading else "normal")
    ax.tick_params(axis="y", length=0)
    ax.set_ylim(place - 0.4, -0.6)
    values = [number for levels in factors.values() for each in levels.values() for number in each]
    if spread_out([number for number in values if np.isfinite(number)]):
        ax.set_xscale("log")
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    ax.set_xlabel("mean lifespan (steps); dashed: all lives")
    ax.grid(axis="x")
    return fig

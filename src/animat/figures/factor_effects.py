"""What each factor does to the mean lifespan: at its levels, and over a range."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter
from numpy.typing import NDArray

from animat.figures.style import (
    BLUE,
    GREY,
    PALE,
    VERMILLION,
    new_figure,
    spread_out,
    styled,
)
from animat.statistics.estimates import Estimate
from animat.statistics.numerals import shortened


@styled
def factor_effects_figure(factors: Mapping[str, Mapping[str, Estimate]], overall: float) -> Figure:
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


@styled
def trend_figure(
    name: str,
    values: NDArray[np.float64],
    means: NDArray[np.float64],
    quarters: Sequence[tuple[float, Estimate]],
) -> Figure:
    """A dot for each case: its value [c] of the factor and its mean lifespan [c] in steps.

    `quarters` are the middle of each quarter of the range and the mean of all lives in it.
    """
    fig = new_figure(6.4, 4.0)
    ax = fig.subplots()
    ax.plot(
        values, means, "o", color=BLUE, mew=0, ms=4 if len(values) < 500 else 2.5,
        alpha=float(np.clip(60 / len(values), 0.15, 0.6)), label="a case", clip_on=False,
    )  # fmt: skip
    middle = [at for at, _ in quarters]
    mean, low, high = np.array([estimate for _, estimate in quarters]).T
    whiskers = np.nan_to_num([np.maximum(mean - low, 0.0), np.maximum(high - mean, 0.0)])
    ax.errorbar(
        middle, mean, whiskers, color=VERMILLION, marker="s", ms=5, capsize=4, lw=1.6,
        label="mean of a quarter of the lives, with its interval",
    )  # fmt: skip
    if spread_out(values.tolist()):
        ax.set_xscale("log")
    if spread_out(means.tolist()):
        ax.set_yscale("log")
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    ax.set_xlabel(name)
    ax.set_ylabel("mean lifespan (steps)")
    ax.grid()
    legend = fig.legend(loc="outside lower center", ncols=2)
    for handle in legend.legend_handles:
        if handle is not None:
            handle.set_alpha(1.0)
    return fig

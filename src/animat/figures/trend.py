"""Mean lifespans of cases over a factor that has a range."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter
from numpy.typing import NDArray

from animat.figures.style import BLUE, VERMILLION, new_figure, spread_out, styled
from animat.statistics.estimates import Estimate


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

"""What the lives of each cell ended of."""

from collections.abc import Iterable, Mapping, Sequence

from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import PercentFormatter

from animat.figures.style import BLACK, HATCHES, PALE, need_colours, new_figure, styled
from animat.statistics.numerals import shortened
from animat.statistics.survival import ALIVE, DeathCount

_CAUSES = ("metabolism", "failure", "success")


@styled
def causes_figure(cells: Mapping[str, Sequence[DeathCount]]) -> Figure:
    """A stacked bar for each cell: colour is the variable, pattern the cause."""
    deaths = {d.label: d for counts in cells.values() for d in counts}
    labels = sorted(deaths, key=lambda label: (deaths[label].variable == ALIVE, label))
    fills = need_colours(d.variable for d in deaths.values() if d.variable != ALIVE)
    fills[ALIVE] = PALE
    styles = {
        label: {
            "facecolor": fills[deaths[label].variable],
            "hatch": _hatch(deaths[label], deaths.values()),
            "edgecolor": BLACK,
            "linewidth": 0.7,
        }
        for label in labels
    }
    fig = new_figure(7.2, 0.55 * len(cells) + 1.1 + 0.22 * ((len(labels) + 1) // 2))
    ax = fig.subplots()
    for row, counts in enumerate(cells.values()):
        shares = {death.label: death.share.value for death in counts}
        left = 0.0
        for label in labels:
            width = shares.get(label, 0.0)
            if width == 0.0:
                continue
            ax.barh(row, width, 0.7, left, clip_on=False, **styles[label])
            if width >= 0.06:
                ax.text(
                    left + width / 2, row, f"{100 * width:.0f}%", ha="center", va="center",
                    fontsize=8, bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.2},
                )  # fmt: skip
            left += width
    ax.set_yticks(range(len(cells)), list(shortened(cells).values()))
    ax.invert_yaxis()
    ax.set_xlim(0, 1)
    ax.xaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    ax.set_xlabel("lives")
    ax.tick_params(axis="y", length=0)
    fig.legend(
        handles=[Patch(label=label, **styles[label]) for label in labels],
        loc="outside lower center",
        ncols=2,
    )
    return fig


def _hatch(death: DeathCount, deaths: Iterable[DeathCount]) -> str:
    """The cause's pattern; the second side on which it kills through one variable has its own."""
    if death.cause not in _CAUSES:
        return ""
    other_side = any(
        (other.variable, other.cause) == (death.variable, death.cause) and other.side < death.side
        for other in deaths
    )
    return HATCHES[_CAUSES.index(death.cause) + len(_CAUSES) * other_side]

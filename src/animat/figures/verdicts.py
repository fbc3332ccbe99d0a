"""How often each claim holds, fails or is undecided over all universes."""

import pyarrow as pa
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import PercentFormatter

from animat.figures.style import (
    BLACK,
    GREEN,
    HATCHES,
    PALE,
    VERMILLION,
    new_figure,
    styled,
)

VERDICT_COLOURS = {"holds": GREEN, "undecided": PALE, "fails": VERMILLION}

_HATCHES = {"holds": HATCHES[0], "undecided": HATCHES[2], "fails": HATCHES[1]}


@styled
def verdicts_figure(shares: pa.Table, claims: dict[str, str]) -> Figure:
    """A bar for each claim, cut into its verdicts; `claims` says each in words.

    `shares` is of `multiverse.shares.verdict_shares`. The whiskers are Wilson's intervals of the
    shares that hold; the diamond is that share if estimates had no error.
    """
    fig = new_figure(7.2, 0.5 * len(claims) + 1.0)
    ax = fig.subplots()
    rows = {(row["claim"], row["verdict"]): row for row in shares.to_pylist()}
    for place, claim in enumerate(claims):
        left = 0.0
        for verdict, colour in VERDICT_COLOURS.items():
            width = rows[claim, verdict]["share"]
            ax.barh(
                place, width, 0.72, left, facecolor=colour, edgecolor=BLACK, linewidth=0.7,
                hatch=_HATCHES[verdict],
            )  # fmt: skip
            if width >= 0.06:
                ax.text(
                    left + width / 2, place + 0.2, f"{100 * width:.0f}%", ha="center",
                    va="center", fontsize=8,
                    bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0},
                )  # fmt: skip
            left += width
        holds = rows[claim, "holds"]
        ax.plot([holds["low"], holds["high"]], [place - 0.2] * 2, color=BLACK, lw=2.2)
        ax.plot(
            holds["share_by_value"], place - 0.2, "D", color="white", mec=BLACK, ms=5, zorder=3,
            clip_on=False,
        )  # fmt: skip
    ax.set_yticks(range(len(claims)), [f"{claim}  {words}" for claim, words in claims.items()])
    ax.invert_yaxis()
    ax.set_xlim(0.0, 1.0)
    ax.xaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    ax.set_xlabel("universes")
    ax.tick_params(axis="y", length=0)
    fig.legend(
        handles=[
            *(
                Patch(
                    facecolor=colour, edgecolor=BLACK, linewidth=0.7, hatch=_HATCHES[name],
                    label=name,
                )
                for name, colour in VERDICT_COLOURS.items()
            ),
            Line2D([], [], color=BLACK, lw=2.2, label="95 % interval of what holds"),
            Line2D([], [], ls="", marker="D", color="white", mec=BLACK, label="by its value alone"),
        ],
        loc="outside lower center",
        ncols=5,
    )  # fmt: skip
    return fig

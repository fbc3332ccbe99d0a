"""Figures 3 and 4: the five signals of an affordance being learnt, in the paper's order."""

from collections.abc import Sequence

import numpy as np
import pyarrow as pa
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from animat.figures.style import (
    BLACK,
    GREY,
    need_colours,
    new_figure,
    styled,
    type_colours,
)
from animat.statistics.lives import column


@styled
def learning_figure(
    trace: pa.Table,
    *,
    variable: str = "nutrition",
    drive: str = "hunger",
    behaviour: str = "eat",
    affordance: str = "grasp",
    types: Sequence[str] = ("TS", "TL", "CS", "CL"),
    steps: int = 500,
) -> Figure:
    """Object type, variable, drive, learning reward and likelihood over the last `steps` rows.

    Figure 3 is the default; Figure 4 has stamina, fatigue, shelter, shelter. `trace` needs the
    columns step, object, behaviour, reward, `variable`, `drive` and likelihood_`behaviour`.
    Shaded: the steps in which `behaviour` runs; the network holds its value in all others, and has
    none before it was first asked. What is about one need has one colour.
    """
    rows = trace.slice(max(0, trace.num_rows - steps))
    step = column(rows, "step")
    fig = new_figure(7.2, 6.4)
    axes = fig.subplots(5, 1, sharex=True, height_ratios=[1.3, 1, 1, 0.8, 1])
    acting = column(rows, "behaviour") == behaviour
    colour = need_colours([variable])[variable]
    shade = {"color": colour, "alpha": 0.18, "lw": 0}
    for ax in axes:
        for start, stop in spans(acting):
            ax.axvspan(step[start] - 0.5, step[stop - 1] + 0.5, zorder=0, **shade)
    _objects(axes[0], step, column(rows, "object"), types)
    axes[1].plot(step, column(rows, variable), color=colour)
    axes[1].set_ylabel(variable)
    axes[2].plot(step, column(rows, drive), color=colour)
    axes[2].set_ylabel(drive)
    reward = column(rows, "reward")
    at = reward != 0
    axes[3].axhline(0, color=GREY, lw=0.8)
    axes[3].vlines(step[at], 0, reward[at], colors=BLACK, lw=2.0)
    axes[3].scatter(step[at], reward[at], c=BLACK, s=13, zorder=3)
    axes[3].set_ylim(-1.4, 1.4)
    axes[3].set_yticks([-1, 0, 1], ["−1", "0", "+1"])
    axes[3].set_ylabel("learning\nreward")
    axes[4].plot(step, column(rows, f"likelihood_{behaviour}"), color=BLACK)
    axes[4].axhline(0.5, color=GREY, lw=0.8, ls=":")
    axes[4].set_ylim(-0.05, 1.05)
    axes[4].set_ylabel(f"{affordance}\nlikelihood")
    axes[4].set_xlabel("step")
    axes[4].set_xlim(step[0], step[-1])
    axes[4].xaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
    fig.align_ylabels(axes)
    fig.legend(
        handles=[Patch(**shade, label=f"the robot runs '{behaviour}'; elsewhere its network "
                       "keeps its last output")],
        loc="outside lower center",
    )  # fmt: skip
    return fig


def spans(flags) -> list[tuple[int, int]]:
    """The runs of True in `flags` [n] as (first, past the last)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(flags, dtype=np.int8), [0]])))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def _objects(ax, step, objects, types: Sequence[str]) -> None:
    for level, (name, colour) in enumerate(type_colours(types).items()):
        bars = [(step[a] - 0.5, step[b - 1] - step[a] + 1) for a, b in spans(objects == name)]
        ax.broken_barh(bars, (level - 0.4, 0.8), color=colour, lw=0)
    ax.set_yticks(range(len(types)), list(types))
    ax.set_ylim(-0.6, len(types) - 0.4)
    ax.set_ylabel("object type")
    ax.grid(axis="y")

"""Affordances being learnt: the signals of Figures 3 and 4, and curves over many robots."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
import pyarrow as pa
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from animat.figures.style import (
    BLACK,
    GREY,
    LINES,
    need_colours,
    new_figure,
    styled,
    type_colours,
    type_words,
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


BAND = (5.0, 95.0)
"""Percentiles over robots between which the band lies."""


@styled
def learning_curve_figure(
    table: pa.Table,
    *,
    afforded: dict[tuple[str, str], float] | None = None,
    show: Literal["likelihood", "error"] = "likelihood",
) -> Figure:
    """Mean likelihood of each network for each object type over episodes, band over seeds.

    `table` has the columns seed, episode, network, object, likelihood. With `show` "error" the
    distance to `afforded[network, object]` is drawn instead.
    """
    if show == "error" and afforded is None:
        raise ValueError("an error needs to know what is afforded")
    networks = list(dict.fromkeys(column(table, "network").tolist()))
    types = list(dict.fromkeys(column(table, "object").tolist()))
    fills = type_colours(types)
    fig = new_figure(2.5 * len(networks) + 0.4, 3.5)
    axes = fig.subplots(1, len(networks), sharey=True, squeeze=False)[0]
    for ax, network in zip(axes, networks, strict=True):
        for number, name in enumerate(types):
            episodes, values = curves(table, network, name)
            if not episodes.size:
                continue
            if show == "error" and afforded is not None:
                values = np.abs(values - afforded[network, name])
            low, high = np.nanpercentile(values, BAND, axis=0)
            ax.fill_between(episodes, low, high, color=fills[name], alpha=0.2, lw=0)
            ax.plot(
                episodes, np.nanmean(values, axis=0), color=fills[name],
                ls=LINES[number % len(LINES)], label=type_words(name),
            )  # fmt: skip
        if show == "likelihood":
            ax.axhline(0.5, color=GREY, lw=0.8, ls=":")
        ax.set_title(network)
        ax.set_xlabel("episode")
        ax.set_ylim(-0.03, 1.03)
        ax.grid(axis="y")
    axes[0].set_ylabel("likelihood" if show == "likelihood" else "error of the likelihood")
    handles, labels = axes[0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=min(4, len(labels)))
    return fig


def curves(
    table: pa.Table, network: str, name: str
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Episodes [E] and likelihoods [seeds, E] of one network for one object type.

    Between and after its rows a robot keeps its last value, as its network does; before its
    first row there is none (NaN).
    """
    rows = (column(table, "network") == network) & (column(table, "object") == name)
    seed = column(table, "seed")[rows]
    episode = column(table, "episode")[rows]
    likelihood = column(table, "likelihood")[rows].astype(np.float64)
    order = np.lexsort((episode, seed))
    seed, episode, likelihood = seed[order], episode[order], likelihood[order]
    episodes = np.unique(episode)
    seeds, starts = np.unique(seed, return_index=True)
    values = np.full((seeds.size, episodes.size), np.nan)
    for row, (start, stop) in enumerate(zip(starts, [*starts[1:], seed.size], strict=True)):
        last = np.searchsorted(episode[start:stop], episodes, side="right") - 1
        known = last >= 0
        values[row, known] = likelihood[start:stop][last[known]]
    return episodes, values

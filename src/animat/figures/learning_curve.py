"""How the networks come to know the objects, over the episodes of many robots."""

from typing import Literal

import numpy as np
import pyarrow as pa
from matplotlib.figure import Figure
from numpy.typing import NDArray

from animat.figures.style import GREY, LINES, new_figure, styled, type_colours, type_words
from animat.statistics.lives import column

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

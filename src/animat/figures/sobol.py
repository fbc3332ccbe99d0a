"""Sobol's indices: what share of the variance of a lifespan each parameter explains."""

import numpy as np
import pyarrow as pa
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from animat.figures.style import BLACK, HATCHES, PALE, agent_colours, new_figure, styled

ORDERS = {"first": "alone", "total": "with all its interactions"}


@styled
def sobol_figure(indices: pa.Table) -> Figure:
    """Bars of the first and total order index of every parameter, a panel for each agent.

    `indices` is of `multiverse.sensitivity.sobol_table`; parameters come by their largest total.
    """
    rows = indices.to_pylist()
    largest: dict[str, float] = {}
    for row in rows:
        if row["order"] == "total":
            largest[row["parameter"]] = max(largest.get(row["parameter"], 0.0), row["index"])
    parameters = sorted(largest, key=lambda name: -largest[name])
    agents = list(dict.fromkeys(row["agent"] for row in rows))
    fills = agent_colours(agents)
    fig = new_figure(7.2, 0.36 * len(parameters) + 1.1)
    axes = fig.subplots(1, len(agents), sharey=True, sharex=True, squeeze=False)[0]
    told = {(row["agent"], row["parameter"], row["order"]): row for row in rows}
    for ax, agent in zip(axes, agents, strict=True):
        for number, order in enumerate(ORDERS):
            each = [told[agent, name, order] for name in parameters]
            value = np.array([row["index"] for row in each])
            ends = np.array([(row["low"], row["high"]) for row in each])
            at = np.arange(len(parameters)) + (number - 0.5) * 0.38
            ax.barh(
                at, value, 0.36, facecolor=fills[agent] if order == "total" else PALE,
                edgecolor=BLACK, linewidth=0.7, hatch=HATCHES[1 - number],
            )  # fmt: skip
            ax.hlines(at, ends[:, 0], ends[:, 1], color=BLACK, lw=1.2)
        ax.axvline(0.0, color=BLACK, lw=0.8)
        ax.set_title(agent)
        ax.xaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
        ax.set_xlabel("share of the variance")
        ax.grid(axis="x")
    for number, words in enumerate(ORDERS.values()):
        fill = PALE if number == 0 else "white"
        axes[0].barh(
            0.0, 0.0, facecolor=fill, edgecolor=BLACK, linewidth=0.7, hatch=HATCHES[1 - number],
            label=words if number == 0 else f"{words} (in colour)",
        )  # fmt: skip
    fig.legend(loc="outside lower center", ncols=2)
    axes[0].set_yticks(range(len(parameters)), parameters)
    axes[0].set_ylim(len(parameters) - 0.4, -0.6)
    return fig

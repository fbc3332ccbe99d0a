"""Sobol's indices: how much of the variance of an outcome each parameter explains.

The first order is what a parameter explains alone, the total order what it explains together with
all others. Points are those of Saltelli: two independent samples A and B, and for each parameter a
copy of A that has this parameter from B. The indices are scipy's (`sobol_indices`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.estimates import LEVEL

RESAMPLES = 999


def sobol_table(
    outcomes: Mapping[str, NDArray[np.float64]],
    parameters: Sequence[str],
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> pa.Table:
    """A row for each agent, parameter and order: `agent`, `parameter`, `order`, index, low, high.

    `outcomes` has for each agent its outcome at the points, [n * (d + 2)]: at the n of A, at those
    of B, then at those of A with the first parameter of B, and so on. Intervals are percentiles of
    a bootstrap over the n points. Raises ValueError if n is no power of 2, or points are missing.
    """
    rows = []
    for agent, values in outcomes.items():
        count, rest = divmod(len(values), len(parameters) + 2)
        if rest:
            raise ValueError(f"{len(values)} points are no multiple of {len(parameters) + 2}")
        parts = np.asarray(values, dtype=np.float64).reshape(-1, count)
        value = _indices(parts)
        low, high = _interval(parts, seed, resamples)
        for order, name in enumerate(("first", "total")):
            for place, parameter in enumerate(parameters):
                rows.append(
                    {
                        "agent": agent,
                        "parameter": parameter,
                        "order": name,
                        "index": float(value[order, place]),
                        "low": float(low[order, place]),
                        "high": float(high[order, place]),
                    }
                )
    return pa.Table.from_pylist(rows)


def _indices(parts: NDArray[np.float64]) -> NDArray[np.float64]:
    """First and total order [2, d] from the outcomes [2 + d, n] at A, B and the mixtures."""
    if np.ptp(parts) == 0.0:
        return np.zeros((2, len(parts) - 2))
    found: Any = stats.sobol_indices(
        func={"f_A": parts[:1], "f_B": parts[1:2], "f_AB": parts[2:, None]}, n=parts.shape[1]
    )
    return np.stack([found.first_order.reshape(-1), found.total_order.reshape(-1)])


def _interval(
    parts: NDArray[np.float64], seed: int, resamples: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    # scipy's own bootstrap of these indices cannot be given a seed.
    rng = np.random.default_rng(seed)
    count = parts.shape[1]
    drawn = np.array([_indices(parts[:, rng.integers(0, count, count)]) for _ in range(resamples)])
    tails = (1.0 - LEVEL) / 2, (1.0 + LEVEL) / 2
    low, high = np.quantile(drawn, tails, axis=0)
    return low, high

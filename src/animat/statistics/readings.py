"""Readings: which value each universe has of each, and which universes can be compared by one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.statistics.lives import column

MOST_UNIVERSES = 8_000
"""What needs all universes in memory many times over looks at so many at most."""

Readings = Mapping[str, Sequence[str]]
"""The values of each reading by its name; the first is the one the others are compared with."""


def codes(universes: pa.Table, readings: Readings) -> NDArray[np.int64]:
    """Which value each universe has of each reading, by its place: [U, F].

    The table has a column for each reading. Raises ValueError for a value that is none of its.
    """
    each = []
    for name, values in readings.items():
        had = column(universes, name).astype(str)
        code = np.full(len(had), -1, dtype=np.int64)
        for place, value in enumerate(values):
            code[had == value] = place
        if np.any(code < 0):
            unknown = ", ".join(sorted(set(had[code < 0].tolist())))
            raise ValueError(f"reading {name} has values {', '.join(values)}, not {unknown}")
        each.append(code)
    return np.stack(each, axis=1)


def comparable(code: NDArray[np.int64], groups: Sequence[NDArray[np.bool_]]) -> NDArray[np.bool_]:
    """Which universes [U] to compare groups of them by, where rules leave combinations out.

    `code` [U, F] are the values of the readings that do not make the groups, `groups` masks [U].
    Kept is a universe whose every value occurs in all groups: a lethal margin, which only two
    physiologies have, is compared within these two. Rules that forbid pairs of values are put
    right by this; one that forbids three together is not.
    """
    kept = np.logical_or.reduce(groups)
    for reading in range(code.shape[1]):
        values = code[:, reading]
        common = set.intersection(*(set(values[group].tolist()) for group in groups))
        kept &= np.isin(values, list(common))
    return kept


def fewest_together(code: NDArray[np.int64]) -> int:
    """In how many universes those two values of two readings meet that meet least, but meet.

    `code` is [U, F]. Values that never meet are those that a rule keeps apart.
    """
    fewest = len(code)
    for one, other in combinations(range(code.shape[1]), 2):
        _, times = np.unique(code[:, [one, other]], axis=0, return_counts=True)
        fewest = min(fewest, int(times.min(initial=fewest)))
    return fewest


def some_of(universes: pa.Table, most: int) -> pa.Table:
    """All universes if they are not more than `most`, else so many drawn at random."""
    if universes.num_rows <= most:
        return universes
    rows = np.random.default_rng(0).choice(universes.num_rows, most, replace=False)
    return universes.take(pa.array(np.sort(rows)))

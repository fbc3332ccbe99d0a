"""A trace by the pixel columns of an axis: however long it is, nothing that occurs in it is lost.

Of each curve, a column keeps the first, the least, the greatest and the last value; of behaviours,
the share of its steps that each takes; of events, that they occur in it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.statistics.lives import column

COLUMNS = 1_000
"""About as many as a figure of 7 inches has; a column is a whole number of steps wide."""

PATH_POINTS = 300_000
"""A path is drawn through at most twice so many places: of a longer one, through every n-th."""

GRAIN = 2.0
"""Of several rewards of a kind within so many mm, one is marked."""


class Columns(NamedTuple):
    """A trace, condensed.

    `first` and `last` are its steps; `curves` are steps [n] and values [n] by name. `edges` [C + 1]
    are the steps between columns, `shares` [C] of each behaviour that occurs the part of a column's
    rows in which it runs. `events` are the steps at which an event is marked, `path` [n, 2] the
    places in mm, `rewards` [n, 2] those of each reward.
    """

    first: int
    last: int
    curves: dict[str, tuple[NDArray, NDArray]]
    edges: NDArray[np.int64]
    shares: dict[str, NDArray[np.float64]]
    events: dict[str, NDArray[np.int64]]
    path: NDArray[np.float64]
    rewards: dict[int, NDArray[np.float64]]


def condensed(parts: Iterable[pa.Table], span: tuple[int, int], curves: Sequence[str]) -> Columns:
    """Condense the parts of a trace, whose steps are from `span[0]` to before `span[1]`.

    `curves` are the columns that are drawn as such. Parts are read once, one after the other.
    """
    first, past = span
    width = -(-(past - first) // COLUMNS)
    edges = np.append(np.arange(first, past, width), past)
    every = max(1, (past - first) // PATH_POINTS)
    drawn: dict[str, list[tuple[NDArray, NDArray]]] = {name: [] for name in curves}
    counts: dict[str, NDArray[np.int64]] = {}
    events: dict[str, NDArray[np.int64]] = {}
    places: list[NDArray] = []
    rewards = {reward: np.empty((0, 2)) for reward in (1, -1)}
    rows, end = 0, np.empty((0, 2))
    for part in parts:
        step = column(part, "step")
        at = (step - first) // width
        for name in curves:
            values = column(part, name)
            kept = envelope(at, values)
            drawn[name].append((step[kept], values[kept]))
        for name, here in _by_word(part, "behaviour").items():
            count = np.bincount(at[here], minlength=len(edges) - 1)
            counts[name] = counts[name] + count if name in counts else count
        for name, here in _by_word(part, "event").items():
            marked = np.append(events.get(name, step[:0]), step[here])
            events[name] = marked[np.unique((marked - first) // width, return_index=True)[1]]
        place = np.column_stack([column(part, "x"), column(part, "y")])
        places.append(place[(-rows) % every :: every])
        rows += len(step)
        end = place[-1:]
        reward = column(part, "reward")
        for kind, before in rewards.items():
            had = np.concatenate([before, place[reward == kind]])
            grains = np.unique(np.round(had / GRAIN), axis=0, return_index=True)[1]
            rewards[kind] = had[np.sort(grains)]
    return Columns(
        first,
        past - 1,
        {name: _joined(lines, first, width) for name, lines in drawn.items()},
        edges,
        _shares(counts),
        events,
        np.concatenate([*places, end]),
        rewards,
    )


def envelope(at: NDArray[np.int64], values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Indices, in order, of the values [n] that draw a curve over rising columns `at` [n].

    In each column the first, the least, the greatest and the last; of a gap (NaN) its beginning.
    """
    gaps = np.isnan(values)
    begun = np.flatnonzero(gaps & ~np.concatenate([[False], gaps[:-1]]))
    known = np.flatnonzero(~gaps)
    if not len(known):
        return begun
    where = at[known]
    starts = np.flatnonzero(np.diff(where, prepend=where[0] - 1))
    ends = np.append(starts[1:], len(where)) - 1
    order = np.lexsort((values[known], where))
    chosen = known[np.concatenate([starts, order[starts], order[ends], ends])]
    return np.union1d(chosen, begun)


def _joined(
    lines: Sequence[tuple[NDArray, NDArray]], first: int, width: int
) -> tuple[NDArray, NDArray]:
    """Curves of parts as one; where two parts share a column its extremes are those of both."""
    step, values = (np.concatenate(each) for each in zip(*lines, strict=True))
    kept = envelope((step - first) // width, values)
    return step[kept], values[kept]


def _by_word(part: pa.Table, name: str) -> dict[str, NDArray[np.int64]]:
    """Rows by each word they hold in a column; a row may hold several words, joined by blanks."""
    texts: Any = part.column(name)
    if pa.types.is_dictionary(texts.type):
        texts = texts.cast(texts.type.value_type)
    texts = texts.combine_chunks().dictionary_encode()
    codes = texts.indices.to_numpy(zero_copy_only=False)
    found: dict[str, list[int]] = {}
    for code, text in enumerate(texts.dictionary.to_pylist()):
        for word in text.split():
            found.setdefault(word, []).append(code)
    return {word: np.flatnonzero(np.isin(codes, which)) for word, which in found.items()}


def _shares(counts: Mapping[str, NDArray[np.int64]]) -> dict[str, NDArray[np.float64]]:
    """Counts [C] as shares of their columns; a column without a row has those of the one before."""
    total = np.sum(list(counts.values()), axis=0)
    filled = np.maximum.accumulate(np.where(total > 0, np.arange(len(total)), 0))
    return {name: (count / np.maximum(total, 1))[filled] for name, count in counts.items()}

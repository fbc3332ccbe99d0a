"""Reading a table of lives: its cells and its lifespans.

A lives table has a row per life, with the columns `world`, `agent`, `life`, `seed`, `lifespan`
(steps), `censored` (alive at the cap) and what was counted in that life.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

CELL = ("world", "agent")
"""The columns that name a cell of Experiment 2."""


class Lifespans(NamedTuple):
    """How long each life lasted, and whether it was still going on then."""

    steps: NDArray[np.float64]
    censored: NDArray[np.bool_]


def column(table: pa.Table, name: str) -> NDArray:
    """A column as an array; raises ValueError that names the columns there are."""
    if name not in table.column_names:
        there = ", ".join(table.column_names)
        raise ValueError(f"the table has no column '{name}'; it has: {there}")
    values = table.column(name)
    if pa.types.is_dictionary(values.type):
        values = values.cast(values.type.value_type)
    return np.asarray(values.to_numpy(zero_copy_only=False))


def cell(table: pa.Table, **values: str | int | float) -> pa.Table:
    """The rows in which every named column has the given value; ValueError if there are none."""
    chosen = np.ones(table.num_rows, dtype=bool)
    for name, value in values.items():
        chosen &= column(table, name) == value
    if not chosen.any():
        wanted = ", ".join(f"{name} = {value}" for name, value in values.items())
        raise ValueError(f"the table has no row with {wanted}")
    return table.filter(pa.array(chosen))


def cells(table: pa.Table, by: Sequence[str] = CELL) -> Iterator[tuple[tuple, pa.Table]]:
    """The table cut by the columns `by`: (values, rows) in order of first appearance."""
    keys = list(zip(*(column(table, name).tolist() for name in by), strict=True))
    rows: dict[tuple, list[int]] = {}
    for row, key in enumerate(keys):
        rows.setdefault(key, []).append(row)
    for key, indices in rows.items():
        yield key, table.take(pa.array(indices))


def first_lives(table: pa.Table, count: int, by: Sequence[str] = CELL) -> pa.Table:
    """The `count` lives with the lowest index of every cell (the paper reports 20)."""
    parts = [
        rows.take(pa.array(np.argsort(column(rows, "life"), kind="stable")[:count]))
        for _, rows in cells(table, by)
    ]
    return pa.concat_tables(parts)


def lifespans(table: pa.Table) -> Lifespans:
    """Lifespans in steps and whether each is censored."""
    return Lifespans(
        column(table, "lifespan").astype(np.float64), column(table, "censored").astype(bool)
    )


def restriction(tables: Sequence[pa.Table]) -> float:
    """The step up to which every life of all `tables` was watched; infinite if all died."""
    seen = (spans.steps[spans.censored] for spans in map(lifespans, tables))
    return min((float(steps.min()) for steps in seen if steps.size), default=float("inf"))

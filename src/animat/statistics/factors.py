"""Factors of a design, read from a table of lives: which levels each has, and who lived at which.

A factor is a column that the design varied. Numbers of more than a few values are a range: such a
factor is cut into quarters, and its values are kept for a trend.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.statistics.numerals import numerals

LEVELS_AT_MOST = 8
"""A factor of more different numbers is a range. A figure tells so many curves apart, too."""

QUARTERS = 4

NOT_SET = "not set"
"""The level of the lives in whose case the factor has no value."""


class Factor(NamedTuple):
    """A factor of n lives.

    `codes` [n] is the place of each life's level in `levels`; `exact` [n] tells its values apart,
    also those of a range that share a quarter; `values` [n] are the numbers of a range, NaN where
    it is not set, and None for any other factor; `ordered` levels are numbers.
    """

    name: str
    levels: tuple[str, ...]
    codes: NDArray[np.int64]
    exact: NDArray[np.int64]
    values: NDArray[np.float64] | None = None
    ordered: bool = False

    def label(self, row: int) -> str:
        """The value of one life in words: its level, or its number where that is a quarter."""
        if self.values is None or np.isnan(self.values[row]):
            return self.levels[self.codes[row]]
        known = self.values[~np.isnan(self.values)]
        return numerals(np.unique(known).tolist())[float(self.values[row])]


def factor(table: pa.Table, name: str) -> Factor:
    """The factor in a column. Raises ValueError if there is no such column.

    Numbers come in their order, all else as it first appears, lives without a value last.
    """
    if name not in table.column_names:
        there = ", ".join(table.column_names)
        raise ValueError(f"the table has no column '{name}'; it has: {there}")
    column = table.column(name)
    if pa.types.is_dictionary(column.type):
        column = column.cast(column.type.value_type)
    encoded: Any = column.combine_chunks().dictionary_encode(null_encoding="encode")
    distinct = encoded.dictionary.to_pylist()
    numeric = pa.types.is_integer(column.type) or pa.types.is_floating(column.type)
    order = sorted(
        range(len(distinct)),
        key=lambda k: (distinct[k] is None, distinct[k] if numeric and distinct[k] else 0, k),
    )
    place = np.empty(len(order), dtype=np.int64)
    place[order] = np.arange(len(order))
    exact = place[np.asarray(encoded.indices.to_numpy(zero_copy_only=False), dtype=np.int64)]
    ordered = [distinct[k] for k in order]
    if numeric and sum(value is not None for value in ordered) > LEVELS_AT_MOST:
        return _range(name, ordered, exact)
    said = numerals(value for value in ordered if value is not None) if numeric else {}
    levels = tuple(said.get(value) or _label(value) for value in ordered)
    return Factor(name, levels, exact, exact, None, numeric)


def _range(name: str, distinct: Sequence[float | None], exact: NDArray[np.int64]) -> Factor:
    """A range cut at the quartiles of the lives' values."""
    values = np.array([np.nan if v is None else float(v) for v in distinct])[exact]
    there = ~np.isnan(values)
    cuts = np.quantile(values[there], np.arange(1, QUARTERS) / QUARTERS)
    quarters = np.where(there, np.searchsorted(cuts, values, side="left"), QUARTERS)
    used, codes = np.unique(quarters, return_inverse=True)
    ends = [
        (values[quarters == each].min(), values[quarters == each].max())
        for each in used[used < QUARTERS]
    ]
    levels = [*_apart(ends), *([NOT_SET] if QUARTERS in used else [])]
    return Factor(name, tuple(levels), codes.astype(np.int64), exact, values, True)


def _apart(ends: Sequence[tuple[float, float]]) -> list[str]:
    """The quarters by their ends, with as many digits as tell these apart."""
    said = numerals((float(end) for pair in ends for end in pair), digits=3)
    return [f"{said[low]} to {said[high]}" if low != high else said[low] for low, high in ends]


def _label(value: object) -> str:
    if value is None:
        return NOT_SET
    return str(value).lower() if isinstance(value, bool) else str(value)

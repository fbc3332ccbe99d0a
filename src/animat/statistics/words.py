"""Values of settings in words, for the report."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from animat.statistics.numerals import numeral, numerals

LISTED_AT_MOST = 8
"""More values than this are not listed."""


def word(value: Any) -> str:
    """Return a value as a reader would write it, a number with all its digits."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return numeral(value)
    return f"{value:,}" if isinstance(value, int) else str(value)


def words(values: Iterable[Any], unit: str = "") -> str:
    """Return what a setting is: its value, those it has, or from where to where it goes."""
    distinct = list(dict.fromkeys(values))
    unit = f" {unit}" if unit else ""
    numbers = [v for v in distinct if isinstance(v, int | float) and not isinstance(v, bool)]
    if len(numbers) == len(distinct):
        numbers = sorted(numbers)
        ends = numbers if len(numbers) <= LISTED_AT_MOST else [numbers[0], numbers[-1]]
        said = numerals(ends)
        told = [said[v] if isinstance(v, float) else word(v) for v in ends]
        return listed(told, "or" if ends is numbers else "to") + unit
    if len(distinct) > LISTED_AT_MOST:
        return f"one of {len(distinct)} values"
    return listed([word(value) for value in distinct], "or") + unit


def listed(names: Sequence[str], last: str = "and") -> str:
    """Return names as a list in a sentence."""
    if len(names) < 2:
        return "".join(names)
    return f"{', '.join(names[:-1])} {last} {names[-1]}"

"""Values of settings in words, for the report."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

LISTED_AT_MOST = 8
"""More values than this are not listed."""


def word(value: Any) -> str:
    """Return a value as a reader would write it."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    return f"{value:,}" if isinstance(value, int) else str(value)


def words(values: Iterable[Any], unit: str = "") -> str:
    """Return what a setting is: its value, those it has, or from where to where it goes."""
    distinct = list(dict.fromkeys(values))
    unit = f" {unit}" if unit else ""
    numbers = [v for v in distinct if isinstance(v, int | float) and not isinstance(v, bool)]
    if len(distinct) > LISTED_AT_MOST:
        if len(numbers) == len(distinct):
            return f"{word(min(numbers))} to {word(max(numbers))}{unit}"
        return f"one of {len(distinct)} values"
    if len(numbers) == len(distinct):
        distinct = sorted(distinct)
    return listed([word(value) for value in distinct], "or") + unit


def listed(names: Sequence[str], last: str = "and") -> str:
    """Return names as a list in a sentence."""
    if len(names) < 2:
        return "".join(names)
    return f"{', '.join(names[:-1])} {last} {names[-1]}"

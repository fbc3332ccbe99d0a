"""Numbers, labels and values in words, never so short that two different ones look alike."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from typing import Any


def numeral(value: float) -> str:
    """A number with all its digits, so that no other looks like it."""
    return repr(value).removesuffix(".0")


def numerals(values: Iterable[float], digits: int = 6) -> dict[float, str]:
    """Each number in words, with at most `digits` digits, or as many as tell it from the others.

    Whole numbers have all their digits. None of `values` may be NaN.
    """
    said = {value: str(value) for value in values}
    alike = [value for value in said if isinstance(value, float)]
    for enough in range(digits, 18):
        said |= {value: f"{value:.{enough}g}" for value in alike}
        often = Counter(said.values())
        alike = [value for value in alike if often[said[value]] > 1]
    return said


def shortened(labels: Iterable[str], most: int = 44) -> dict[str, str]:
    """Each label cut to `most` characters: at its end, in its middle, or not at all.

    It is cut so that no two look alike.
    """
    half = most // 2
    cuts: tuple[Callable[[str], str], ...] = (
        lambda label: label[: most - 1] + "…",
        lambda label: label[: most - half - 1] + "…" + label[-half:],
        lambda label: label,
    )
    said: dict[str, str] = {label: label for label in labels}
    long = [label for label in said if len(label) > most]
    for cut in cuts:
        said |= {label: cut(label) for label in long}
        often = Counter(said.values())
        long = [label for label in long if often[said[label]] > 1]
    return said


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

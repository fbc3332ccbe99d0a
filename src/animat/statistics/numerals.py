"""Numbers and labels in words, short, but never so short that two different ones look alike."""

from collections import Counter
from collections.abc import Callable, Iterable


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

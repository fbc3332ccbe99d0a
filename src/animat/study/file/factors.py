"""Factors: what a design may vary, as a file writes it.

A factor is the key of a setting with a list of values, or a name of one's own with levels, each a
table of settings. A sample takes ranges of numbers as well.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag, model_validator

from animat.files.settings import Settings
from animat.files.validation_errors import plain


def _one_value(value: Any) -> Any:
    if not isinstance(value, bool | int | float | str):
        raise ValueError(
            "must be a number, a string, true or false; a key with dots must be in quotes,"
            " and what sets more than one value is a level with a name"
        )
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError("must be a finite number")
    return value


def _one_number(value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError("must be a number")
    return _one_value(value)


Scalar = bool | int | float | str
Value = Annotated[Scalar, BeforeValidator(_one_value)]


def each_once(values: list[Any]) -> list[Any]:
    """Return the values of a list. Raises ValueError for one that is there twice."""
    seen = set()
    for value in values:
        if (mark := identity(value)) in seen:
            raise ValueError(f"has {plain(value)} twice")
        seen.add(mark)
    return values


def identity(value: Scalar) -> tuple[bool, Scalar]:
    """Return what is equal for equal values: 1 and 1.0 are, 1 and true are not."""
    return isinstance(value, bool), value


Values = Annotated[list[Value], Field(min_length=1), AfterValidator(each_once)]
"""Values of a setting, one after the other."""

Levels = Annotated[dict[str, dict[str, Any]], Field(min_length=1)]
"""Levels by name, and what each sets by key."""


class Range(Settings):
    """Numbers from `low` to `high`, spread evenly over them or over their logarithms."""

    low: Annotated[int | float, BeforeValidator(_one_number)]
    high: Annotated[int | float, BeforeValidator(_one_number)]
    scale: Literal["linear", "log"] = "linear"

    @model_validator(mode="after")
    def _possible(self) -> Range:
        if self.low >= self.high:
            raise ValueError(f"low = {self.low} must be below high = {self.high}")
        if self.scale == "log" and self.low <= 0:
            raise ValueError(f'low = {self.low} must be above 0 where scale = "log"')
        return self

    def at(self, share: float, whole: bool) -> int | float:
        """Return the number at a share in [0, 1) of the range, `low` at 0.

        Of `whole` numbers both `low` and `high` are in it.
        """
        low, high = float(self.low), float(self.high)
        above = high + 1.0 if whole else high
        if self.scale == "log":
            value = math.exp(math.log(low) + share * (math.log(above) - math.log(low)))
        else:
            value = low + share * (above - low)
        value = min(max(value, low), high if not whole else above)
        return min(math.floor(value), int(self.high)) if whole else value


def _kind(value: Any) -> str:
    """Return which of its forms a factor has; the names are those that mistakes are told by."""
    if isinstance(value, Range) or (
        isinstance(value, dict)
        and any(not isinstance(value.get(name, {}), dict) for name in Range.model_fields)
    ):
        return "Range"
    return "dict[]" if isinstance(value, dict) else "list[]"


def _shaped(factor: Any) -> Any:
    if not isinstance(factor, list | dict | Range):
        raise ValueError("must be a list of values, or a table of levels")
    # A dotted key without quotes is a table of its own in TOML.
    if isinstance(factor, dict) and any(isinstance(level, list) for level in factor.values()):
        raise ValueError(
            "a level must be a table of settings;"
            ' for the values of a setting put its key in quotes, "mind.agent" = [...]'
        )
    return factor


def _no_range(factor: Any) -> Any:
    if _kind(factor) == "Range":
        raise ValueError("a range of numbers is sampled; put it under [design.sample.over]")
    return factor


_LISTED = Annotated[Values, Tag("list[]")] | Annotated[Levels, Tag("dict[]")]

Factor = Annotated[
    _LISTED, Discriminator(_kind), BeforeValidator(_no_range), BeforeValidator(_shaped)
]
"""A factor of a grid."""

Spread = Annotated[
    Annotated[Range, Tag("Range")] | _LISTED, Discriminator(_kind), BeforeValidator(_shaped)
]
"""A factor of a sample."""

"""Points spread over ranges and lists: Latin hypercubes and Sobol's sequence."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, field_validator, model_validator

from animat.settings import Settings

Scalar = bool | int | float | str
Levels = dict[str, dict[str, Any]]
"""Levels of a factor of one's own: by name, what each sets."""

MOST_POINTS = 1 << 16


class Range(Settings):
    """Numbers from `low` to `high`, spread evenly over them or over their logarithms."""

    low: int | float
    high: int | float
    scale: Literal["linear", "log"] = "linear"

    @model_validator(mode="after")
    def _possible(self) -> Range:
        if self.low >= self.high:
            raise ValueError(f"low = {self.low} must be below high = {self.high}")
        if self.scale == "log" and self.low <= 0:
            raise ValueError(f'low = {self.low} must be above 0 where scale = "log"')
        return self

    def at(self, share: float, whole: bool) -> int | float:
        """Return the number at a share in [0, 1) of the range; every whole one as often as others.

        Whole numbers reach from `low` to `high` inclusive.
        """
        high = self.high + 1 if whole else self.high
        if self.scale == "log":
            value = math.exp(math.log(self.low) + share * (math.log(high) - math.log(self.low)))
        else:
            value = self.low + share * (high - self.low)
        if whole:
            return min(max(math.floor(value), int(self.low)), int(self.high))
        return min(max(float(value), float(self.low)), float(self.high))


class Sample(Settings):
    """Points spread over what they are `over`: ranges of numbers, lists of values, named levels."""

    method: Literal["sobol", "latin_hypercube"]
    points: Annotated[int, Field(ge=1, le=MOST_POINTS)]
    seed: Annotated[int, Field(ge=0, lt=1 << 63)] = 0
    over: Annotated[dict[str, Range | list[Scalar] | Levels], Field(min_length=1)]

    @field_validator("points")
    @classmethod
    def _balanced(cls, points: int, info: Any) -> int:
        if info.data.get("method") == "sobol" and points & (points - 1):
            below = 1 << (points.bit_length() - 1)
            raise ValueError(
                "Sobol's points are balanced only in powers of 2;"
                f" the nearest are {below} and {2 * below}"
            )
        return points

    def shares(self) -> NDArray[np.float64]:
        """Return the points [P, D] in the unit cube, a column for each of `over`."""
        from scipy.stats import qmc

        generator = np.random.default_rng(self.seed)
        if self.method == "sobol":
            return qmc.Sobol(len(self.over), scramble=True, rng=generator).random(self.points)
        return qmc.LatinHypercube(len(self.over), rng=generator).random(self.points)

"""Points spread over ranges and lists: Latin hypercubes and Sobol's sequence, by scipy.

For Sobol's indices there are Saltelli's points: those of two samples A and B, and for each factor
those of A once more, with this factor from B.
"""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationInfo, field_validator

from animat.files.settings import Settings
from animat.study.file.factors import Spread

MOST_POINTS = 1 << 16


class Sample(Settings):
    """Points spread over what they are `over`: ranges of numbers, lists of values, named levels."""

    method: Literal["sobol", "latin_hypercube", "saltelli"]
    points: Annotated[int, Field(ge=1, le=MOST_POINTS)]
    seed: Annotated[int, Field(ge=0, lt=1 << 63)] = 0
    over: Annotated[dict[str, Spread], Field(min_length=1, max_length=1_000)]

    @field_validator("points")
    @classmethod
    def _balanced(cls, points: int, info: ValidationInfo) -> int:
        if info.data.get("method") != "latin_hypercube" and points & (points - 1):
            below = 1 << (points.bit_length() - 1)
            raise ValueError(
                "Sobol's points are balanced only where their number is a power of 2;"
                f" the nearest are {below} and {2 * below}"
            )
        return points

    @property
    def size(self) -> int:
        """How many points there are: of Saltelli's, `points` for each of D + 2 samples."""
        return self.points * (len(self.over) + 2 if self.method == "saltelli" else 1)

    def shares(self) -> NDArray[np.float64]:
        """Return the points [P, D] in [0, 1), a column for each of `over`."""
        from scipy.stats import qmc

        generator = np.random.default_rng(self.seed)
        factors = len(self.over)
        if self.method == "sobol":
            return qmc.Sobol(factors, scramble=True, rng=generator).random(self.points)
        if self.method == "saltelli":
            both = qmc.Sobol(2 * factors, scramble=True, rng=generator).random(self.points)
            a, b = both[:, :factors], both[:, factors:]
            mixed = [np.where(np.arange(factors) == one, b, a) for one in range(factors)]
            return np.concatenate([a, b, *mixed])
        return qmc.LatinHypercube(factors, rng=generator).random(self.points)

"""Physiologies: named readings of what the three homeostatic variables are and how they drift.

The rates and set points are those of Table 2; "tau" there is a rate per step. Which law each
variable follows the paper leaves open, so each reading has a name.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from animat.files.settings import Settings, nearest
from animat.files.validation_errors import plain

Kind = Literal["deficit", "excess"]

FALLING: dict[str, Kind] = {"decay": "deficit", "relax": "excess", "growth": "excess"}
"""The kind that each law implies; `linear` and a user's own law go either way."""

BY_NAME = (*FALLING, "linear")
"""The laws that are built in."""


class Variable(Settings):
    """A homeostatic variable.

    Its law (`decay`, `relax`, `growth`, `linear`, or a function or "FILE.py:NAME"), its rate per
    step, its set point, its value at birth, and its viability zone [low, high]. A variable of the
    `deficit` kind falls by itself and an act that serves it raises it; one of the `excess` kind
    the other way round. `lethal_margin` moves the lethal bound of the side it drifts to inwards,
    and makes reaching it lethal. A variable that is not `lethal` stops at its bounds.
    """

    law: str | Callable[..., Any]
    rate: Annotated[float, Field(gt=0.0, lt=1.0)]
    set_point: float
    start: float = 0.5
    low: float = 0.0
    high: float = 1.0
    kind: Kind | None = None
    lethal: bool = True
    lethal_margin: Annotated[float, Field(ge=0.0)] = 0.0

    @model_validator(mode="after")
    def _consistent(self) -> Variable:
        if self.low >= self.high:
            raise ValueError(f"low = {self.low} must be below high = {self.high}")
        for name in ("set_point", "start"):
            if not self.low <= getattr(self, name) <= self.high:
                raise ValueError(
                    f"{name} = {getattr(self, name)} lies outside the viability zone"
                    f" [{self.low}, {self.high}]"
                )
        if self.lethal_margin >= self.high - self.low:
            raise ValueError(f"lethal_margin = {self.lethal_margin} leaves no viability zone")
        if not isinstance(self.law, Hashable):
            raise ValueError("law must be a function, or the name of one")
        if isinstance(self.law, str) and self.law not in BY_NAME and ".py:" not in self.law:
            raise ValueError(
                f"law = {plain(self.law)} is no law, nor FILE.py:NAME{nearest(self.law, BY_NAME)}"
            )
        implied = FALLING.get(self.law) if isinstance(self.law, str) else None
        if implied and self.kind not in {None, implied}:
            raise ValueError(f'kind = "{self.kind}" contradicts law = "{self.law}" ({implied})')
        if not implied and self.kind is None:
            raise ValueError(f'law = "{self.law}" needs kind = "deficit" or "excess"')
        if self.lethal and not self.dies_below <= self.start <= self.dies_above:
            raise ValueError(f"start = {self.start} is lethal at once")
        return self

    @property
    def is_deficit(self) -> bool:
        """Whether an act that serves the variable raises it."""
        implied = FALLING.get(self.law) if isinstance(self.law, str) else None
        return (implied or self.kind) == "deficit"

    @property
    def dies_below(self) -> float:
        """The variable kills below this value."""
        if self.is_deficit and self.lethal_margin > 0.0:
            return math.nextafter(self.low + self.lethal_margin, math.inf)
        return self.low

    @property
    def dies_above(self) -> float:
        """The variable kills above this value."""
        if not self.is_deficit and self.lethal_margin > 0.0:
            return math.nextafter(self.high - self.lethal_margin, -math.inf)
        return self.high


def _table_2(**laws: dict[str, Any]) -> dict[str, Variable]:
    """Return nutrition, stamina and restlessness of Table 2 with the given laws."""
    rates = {"nutrition": 1e-4, "stamina": 1e-4, "restlessness": 1e-3}
    set_points = {"nutrition": 0.9, "stamina": 0.2, "restlessness": 0.1}
    return {
        name: Variable(rate=rates[name], set_point=set_points[name], **law)
        for name, law in laws.items()
    }


LETHAL_MARGIN = 0.05
"""The default lethal margin of the physiologies whose laws never reach a bound."""

PHYSIOLOGIES = {
    "excess": _table_2(
        nutrition={"law": "decay"},
        stamina={"law": "growth"},
        restlessness={"law": "growth"},
    ),
    "decay": _table_2(
        nutrition={"law": "decay", "lethal_margin": LETHAL_MARGIN},
        stamina={"law": "decay", "lethal_margin": LETHAL_MARGIN},
        restlessness={"law": "decay", "lethal_margin": LETHAL_MARGIN},
    ),
    "relax": _table_2(
        nutrition={"law": "decay", "lethal_margin": LETHAL_MARGIN},
        stamina={"law": "relax", "lethal_margin": LETHAL_MARGIN},
        restlessness={"law": "relax", "lethal_margin": LETHAL_MARGIN},
    ),
    "linear": _table_2(
        nutrition={"law": "linear", "kind": "deficit"},
        stamina={"law": "linear", "kind": "excess"},
        restlessness={"law": "linear", "kind": "excess"},
    ),
}
"""The named physiologies: what each variable is, by its name."""

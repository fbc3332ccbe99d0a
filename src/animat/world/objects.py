"""Object types: what an object looks like to the networks, what it affords, how it is drawn."""

from __future__ import annotations

from typing import Annotated, Any, Self

from numpy import float64
from numpy.typing import NDArray
from pydantic import (
    Field,
    PlainSerializer,
    PlainValidator,
    ValidationInfo,
    WithJsonSchema,
    field_validator,
    model_validator,
)

from animat.files.settings import Settings, nearest
from animat.names import MARKS, malformed, name_problems
from animat.world.arena import LONGEST
from animat.world.shapes import FEWEST_SIDES, MOST_SIDES, SIDES, polygon

Corners = tuple[tuple[float, float], ...]
Probability = Annotated[float, Field(ge=0, le=1)]

_ALLOWED = f"{', '.join(SIDES)}, a number of sides, or corners [[x, y], ...] in mm"


def _known_shape(value: Any) -> str | int | Corners:
    if isinstance(value, str):
        if value not in SIDES:
            close = nearest(value, SIDES).partition("; known")[0]
            raise ValueError(f"unknown shape; allowed: {_ALLOWED}{close}")
        return value
    if isinstance(value, int) and not isinstance(value, bool):
        if not FEWEST_SIDES <= value <= MOST_SIDES:
            raise ValueError(f"a regular shape has {FEWEST_SIDES} to {MOST_SIDES} sides")
        return value
    corners: Any = value
    try:
        return tuple((float(x), float(y)) for x, y in corners)
    except (TypeError, ValueError):
        raise ValueError(f"allowed: {_ALLOWED}") from None


_SHAPE_SCHEMA = {
    "anyOf": [
        {"enum": list(SIDES)},
        {"type": "integer", "minimum": FEWEST_SIDES, "maximum": MOST_SIDES},
        {"type": "array", "minItems": 3, "items": {"type": "array", "items": {"type": "number"}}},
    ]
}


class ObjectType(Settings):
    """A type of object, by name.

    `shape` is a name (triangle, square, pentagon, hexagon, octagon), a number of equal sides, or
    corners in mm; `size_mm` is a triangle's side, any other regular shape's width across flats,
    and is left out with corners. `features` are what the networks see, `affords` the probability
    in [0, 1] that an act of that affordance succeeds. Both may have any number of entries.
    """

    name: str
    shape: Annotated[
        str | int | Corners,
        PlainValidator(_known_shape),
        PlainSerializer(lambda shape: shape, return_type=Any),
        WithJsonSchema(_SHAPE_SCHEMA),
    ]
    size_mm: Annotated[float, Field(gt=0, le=LONGEST)] | None = None
    features: Annotated[dict[str, float], Field(min_length=1)]
    affords: Annotated[dict[str, Probability], Field(min_length=1)]

    @field_validator("name")
    @classmethod
    def _writable_name(cls, name: str) -> str:
        if problem := malformed(name):
            raise ValueError(problem)
        if name in MARKS:
            raise ValueError(f"figures mark {', '.join(MARKS)}; give the type another name")
        return name

    @field_validator("features", "affords")
    @classmethod
    def _writable_names(cls, given: dict[str, float], info: ValidationInfo) -> dict[str, float]:
        kind = "feature" if info.field_name == "features" else "affordance"
        if problems := name_problems(kind, given):
            raise ValueError("\n".join(problems))
        return given

    @model_validator(mode="after")
    def _makes_a_polygon(self) -> Self:
        polygon(self.shape, self.size_mm)
        return self

    def __hash__(self) -> int:
        """Hash by content; dictionaries are equal whatever their order."""
        features, affords = frozenset(self.features.items()), frozenset(self.affords.items())
        return hash((self.name, self.shape, self.size_mm, features, affords))

    def polygon(self) -> NDArray[float64]:
        """Return the corners [n, 2] in mm, centred on the centroid, at angle 0."""
        return polygon(self.shape, self.size_mm)


def _table_1(name: str, shape: str, size_mm: float, round_: float, large: float) -> ObjectType:
    return ObjectType(
        name=name,
        shape=shape,
        size_mm=size_mm,
        features={"shape": round_, "size": large},
        affords={"grasp": 1.0 - large, "shelter": large, "interact": 1.0},
    )


TABLE_1 = (
    _table_1("TS", "triangle", 45.0, 0.0, 0.0),
    _table_1("TL", "triangle", 100.0, 0.0, 1.0),
    _table_1("CS", "square", 38.0, 1.0, 0.0),
    _table_1("CL", "octagon", 100.0, 1.0, 1.0),
)
"""Table 1 of the paper: triangular and circular, small and large. Small ones afford grasping,
large ones shelter, all interaction. The small circle is drawn square, the large one octagonal."""

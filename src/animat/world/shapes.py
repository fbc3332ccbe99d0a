"""The outlines of objects: polygons in mm, centred on their centroid, corners anticlockwise."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from animat.world.arena import LONGEST
from animat.world.geometry import turn_and_shift

SIDES = {"triangle": 3, "square": 4, "pentagon": 5, "hexagon": 6, "octagon": 8}
"""The shapes that have a name, and how many sides each has."""

FEWEST_SIDES, MOST_SIDES = 3, 64

Shape = str | int | Sequence[Sequence[float]]
"""A name of `SIDES`, a number of equal sides, or corners (x, y) in mm."""


def polygon(shape: Shape, size_mm: float | None = None) -> NDArray[np.float64]:
    """Return the corners [n, 2] of a shape.

    `size_mm` is the side of a triangle, and for every other regular shape the diameter of the
    circle within it: the side of a square, the width across flats of an octagon. A regular shape
    stands on one of its sides. Corners of one's own are in mm already and take no size.

    Raises:
        ValueError: unknown shape, size missing or not positive, corners that make no polygon.
    """
    if not isinstance(shape, str | int):
        return _own_polygon(shape, size_mm)
    sides = SIDES.get(shape, 0) if isinstance(shape, str) else shape
    if isinstance(shape, str) and not sides:
        raise ValueError(f"unknown shape {shape!r}; known: {', '.join(SIDES)}")
    if not FEWEST_SIDES <= sides <= MOST_SIDES:
        raise ValueError(f"{sides} sides; a regular shape has {FEWEST_SIDES} to {MOST_SIDES}")
    if size_mm is None or not (math.isfinite(size_mm) and size_mm > 0):
        raise ValueError(f"size_mm is {size_mm}; a regular shape needs a size above 0 mm")
    apothem = size_mm / math.sqrt(12.0) if sides == SIDES["triangle"] else size_mm / 2
    return _regular(sides, apothem).copy()


def area_and_centroid(corners: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
    """Return the signed area (mm², positive anticlockwise) and the centroid of a polygon [n, 2]."""
    origin = corners[0]
    here = corners - origin
    there = np.roll(here, -1, axis=0)
    cross = here[:, 0] * there[:, 1] - there[:, 0] * here[:, 1]
    area = float(cross.sum()) / 2
    if area == 0.0:
        return 0.0, corners.mean(axis=0)
    return area, origin + ((here + there) * cross[:, None]).sum(axis=0) / (6 * area)


@lru_cache(maxsize=256)
def _regular(sides: int, apothem: float) -> NDArray[np.float64]:
    half_step = math.pi / sides
    corners = np.tile((1.0, 0.0), (sides, 1))
    for i in range(sides):
        turn_and_shift(corners, i, i + 1, 0.0, 0.0, -math.pi / 2 + half_step * (2 * i + 1))
    # The first side lies below the centre.
    corners *= apothem / -corners[0, 1]
    # Rounded to a picometre, so that a square is one.
    return np.round(corners, 9) + 0.0


def _own_polygon(shape: Sequence[Sequence[float]], size_mm: float | None) -> NDArray[np.float64]:
    if size_mm is not None:
        raise ValueError(f"size_mm is {size_mm:g}, but corners are in mm already: leave it out")
    if len(shape) < FEWEST_SIDES or any(len(corner) != 2 for corner in shape):
        raise ValueError("corners are a list of at least three pairs [x, y] in mm")
    corners = np.array(shape, dtype=np.float64)
    if not (np.abs(corners) <= LONGEST).all():
        raise ValueError(f"a corner is not a number from {-LONGEST:g} to {LONGEST:g} mm")
    crossing = _crossing_sides(corners)
    if crossing is not None:
        raise ValueError(f"sides {crossing[0]} and {crossing[1]} of the polygon touch or cross")
    area, centroid = area_and_centroid(corners)
    if abs(area) < 1.0:
        raise ValueError(f"the polygon has an area of {abs(area):.3g} mm²; at least 1 is needed")
    return (corners if area > 0 else corners[::-1]) - centroid


def _crossing_sides(corners: NDArray[np.float64]) -> tuple[int, int] | None:
    """Return two sides that meet elsewhere than at a corner they share, or none."""
    count = len(corners)
    for first in range(count):
        a, b = corners[first], corners[(first + 1) % count]
        if np.array_equal(a, b):
            return first, (first + 1) % count
        for second in range(first + 1, count):
            c, d = corners[second], corners[(second + 1) % count]
            if second == first + 1 and _turn(a, b, d) == 0 and np.dot(a - b, d - b) > 0:
                return first, second
            if second == first + 1 or (second + 1) % count == first:
                continue
            if _meet(a, b, c, d):
                return first, second
    return None


def _turn(a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]) -> float:
    return float(np.sign((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])))


def _meet(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
) -> bool:
    """Tell whether the segments ab and cd have a point in common."""
    boxes_apart = (np.maximum(a, b) < np.minimum(c, d)) | (np.maximum(c, d) < np.minimum(a, b))
    if boxes_apart.any():
        return False
    return _turn(a, b, c) * _turn(a, b, d) <= 0 and _turn(c, d, a) * _turn(c, d, b) <= 0

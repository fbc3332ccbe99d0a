"""Distances between points and polygons, compiled.

Polygons lie one after another in one array of corners: polygon s has the corners
`outline[first[s] : first[s + 1]]`, in mm.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from animat.numerics.compiled import compiled, kernel
from animat.numerics.elementary import sine_cosine


class Outlines(NamedTuple):
    """Polygons packed into arrays for compiled code, in mm."""

    outline: NDArray[np.float64]  # [V, 2] corners of all of them
    first: NDArray[np.int64]  # [S + 1] where each one's corners begin
    centre: NDArray[np.float64]  # [S, 2] centroids
    reach: NDArray[np.float64]  # [S] largest distance of a corner from the centroid


def packed(polygons: list[NDArray[np.float64]], poses: NDArray[np.float64]) -> Outlines:
    """Pack polygons [n, 2] about their centroids, moved to poses [S, 3] of x, y (mm), angle."""
    sizes = [len(polygon) for polygon in polygons]
    first = np.concatenate(([0], np.cumsum(sizes, dtype=np.int64))).astype(np.int64)
    outline = np.concatenate([*polygons, np.empty((0, 2))])
    reach = np.array([math.sqrt(float((p**2).sum(axis=1).max())) for p in polygons])
    for site in range(len(polygons)):
        turn_and_shift(outline, int(first[site]), int(first[site + 1]), *poses[site])
    return Outlines(outline, first, np.ascontiguousarray(poses[:, :2]), reach)


@kernel
def turn_and_shift(
    outline: NDArray[np.float64], start: int, end: int, x: float, y: float, angle: float
) -> None:
    """Turn the corners start..end by `angle` (rad) about the origin, then shift them by x, y."""
    sine, cosine = sine_cosine(angle)
    for i in range(start, end):
        u = outline[i, 0]
        v = outline[i, 1]
        outline[i, 0] = x + (u * cosine - v * sine)
        outline[i, 1] = y + (u * sine + v * cosine)


@compiled
def squared_to_segment(px: float, py: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Return the squared distance (mm²) of a point p from the segment ab."""
    dx = bx - ax
    dy = by - ay
    ex = px - ax
    ey = py - ay
    along = ex * dx + ey * dy
    length = dx * dx + dy * dy
    if along <= 0.0:
        return ex * ex + ey * ey
    if along >= length:
        ex = px - bx
        ey = py - by
        return ex * ex + ey * ey
    across = ex * dy - ey * dx
    return across * across / length


@compiled
def signed_distance(
    px: float, py: float, outline: NDArray[np.float64], start: int, end: int
) -> float:
    """Return the distance (mm) of a point from a polygon's outline, negative inside it."""
    inside = False
    nearest = np.inf
    ax = outline[end - 1, 0]
    ay = outline[end - 1, 1]
    for i in range(start, end):
        bx = outline[i, 0]
        by = outline[i, 1]
        nearest = min(nearest, squared_to_segment(px, py, ax, ay, bx, by))
        if (ay > py) != (by > py) and px < (bx - ax) * (py - ay) / (by - ay) + ax:
            inside = not inside
        ax = bx
        ay = by
    distance = math.sqrt(nearest)
    return -distance if inside else distance


@compiled
def turn(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> float:
    """Return twice the signed area of the triangle abc (mm²): positive when it turns left."""
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


@compiled
def polygon_gap(
    outline: NDArray[np.float64], start_a: int, end_a: int, start_b: int, end_b: int
) -> float:
    """Return the distance (mm) between two polygons, 0 when they overlap or touch."""
    if signed_distance(outline[start_a, 0], outline[start_a, 1], outline, start_b, end_b) < 0.0:
        return 0.0
    if signed_distance(outline[start_b, 0], outline[start_b, 1], outline, start_a, end_a) < 0.0:
        return 0.0
    nearest = np.inf
    ax = outline[end_a - 1, 0]
    ay = outline[end_a - 1, 1]
    for i in range(start_a, end_a):
        bx = outline[i, 0]
        by = outline[i, 1]
        cx = outline[end_b - 1, 0]
        cy = outline[end_b - 1, 1]
        for j in range(start_b, end_b):
            dx = outline[j, 0]
            dy = outline[j, 1]
            if (
                turn(ax, ay, bx, by, cx, cy) * turn(ax, ay, bx, by, dx, dy) < 0.0
                and turn(cx, cy, dx, dy, ax, ay) * turn(cx, cy, dx, dy, bx, by) < 0.0
            ):
                return 0.0
            nearest = min(nearest, squared_to_segment(bx, by, cx, cy, dx, dy))
            nearest = min(nearest, squared_to_segment(dx, dy, ax, ay, bx, by))
            cx = dx
            cy = dy
        ax = bx
        ay = by
    return math.sqrt(nearest)

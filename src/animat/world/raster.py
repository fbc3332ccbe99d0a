"""The arena as a raster: every question a step asks of the world is a look-up in it.

Distances are exact, from the centre of a cell to the outline of a polygon; only the place asked
about is rounded to a cell.

Most questions are answered by `room` alone: how much is free for certain round a point. So it is
kept small and local, a byte a cell, in tiles of 8 x 8 cells: what a robot asks about in a row lies
in a few lines of the processor's cache, however large the arena is.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import types
from numpy.typing import NDArray

from animat.files.settings import SettingsError
from animat.numerics.compiled import kernel
from animat.world.arena import Arena
from animat.world.geometry import Outlines, signed_distance

BORDER_MM = 100.0
"""How far the arrays reach beyond the playground, so that no sensor ever looks outside them."""

FREE, WALL, FIRST_SITE = 0, 1, 2
"""What `Raster.solid` says of a cell: free, wall, or FIRST_SITE + s for the site s."""

TILE = 8
"""Cells along the side of a tile of `Raster.room`."""

MOST_ROOM = 255
"""mm; more room than this is not told apart."""

MOST_CELLS = 100_000_000
MOST_SITES = 32_000

ROUNDING = 0.01  # mm
_BLOCK = 16
_SLACK = 1e-6  # mm; rounding must never let the bounding circles hide a site


class Raster(NamedTuple):
    """A world drawn on cells, as compiled code reads it.

    The cell of a point (x, y) in mm is row int(y * cells_per_mm + border), column
    int(x * cells_per_mm + border). A site is a place where an object stands or may stand.
    """

    resolution: float  # side of a cell, mm
    cells_per_mm: float  # 1 / resolution
    border: int  # cells of wall round the playground
    tiles: int  # tiles of `room` from left to right
    room: NDArray[np.uint8]  # [tiles x tiles x TILE x TILE] mm free round every point of a cell
    solid: NDArray[np.int16]  # [R, C] FREE, WALL, or FIRST_SITE + site; by the cell's centre
    clearance: NDArray[np.float32]  # [R, C] mm to the nearest wall or outline; 0 where solid
    near_site: NDArray[np.int16]  # [R, C, K] sites within the horizon, nearest first; -1 padded
    near_distance: NDArray[np.float32]  # [R, C, K] mm to their outlines, 0 inside; inf padded
    site_x: NDArray[np.float64]  # [S] mm, centroids
    site_y: NDArray[np.float64]  # [S] mm
    site_type: NDArray[np.int64]  # [S] index into the world's object types
    features: NDArray[np.float64]  # [T, F] what the networks see
    affords: NDArray[np.float64]  # [T, A] probabilities


RASTER = types.NamedTuple(
    (
        *(types.float64, types.float64, types.int64, types.int64),
        types.Array(types.uint8, 1, "C"),
        types.Array(types.int16, 2, "C"),
        types.Array(types.float32, 2, "C"),
        types.Array(types.int16, 3, "C"),
        types.Array(types.float32, 3, "C"),
        *(types.Array(types.float64, 1, "C"), types.Array(types.float64, 1, "C")),
        types.Array(types.int64, 1, "C"),
        *(types.Array(types.float64, 2, "C"), types.Array(types.float64, 2, "C")),
    ),
    Raster,
)
"""What a kernel is told of the type of a raster."""


def draw(
    arena: Arena,
    outlines: Outlines,
    site_type: NDArray[np.int64],
    features: NDArray[np.float64],
    affords: NDArray[np.float64],
    horizon: float,
    resolution: float,
) -> Raster:
    """Draw an arena and its sites.

    `horizon` is how far (mm) from a cell's centre a site is still listed as near.

    Raises:
        SettingsError: a horizon that is negative or infinite, or too many cells.
    """
    if not (math.isfinite(horizon) and horizon >= 0):
        raise SettingsError(f"horizon is {horizon} mm; allowed: a finite length of at least 0")
    border = math.ceil(BORDER_MM / resolution)
    rows = math.ceil(arena.height / resolution) + 2 * border
    columns = math.ceil(arena.width / resolution) + 2 * border
    if rows * columns > MOST_CELLS:
        raise SettingsError(
            f"resolution = {resolution:g} mm makes {rows:,} x {columns:,} cells of an arena of"
            f" {arena.width:g} x {arena.height:g} mm; allowed are {MOST_CELLS:,}, so give a coarser"
            " resolution or a smaller arena"
        )
    solid = np.empty((rows, columns), dtype=np.int16)
    clearance = np.empty((rows, columns), dtype=np.float32)
    count = np.empty((rows, columns), dtype=np.int16)
    grid = (float(resolution), border, float(horizon))
    possible = np.empty(max(1, len(outlines.reach)), dtype=np.int64)
    _draw_blocks(grid, arena.free, outlines, possible, solid, clearance, count)
    most = max(1, int(count.max()))
    near_site = np.full((rows, columns, most), -1, dtype=np.int16)
    near_distance = np.full((rows, columns, most), np.inf, dtype=np.float32)
    _list_near(grid, outlines, near_site, near_distance)
    tiles, room = tiled_room(clearance, resolution)
    return Raster(
        resolution=float(resolution),
        cells_per_mm=1.0 / resolution,
        border=border,
        tiles=tiles,
        room=room,
        solid=solid,
        clearance=clearance,
        near_site=near_site,
        near_distance=near_distance,
        site_x=outlines.centre[:, 0].copy(),
        site_y=outlines.centre[:, 1].copy(),
        site_type=site_type,
        features=features,
        affords=affords,
    )


def tiled_room(clearance: NDArray[np.float32], resolution: float) -> tuple[int, NDArray[np.uint8]]:
    """Return the tiles from left to right, and `Raster.room`, of a clearance [R, C].

    A point lies within half a diagonal of the centre of its cell, and so does any other point of
    the centre of its own: a clearance, from centre to outline, less a diagonal is free between
    cells. The rest of what is taken off is for its being a float32.
    """
    certain = clearance - (math.sqrt(2.0) * resolution + ROUNDING)
    rows, columns = (-(-cells // TILE) for cells in clearance.shape)
    whole = np.zeros((rows * TILE, columns * TILE), np.uint8)
    whole[: clearance.shape[0], : clearance.shape[1]] = np.clip(certain, 0.0, MOST_ROOM)
    tiles = whole.reshape(rows, TILE, columns, TILE).swapaxes(1, 2)
    return columns, np.ascontiguousarray(tiles).reshape(-1)


@kernel
def _draw_blocks(
    grid: tuple[float, int, float],
    free: tuple[float, float, float, float],
    outlines: Outlines,
    possible: NDArray[np.int64],
    solid: NDArray[np.int16],
    clearance: NDArray[np.float32],
    count: NDArray[np.int16],
) -> None:
    """Fill solid and clearance, and count the sites within the horizon of every cell.

    Cells are taken in square blocks; only sites that can matter to some cell of a block are
    measured there.
    """
    resolution, border, horizon = grid
    outline, first, centre, reach = outlines
    rows, columns = solid.shape
    half = 0.5 * math.sqrt(2.0) * _BLOCK * resolution
    for row0 in range(0, rows, _BLOCK):
        for column0 in range(0, columns, _BLOCK):
            bx = (column0 - border + 0.5 * _BLOCK) * resolution
            by = (row0 - border + 0.5 * _BLOCK) * resolution
            nearest = np.inf
            for s in range(len(reach)):
                away = math.sqrt((bx - centre[s, 0]) ** 2 + (by - centre[s, 1]) ** 2)
                nearest = min(nearest, away + reach[s])
            matters = max(horizon, nearest + half) + half + _SLACK
            found = 0
            for s in range(len(reach)):
                away = math.sqrt((bx - centre[s, 0]) ** 2 + (by - centre[s, 1]) ** 2)
                if away - reach[s] <= matters:
                    possible[found] = s
                    found += 1
            for row in range(row0, min(row0 + _BLOCK, rows)):
                y = (row - border + 0.5) * resolution
                for column in range(column0, min(column0 + _BLOCK, columns)):
                    x = (column - border + 0.5) * resolution
                    room = min(x - free[0], free[1] - x, y - free[2], free[3] - y)
                    kind = FREE if room > 0.0 else WALL
                    room = max(room, 0.0)
                    near = 0
                    for k in range(found):
                        s = int(possible[k])
                        bound = max(horizon, room) + reach[s] + _SLACK
                        dx = x - centre[s, 0]
                        dy = y - centre[s, 1]
                        if dx * dx + dy * dy > bound * bound:
                            continue
                        distance = signed_distance(x, y, outline, first[s], first[s + 1])
                        if distance < 0.0 and kind == FREE:
                            kind = FIRST_SITE + s
                        room = min(room, max(distance, 0.0))
                        if distance <= horizon:
                            near += 1
                    solid[row, column] = kind
                    clearance[row, column] = room
                    count[row, column] = near


@kernel
def _list_near(
    grid: tuple[float, int, float],
    outlines: Outlines,
    near_site: NDArray[np.int16],
    near_distance: NDArray[np.float32],
) -> None:
    """List the sites within the horizon of every cell, nearest first, the lower index in a tie."""
    resolution, border, horizon = grid
    outline, first, centre, reach = outlines
    rows, columns, _ = near_site.shape
    for s in range(len(reach)):
        far = reach[s] + horizon + _SLACK
        row_from = max(int((centre[s, 1] - far) / resolution + border) - 1, 0)
        row_to = min(int((centre[s, 1] + far) / resolution + border) + 2, rows)
        column_from = max(int((centre[s, 0] - far) / resolution + border) - 1, 0)
        column_to = min(int((centre[s, 0] + far) / resolution + border) + 2, columns)
        for row in range(row_from, row_to):
            y = (row - border + 0.5) * resolution
            for column in range(column_from, column_to):
                x = (column - border + 0.5) * resolution
                dx = x - centre[s, 0]
                dy = y - centre[s, 1]
                if dx * dx + dy * dy > far * far:
                    continue
                exact = signed_distance(x, y, outline, first[s], first[s + 1])
                if exact > horizon:
                    continue
                distance = np.float32(max(exact, 0.0))
                k = 0
                while near_site[row, column, k] >= 0:
                    k += 1
                while k > 0 and near_distance[row, column, k - 1] > distance:
                    near_site[row, column, k] = near_site[row, column, k - 1]
                    near_distance[row, column, k] = near_distance[row, column, k - 1]
                    k -= 1
                near_site[row, column, k] = s
                near_distance[row, column, k] = distance

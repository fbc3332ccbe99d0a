"""Looking things up in the world's raster: is this point occupied, and how much room is there.

Points are given in cells: u = x * cells_per_mm + border is a column, v likewise a row. The callers
keep within the border, so that no index is negative or too large. Indices are unsigned because a
signed one costs a comparison more.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from animat.numerics.compiled import compiled
from animat.world.raster import FIRST_SITE, FREE, TILE, Raster

TILE_BITS = TILE.bit_length() - 1


@compiled
def occupied(u: float, v: float, solid: NDArray[np.int16], present: NDArray[np.uint8]) -> bool:
    """Tell whether a wall, or a site whose object is present, covers the cell of a point."""
    code = solid[np.uint64(int(v)), np.uint64(int(u))]
    if code < FIRST_SITE:
        return code != FREE
    return present[code - FIRST_SITE] != 0


@compiled
def room(u: float, v: float, raster: Raster) -> float:
    """Return a distance (mm) within which no cell near a point is occupied.

    Every cell that holds a point nearer to (u, v) than this is free, whichever objects are
    present: skipping what lies within it never changes what is found.
    """
    row, column = int(v), int(u)
    tile = (row >> TILE_BITS) * raster.tiles + (column >> TILE_BITS)
    cell = (row & (TILE - 1)) << TILE_BITS | column & (TILE - 1)
    return np.float64(raster.room[np.uint64(tile << 2 * TILE_BITS | cell)])

"""Looking things up in the world's raster: is this point occupied, and how much room is there.

Points are given in cells: u = x / resolution + border is a column, v likewise a row. The callers
keep within the border, so that no index is negative or too large. Indices are unsigned because a
signed one costs a comparison more.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from animat.numerics.compiled import compiled
from animat.world.raster import Raster

SITES = 2

# A point lies within half a diagonal of the centre of its cell, and so does the point looked for:
# a clearance (from a cell's centre) speaks of other cells only to within one diagonal.
# The rest is for its being a float32.
DIAGONAL = 1.41421356237309515
ROUNDING = 0.01


@compiled
def occupied(u: float, v: float, solid: NDArray[np.int16], present: NDArray[np.uint8]) -> bool:
    """Tell whether a wall, or a site whose object is present, covers the cell of a point."""
    code = solid[np.uint64(int(v)), np.uint64(int(u))]
    if code < SITES:
        return code != 0
    return present[code - SITES] != 0


@compiled
def room(u: float, v: float, raster: Raster) -> float:
    """Return a distance (mm, may be negative) within which no cell near a point is occupied.

    Every cell that holds a point nearer to (u, v) than this is free, whichever objects are
    present: skipping what lies within it never changes what is found.
    """
    clearance = raster.clearance[np.uint64(int(v)), np.uint64(int(u))]
    return np.float64(clearance) - (DIAGONAL * raster.resolution + ROUNDING)

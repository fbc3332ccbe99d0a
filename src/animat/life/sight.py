"""Where objects are: how far away, and in which direction."""

from __future__ import annotations

import math

from animat.numerics.compiled import compiled
from animat.numerics.elementary import sine_cosine

OUT_OF_SIGHT = math.inf


@compiled
def row_and_column(x, y, raster):
    """Return the cell of a point."""
    row = int(y * raster.cells_per_mm + raster.border)
    column = int(x * raster.cells_per_mm + raster.border)
    return row, column


@compiled
def distance_to(site, x, y, raster):
    """Return how far (mm) the outline of a site is from a point; infinite beyond the horizon."""
    row, column = row_and_column(x, y, raster)
    for k in range(raster.near_site.shape[2]):
        if raster.near_site[row, column, k] == site:
            return raster.near_distance[row, column, k]
    return OUT_OF_SIGHT


@compiled
def bearing(state, raster):
    """Return how far ahead and how far to the left (mm) the centroid of the object lies."""
    sine, cosine = sine_cosine(state.heading)
    dx = raster.site_x[state.site] - state.x
    dy = raster.site_y[state.site] - state.y
    return cosine * dx + sine * dy, cosine * dy - sine * dx

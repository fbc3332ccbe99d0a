"""Small worlds drawn by shapely, apart from the package's own drawing."""

import math
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
import shapely
from scipy import ndimage

from animat.world.raster import Raster, tiled_room

Drawing = Callable[..., Raster]

SIDE = 300.0
MARGIN = 20.0


@cache
def _drawn(polygons: tuple[shapely.Polygon, ...] = (), resolution: float = 2.0) -> Raster:
    """Draw polygons (a site each) on a square floor, free from 20 to 280 mm along x and y."""
    border = math.ceil(100 / resolution)
    cells = math.ceil(SIDE / resolution) + 2 * border
    centres = (np.arange(cells) - border + 0.5) * resolution
    x, y = np.meshgrid(centres, centres)
    floor = shapely.box(MARGIN, MARGIN, SIDE - MARGIN, SIDE - MARGIN)
    solid = np.where(shapely.contains_xy(floor, x, y), 0, 1).astype(np.int16)
    points = shapely.points(x, y)
    clearance = shapely.distance(floor.boundary, points)
    for site, polygon in enumerate(polygons):
        solid[shapely.contains_xy(polygon, x, y) & (solid == 0)] = site + 2
        clearance = np.minimum(clearance, shapely.distance(polygon.boundary, points))
    clearance[solid > 0] = 0
    sites = len(polygons)
    clearance = clearance.astype(np.float32)
    tiles, room = tiled_room(clearance, resolution)
    return Raster(
        resolution=resolution,
        cells_per_mm=1.0 / resolution,
        border=border,
        tiles=tiles,
        room=room,
        solid=solid,
        clearance=clearance,
        near_site=np.full((cells, cells, 1), -1, dtype=np.int16),
        near_distance=np.full((cells, cells, 1), np.inf, dtype=np.float32),
        site_x=np.zeros(sites),
        site_y=np.zeros(sites),
        site_type=np.zeros(sites, dtype=np.int64),
        features=np.zeros((1, 2)),
        affords=np.zeros((1, 3)),
    )


@cache
def _scattered(seed: int, resolution: float = 2.0, objects: int = 5) -> Raster:
    """Draw triangles, squares and hexagons at random; they may overlap."""
    rng = np.random.default_rng(seed)
    polygons = []
    for corners in rng.integers(3, 7, objects):
        centre, radius = rng.uniform(60, 240, 2), rng.uniform(8, 35)
        angles = rng.uniform(0, math.tau) + math.tau * np.arange(corners) / corners
        outline = centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])
        polygons.append(shapely.Polygon(outline))
    return _drawn(tuple(polygons), resolution)


@cache
def _dust(seed: int, resolution: float = 2.0, specks: int = 60) -> Raster:
    """Scatter specks, each a site in the middle of one cell: the hardest to see of all objects."""
    raster = _drawn(resolution=resolution)
    rng = np.random.default_rng(seed)
    solid = raster.solid.copy()
    row, column = (rng.uniform(30, 270, (2, specks)) / resolution + raster.border).astype(int)
    solid[row, column] = 2 + np.arange(specks)
    clearance = (ndimage.distance_transform_edt(solid == 0) * resolution).astype(np.float32)
    _, room = tiled_room(clearance, resolution)
    return raster._replace(solid=solid, clearance=clearance, room=room)


@pytest.fixture(scope="session")
def dust() -> Drawing:
    return _dust


@pytest.fixture(scope="session")
def drawn() -> Drawing:
    return lambda polygons=(), resolution=2.0: _drawn(tuple(polygons), resolution)


@pytest.fixture(scope="session")
def scattered() -> Drawing:
    return _scattered

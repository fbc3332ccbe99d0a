import hashlib
import math
import os
import subprocess
import sys

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from animat.files.settings import SettingsError
from animat.world.arena import Arena
from animat.world.geometry import packed
from animat.world.raster import BORDER_MM, FIRST_SITE, FREE, MOST_ROOM, TILE, WALL, draw
from animat.world.shapes import area_and_centroid
from animat.world.world import World

NONE = np.empty((0, 0))


def star(rng, corners):
    angles = (np.arange(corners) + rng.uniform(0.1, 0.9, corners)) * 2 * math.pi / corners
    radii = rng.uniform(0.2, 1.0, corners) * 45.0
    points = np.column_stack((radii * np.cos(angles), radii * np.sin(angles)))
    return points - area_and_centroid(points)[1]


def random_world(seed, sites, side=400.0):
    """Polygons, seldom convex, that do not touch each other or a wall."""
    rng = np.random.default_rng(seed)
    arena = Arena(width=side, height=side * 0.8, left=11, right=22, bottom=33, top=4)
    left, right, bottom, top = arena.free
    free = shapely.box(left, bottom, right, top)
    polygons, poses, shapes = [], [], []
    while len(poses) < sites:
        own = star(rng, int(rng.integers(3, 9))) * rng.uniform(0.3, 1.0)
        pose = (*rng.uniform((left, bottom), (right, top)), rng.uniform(0, 7))
        outlines = packed([own], np.array([pose]))
        shape = shapely.Polygon(outlines.outline)
        if free.contains(shape) and all(shape.distance(other) > 0.1 for other in shapes):
            polygons.append(own)
            poses.append(pose)
            shapes.append(shape)
    return arena, packed(polygons, np.array(poses).reshape(-1, 3)), shapes


def drawn(arena, outlines, horizon, resolution):
    kinds = np.zeros(len(outlines.reach), dtype=np.int64)
    return draw(arena, outlines, kinds, NONE, NONE, horizon, resolution)


def centres(raster):
    rows, columns = raster.solid.shape
    x = (np.arange(columns) - raster.border + 0.5) * raster.resolution
    y = (np.arange(rows) - raster.border + 0.5) * raster.resolution
    return np.meshgrid(x, y)


@settings(max_examples=settings().max_examples // 3)
@given(
    st.integers(0, 2**32), st.integers(0, 7), st.sampled_from([0.0, 25.0, 90.0]),
    st.sampled_from([2.0, 3.7, 10.0]),
)  # fmt: skip
def test_occupancy_clearance_and_near_sites_are_shapelys(seed, sites, horizon, resolution):
    arena, outlines, shapes = random_world(seed, sites)
    raster = drawn(arena, outlines, horizon, resolution)
    x, y = centres(raster)
    left, right, bottom, top = arena.free

    solid = np.where((x > left) & (x < right) & (y > bottom) & (y < top), FREE, WALL)
    clearance = np.minimum.reduce([x - left, right - x, y - bottom, top - y]).clip(min=0)
    places = shapely.points(x, y)
    to_site = np.full((*x.shape, max(1, sites)), np.inf)
    for s, shape in enumerate(shapes):
        solid[shapely.contains_xy(shape, x, y)] = FIRST_SITE + s
        to_site[..., s] = shapely.distance(shape, places)
    clearance = np.minimum(clearance, to_site.min(axis=2))
    np.testing.assert_array_equal(raster.solid, solid)
    np.testing.assert_allclose(raster.clearance, clearance, rtol=1e-6, atol=1e-5)
    assert (raster.clearance[raster.solid != FREE] == 0).all()

    near = np.sort(np.where(to_site <= horizon, to_site, np.inf), axis=2)
    most = max(1, int((near < np.inf).sum(axis=2).max()))
    assert raster.near_site.shape == raster.near_distance.shape == (*x.shape, most)
    np.testing.assert_allclose(raster.near_distance, near[..., :most], rtol=1e-6, atol=1e-5)
    listed = raster.near_site >= 0
    np.testing.assert_array_equal(listed, raster.near_distance < np.inf)
    of_the_listed = np.take_along_axis(to_site, raster.near_site.clip(min=0).astype(int), axis=2)
    np.testing.assert_allclose(
        raster.near_distance[listed], of_the_listed[listed], rtol=1e-6, atol=1e-5
    )
    in_order = np.sort(raster.near_site, axis=2)
    assert ((np.diff(in_order, axis=2) > 0) | (in_order[..., 1:] < 0)).all()


def untiled(raster):
    """Room [R, C] in rows and columns."""
    columns = raster.tiles
    tiles = raster.room.reshape(-1, columns, TILE, TILE)
    rows, there = raster.solid.shape
    return tiles.swapaxes(1, 2).reshape(-1, columns * TILE)[:rows, :there]


@settings(max_examples=settings().max_examples // 3)
@given(st.integers(0, 2**32), st.integers(0, 7), st.sampled_from([0.7, 2.0, 3.7, 10.0]))
def test_room_is_free_round_every_point_of_a_cell_and_nearly_all_there_is(seed, sites, resolution):
    arena, outlines, _ = random_world(seed, sites, side=200.0)
    raster = drawn(arena, outlines, 0.0, resolution)
    room = untiled(raster).astype(float)
    # From the middle of the nearest solid cell to that of each: up to a diagonal more than from
    # any point of the one to any point of the other.
    apart = ndimage.distance_transform_edt(raster.solid == FREE) * resolution
    diagonal = math.sqrt(2.0) * resolution
    assert (room[room > 0] <= (apart - diagonal)[room > 0]).all()
    most = np.minimum(raster.clearance - diagonal - 1.1, MOST_ROOM)
    assert (room >= most).all()


def test_the_cell_of_a_point_is_where_the_contract_says():
    square = 20.0 * np.array([(-1.0, -1), (1, -1), (1, 1), (-1, 1)])
    outlines = packed([square], np.array([(300.0, 700.0, 0.0)]))
    raster = drawn(Arena(), outlines, 50.0, 2.0)
    assert raster.border * raster.resolution >= BORDER_MM
    assert raster.solid.shape == (600, 600)

    def cell(x, y):
        return int(y / 2.0 + raster.border), int(x / 2.0 + raster.border)

    assert raster.solid[cell(300.0, 700.0)] == FIRST_SITE
    assert raster.solid[cell(319.9, 719.9)] == FIRST_SITE
    assert raster.solid[cell(320.1, 700.0)] == FREE
    assert raster.solid[cell(700.0, 300.0)] == FREE
    assert raster.solid[cell(21.9, 500.0)] == WALL
    assert raster.solid[cell(22.1, 500.0)] == FREE
    assert raster.solid[cell(500.0, 25.9)] == WALL
    assert raster.solid[cell(500.0, 26.1)] == FREE
    assert raster.clearance[cell(341.0, 701.0)] == 21.0
    assert raster.near_distance[cell(341.0, 701.0)][0] == 21.0
    assert raster.near_site[cell(341.0, 701.0)][0] == 0
    assert raster.near_distance[cell(301.0, 701.0)][0] == 0.0
    assert raster.solid[cell(-99.9, -99.9)] == WALL
    assert raster.solid[cell(1099.9, 1099.9)] == WALL
    np.testing.assert_array_equal(raster.site_x, [300.0])
    np.testing.assert_array_equal(raster.site_y, [700.0])


def test_of_two_sites_equally_near_the_first_is_listed_first():
    square = 20.0 * np.array([(-1.0, -1), (1, -1), (1, 1), (-1, 1)])
    outlines = packed([square, square], np.array([(301.0, 500.0, 0.0), (401.0, 500.0, 0.0)]))
    raster = drawn(Arena(), outlines, 50.0, 2.0)
    row, column = int(500 / 2 + raster.border), int(351 / 2 + raster.border)
    np.testing.assert_array_equal(raster.near_site[row, column], [0, 1])
    assert raster.near_distance[row, column, 0] == raster.near_distance[row, column, 1] == 30.0


def test_fields_have_the_types_compiled_code_is_told():
    arena, outlines, _ = random_world(1, 3)
    raster = drawn(arena, outlines, 50.0, 4.0)
    kinds = {name: getattr(raster, name).dtype for name in raster._fields[4:]}
    assert kinds == {
        "room": np.uint8,
        "solid": np.int16, "clearance": np.float32, "near_site": np.int16,
        "near_distance": np.float32, "site_x": np.float64, "site_y": np.float64,
        "site_type": np.int64, "features": np.float64, "affords": np.float64,
    }  # fmt: skip
    assert all(getattr(raster, name).flags.c_contiguous for name in kinds)


@pytest.mark.parametrize("horizon", [-1.0, math.nan, math.inf])
def test_impossible_horizons_are_refused(horizon):
    with pytest.raises(SettingsError, match="horizon"):
        World.abundant().raster(horizon)


def test_a_raster_beyond_memory_is_refused():
    with pytest.raises(ValueError, match="resolution"):
        drawn(Arena(width=1e6, height=1e6), packed([], np.empty((0, 3))), 50.0, 2.0)


def fingerprint():
    """A hash of a small raster, of shapes whose corners need no library's sine."""
    square = 14.0 * np.array([(-1.0, -1), (1, -1), (0.2, 0.1), (-1, 1)])
    outlines = packed([square, square], np.array([(60.0, 70.0, 0.3), (110.0, 80.0, 2.0)]))
    raster = drawn(Arena(width=160.0, height=150.0), outlines, 40.0, 6.0)
    digest = hashlib.sha256()
    for field in raster[4:9]:
        digest.update(np.ascontiguousarray(field).tobytes())
    return digest.hexdigest()


def test_uncompiled_code_draws_the_same_bits():
    code = (
        "import importlib.util as u, sys;"
        f"s = u.spec_from_file_location('t', {__file__!r});"
        "m = u.module_from_spec(s); s.loader.exec_module(m); print(m.fingerprint())"
    )
    told = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, check=True, capture_output=True, text=True,
    )  # fmt: skip
    assert told.stdout.strip() == fingerprint()


def test_a_cell_that_the_arena_only_begins_is_drawn():
    arena = Arena(width=402.0, height=403.0)
    raster = drawn(arena, packed([], np.empty((0, 3))), 0.0, 4.0)
    rows, columns = raster.solid.shape
    assert (columns - raster.border) * 4.0 >= arena.width + BORDER_MM
    assert (rows - raster.border) * 4.0 >= arena.height + BORDER_MM

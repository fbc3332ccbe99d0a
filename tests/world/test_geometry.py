import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from animat.world.geometry import packed, polygon_gap, signed_distance
from animat.world.shapes import area_and_centroid


def star(rng, corners):
    """A random polygon [n, 2] about its centroid, seldom convex."""
    angles = (np.arange(corners) + rng.uniform(0.1, 0.9, corners)) * 2 * math.pi / corners
    radii = rng.uniform(0.1, 1.0, corners) * 60.0
    points = np.column_stack((radii * np.cos(angles), radii * np.sin(angles)))
    return points - area_and_centroid(points)[1]


@given(st.integers(0, 2**32), st.integers(3, 12))
def test_signed_distance_is_shapelys(seed, corners):
    rng = np.random.default_rng(seed)
    points = star(rng, corners)
    shape = shapely.Polygon(points)
    for x, y in rng.uniform(-90, 90, (30, 2)):
        distance = signed_distance(x, y, points, 0, corners)
        place = shapely.Point(x, y)
        assert abs(distance) == pytest.approx(shape.exterior.distance(place), abs=1e-9)
        assert (distance < 0) == shape.contains(place)


@given(st.integers(0, 2**32), st.integers(3, 9), st.integers(3, 9), st.floats(0, 150))
def test_the_gap_of_two_polygons_is_shapelys(seed, corners_a, corners_b, away):
    rng = np.random.default_rng(seed)
    poses = np.array([(0, 0, rng.uniform(0, 7)), (away, 3, rng.uniform(0, 7))])
    small = star(rng, corners_b) * rng.choice([0.1, 1.0])
    outline, first, _, _ = packed([star(rng, corners_a), small], poses)
    a = shapely.Polygon(outline[: first[1]])
    b = shapely.Polygon(outline[first[1] :])
    gap = polygon_gap(outline, *first[:2], *first[1:])
    assert gap == pytest.approx(a.distance(b), abs=1e-9)
    assert polygon_gap(outline, *first[1:], *first[:2]) == pytest.approx(gap, abs=1e-12)


def test_a_polygon_within_another_touches_it():
    square = np.array([(-1.0, -1), (1, -1), (1, 1), (-1, 1)])
    outline, first, _, _ = packed([50 * square, square], np.array([(0, 0, 0), (9, 9, 1)]))
    assert polygon_gap(outline, *first[:2], *first[1:]) == 0.0
    assert polygon_gap(outline, *first[1:], *first[:2]) == 0.0


@given(st.integers(0, 2**32), st.floats(-10, 10))
def test_packing_turns_anticlockwise_then_shifts(seed, angle):
    rng = np.random.default_rng(seed)
    polygons = [star(rng, 5), star(rng, 3)]
    poses = np.array([(100.0, 200.0, angle), (-30.0, 40.0, 0.0)])
    outlines = packed(polygons, poses)
    turned = polygons[0] @ np.array(
        [[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]]
    )
    np.testing.assert_allclose(outlines.outline[:5], turned + np.array([100, 200]), atol=1e-9)
    np.testing.assert_array_equal(outlines.outline[5:], polygons[1] + np.array([-30, 40]))
    np.testing.assert_array_equal(outlines.first, [0, 5, 8])
    np.testing.assert_array_equal(outlines.centre, poses[:, :2])
    np.testing.assert_allclose(outlines.reach[0], np.linalg.norm(polygons[0], axis=1).max())

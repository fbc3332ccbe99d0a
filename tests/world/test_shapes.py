import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from animat.world.shapes import SIDES, area_and_centroid, polygon


def star(seed, corners=9, radius=60.0):
    """A random polygon [n, 2], seldom convex, that crosses itself nowhere."""
    rng = np.random.default_rng(seed)
    angles = (np.arange(corners) + rng.uniform(0.1, 0.9, corners)) * 2 * math.pi / corners
    radii = rng.uniform(0.2, 1.0, corners) * radius
    return np.column_stack((radii * np.cos(angles), radii * np.sin(angles)))


@pytest.mark.parametrize("shape", [*SIDES, 3, 7, 12, 64])
def test_regular_shapes_have_equal_sides_and_their_centre_at_the_origin(shape):
    corners = polygon(shape, 50.0)
    assert len(corners) == SIDES.get(shape, shape)
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
    np.testing.assert_allclose(sides, sides[0], atol=1e-8)
    outline = shapely.Polygon(corners)
    assert outline.is_valid
    assert outline.exterior.is_ccw
    np.testing.assert_allclose(outline.centroid.coords[0], (0, 0), atol=1e-8)
    assert corners[0, 1] == pytest.approx(corners[-1, 1])


def test_a_triangle_is_measured_by_its_side():
    corners = polygon("triangle", 45.0)
    assert np.linalg.norm(corners[1] - corners[0]) == pytest.approx(45.0)


@pytest.mark.parametrize("shape", ["square", "octagon", "hexagon", 5, 32])
def test_other_shapes_are_measured_across_the_circle_within(shape):
    outline = shapely.Polygon(polygon(shape, 38.0))
    assert outline.exterior.distance(shapely.Point(0, 0)) == pytest.approx(19.0)


def test_an_octagon_is_as_wide_as_it_is_high():
    corners = polygon("octagon", 100.0)
    np.testing.assert_allclose(np.ptp(corners, axis=0), 100.0)


@given(st.integers(0, 2**32), st.booleans(), st.tuples(st.floats(-500, 500), st.floats(-500, 500)))
def test_corners_of_ones_own_are_centred_and_anticlockwise(seed, clockwise, shift):
    given_corners = star(seed) + shift
    corners = polygon(given_corners[::-1] if clockwise else given_corners)
    outline = shapely.Polygon(corners)
    assert outline.exterior.is_ccw
    np.testing.assert_allclose(outline.centroid.coords[0], (0, 0), atol=1e-8)
    assert outline.area == pytest.approx(shapely.Polygon(given_corners).area)


@given(st.integers(0, 2**32))
def test_area_and_centroid_are_shapelys(seed):
    corners = star(seed)
    area, centroid = area_and_centroid(corners)
    outline = shapely.Polygon(corners)
    assert area == pytest.approx(outline.area)
    np.testing.assert_allclose(centroid, outline.centroid.coords[0], atol=1e-9)
    assert area_and_centroid(corners[::-1])[0] == pytest.approx(-area)


@given(st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), min_size=3, max_size=7))
def test_corners_are_refused_exactly_when_they_make_no_simple_polygon(corners):
    scaled = [(10.0 * x, 10.0 * y) for x, y in corners]
    distinct = all(a != b for a, b in zip(scaled, scaled[1:] + scaled[:1], strict=True))
    simple = distinct and shapely.Polygon(scaled).is_valid and shapely.Polygon(scaled).area > 0
    if simple:
        assert len(polygon(scaled)) == len(scaled)
    else:
        with pytest.raises(ValueError, match=r"touch or cross|area"):
            polygon(scaled)


@pytest.mark.parametrize(
    ("shape", "size", "message"),
    [
        ("circel", 5.0, "unknown shape"),
        (2, 5.0, "3 to 64"),
        (65, 5.0, "3 to 64"),
        ("square", None, "size"),
        ("square", 0.0, "size"),
        ("square", math.nan, "size"),
        ([(0, 0), (10, 0), (0, 10)], 5.0, "leave it out"),
        ([(0, 0), (10, 0)], None, "three pairs"),
        ([(0, 0), (10, 0), (0, 1, 2)], None, "three pairs"),
        ([(0, 0), (10, 0), (0, math.inf)], None, "not a number from"),
        ([(0, 0), (1, 0), (0, 1)], None, "area"),
        ([(0, 0), (10, 10), (10, 0), (0, 10)], None, "sides 0 and 2"),
    ],
)
def test_impossible_shapes_are_refused(shape, size, message):
    with pytest.raises(ValueError, match=message):
        polygon(shape, size)

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from animat.numerics.compiled import compiled
from animat.robot.collision import CLEAR, collide, touched
from animat.robot.khepera import Khepera
from animat.robot.motion import move

ROBOT = Khepera().parameters()
EXACT = Khepera(motor_noise=False).parameters()
ALL = np.ones(8, dtype=np.uint8)
FLAT = math.pi / 8
"""The heading in which the ring's flat side, not a point, faces a wall: 27.7 mm, not 30."""

commands = st.tuples(st.integers(-10, 10), st.integers(-10, 10))


@pytest.fixture(scope="module")
def worlds(scattered):
    return [scattered(seed) for seed in range(6)]


@pytest.fixture(scope="module")
def drawn_once(drawn):
    return drawn([shapely.Polygon([(120, 120), (180, 125), (140, 185)])])


def ring_codes(x, y, heading, raster):
    """What covers the cells of the ring points [..., 8], found apart from the package."""
    x, y, heading = (np.asarray(value)[..., None] for value in (x, y, heading))
    points = x + 1j * y + 30 * np.exp(1j * (heading + np.arange(8) * math.pi / 4))
    column = (points.real / raster.resolution + raster.border).astype(int)
    row = (points.imag / raster.resolution + raster.border).astype(int)
    return raster.solid[row, column]


def ring_hits(x, y, heading, raster, present=ALL):
    code = ring_codes(x, y, heading, raster)
    return np.flatnonzero((code == 1) | ((code > 1) & (present[np.maximum(code - 2, 0)] > 0)))


def test_free_step_is_left_alone(drawn):
    assert collide(100.0, 100.0, 0.0, 104.0, 101.0, 0.1, ROBOT, drawn(), ALL) == (
        104.0,
        101.0,
        0.1,
        False,
    )


def test_front_or_back_hit_restores_the_whole_pose(drawn):
    raster = drawn()
    head_on = collide(248.0, 150.0, 0.02, 253.0, 150.0, 0.05, ROBOT, raster, ALL)
    assert head_on == (248.0, 150.0, 0.02, True)
    backing = collide(52.0, 150.0, 0.02, 47.0, 150.0, 0.05, ROBOT, raster, ALL)
    assert backing == (52.0, 150.0, 0.02, True)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        # Along the upper wall: point 2 hits straight above, then a little behind.
        ((150.0, 249.0, 0.0), (155.0, 251.0, 0.0), (150.0, 248.0, 0.0)),
        ((150.0, 249.0, 0.0), (155.0, 251.0, 0.1), (151.0, 248.0, 0.1)),
        # The lower wall, point 6.
        ((150.0, 51.0, 0.0), (155.0, 49.0, 0.0), (150.0, 52.0, 0.0)),
        # Facing up, the right and the left wall.
        ((249.0, 150.0, math.pi / 2), (251.0, 155.0, math.pi / 2), (248.0, 150.0, math.pi / 2)),
        ((51.0, 150.0, math.pi / 2), (49.0, 155.0, math.pi / 2), (52.0, 150.0, math.pi / 2)),
    ],
)
def test_side_hit_restores_the_place_pushes_and_keeps_the_new_heading(old, new, expected, drawn):
    assert collide(*old, *new, ROBOT, drawn(), ALL) == (*expected, True)


@pytest.mark.parametrize(
    ("heading", "point"), [(0.0, 1), (-math.pi / 2, 3), (math.pi, 5), (math.pi / 2, 7)]
)
def test_corner_of_an_object_pushes_along_both_axes(heading, point, drawn):
    raster = drawn([shapely.box(176, 176, 200, 200)])
    assert touched(156.0, 156.0, heading, ROBOT, raster, ALL) == point
    pushed = collide(150.0, 150.0, 0.3, 156.0, 156.0, heading, ROBOT, raster, ALL)
    assert pushed == (149.0, 149.0, heading, True)


def test_first_point_in_order_decides(drawn):
    # In a corner two sides touch: front or back go before right or left.
    raster = drawn()
    assert touched(251.0, 251.0, 0.0, ROBOT, raster, ALL) == 0
    assert touched(251.0, 251.0, math.pi, ROBOT, raster, ALL) == 4
    raster = drawn([shapely.box(100, 180, 200, 220), shapely.box(100, 80, 200, 120)])
    assert touched(150.0, 150.5, 0.0, ROBOT, raster, ALL) == 2
    assert touched(150.0, 149.5, 0.0, ROBOT, raster, ALL) == 6
    assert touched(150.0, 150.0, 0.0, ROBOT, raster, ALL) == 2


def test_points_are_tried_front_back_then_round(scattered):
    order = [0, 4, 1, 2, 3, 5, 6, 7]
    rng = np.random.default_rng(2)
    met = set()
    for seed in range(3):
        raster = scattered(seed)
        present = rng.integers(0, 2, 5).astype(np.uint8)
        for _ in range(300):
            pose = (*rng.uniform(40, 260, 2).tolist(), rng.uniform(-3.1, 3.1))
            hits = set(ring_hits(*pose, raster, present).tolist())
            expected = next((point for point in order if point in hits), CLEAR)
            assert touched(*pose, ROBOT, raster, present) == expected
            met.add(expected)
    assert met == {CLEAR, *order}


def test_absent_objects_stop_nobody(drawn):
    raster = drawn([shapely.box(176, 140, 200, 160)])
    step = (144.0, 150.0, 0.0, 149.0, 150.0, 0.0)
    assert collide(*step, ROBOT, raster, np.ones(1, np.uint8))[3]
    assert not collide(*step, ROBOT, raster, np.zeros(1, np.uint8))[3]


def test_turn_waits_until_the_push_has_made_room(drawn):
    """A turn beside a wall lifts the ring by up to 2.3 mm: one push of 1 mm may be too little."""
    raster = drawn()
    heading = FLAT + 0.26
    pose = collide(251.5, 150.0, FLAT, 251.5, 150.0, heading, ROBOT, raster, ALL)
    assert pose == (250.5, 151.0, FLAT, True)
    pose = collide(*pose[:3], *pose[:2], heading, ROBOT, raster, ALL)
    assert pose == (249.5, 152.0, heading, True)


def test_push_waits_where_it_would_end_in_another_hit(drawn):
    raster = drawn([shapely.box(60, 200, 240, 218)])
    step = (150.0, 248.5, 0.0, 154.0, 250.5, 0.01)
    assert collide(*step, ROBOT, raster, ALL) == (150.0, 248.5, 0.01, True)


def test_step_is_undone_where_neither_turn_nor_push_has_room(drawn):
    raster = drawn([shapely.box(60, 200, 240, 224)])
    step = (150.0, 252.0, FLAT, 150.0, 252.0, FLAT + 0.2)
    assert collide(*step, ROBOT, raster, ALL) == (150.0, 252.0, FLAT, True)


def test_room_culls_nothing_that_is_hit(scattered):
    rng = np.random.default_rng(6)
    for resolution in (2.0, 3.0):
        raster = scattered(1, resolution)
        blind = raster._replace(room=np.zeros_like(raster.room))
        for _ in range(400):
            pose = (*rng.uniform(40, 260, 2).tolist(), rng.uniform(-3.1, 3.1))
            assert touched(*pose, ROBOT, raster, ALL) == touched(*pose, ROBOT, blind, ALL)


@compiled
def follow(pose, motors, uniforms, robot, raster, present, goals, poses):
    """Drive by motors[N, 2], and note where each step would have led and where it did."""
    x, y, heading = pose
    for step in range(motors.shape[0]):
        left, right = motors[step]
        u_x, u_y, u_turn = uniforms[step]
        goal = move(x, y, heading, left, right, robot, u_x, u_y, u_turn)
        after = collide(x, y, heading, goal[0], goal[1], goal[2], robot, raster, present)
        x, y, heading = after[0], after[1], after[2]
        goals[step, 0], goals[step, 1], goals[step, 2] = goal
        poses[step, 0], poses[step, 1], poses[step, 2], poses[step, 3] = x, y, heading, after[3]


def driven(pose, motors, rng, robot, raster):
    motors = np.asarray(motors, dtype=np.int64)
    goals, poses = np.empty((len(motors), 3)), np.empty((len(motors), 4))
    uniforms = rng.random((len(motors), 3))
    follow(pose, motors, uniforms, robot, raster, ALL, goals, poses)
    return goals, poses


def held(drives):
    return [command for command, steps in drives for _ in range(steps)]


@given(
    world=st.integers(0, 5),
    start=st.integers(0, 2**32 - 1),
    drives=st.lists(st.tuples(commands, st.integers(1, 30)), min_size=1, max_size=15),
    robot=st.sampled_from([ROBOT, EXACT]),
)
def test_robot_never_enters_anything(world, start, drives, robot, worlds):
    raster = worlds[world]
    rng = np.random.default_rng(start)
    pose = (40.0, 40.0, 0.0)
    while ring_hits(*pose, raster).size:
        pose = (*rng.uniform(51, 249, 2).tolist(), rng.uniform(-3.1, 3.1))
    goals, poses = driven(pose, held(drives), rng, robot, raster)
    before = np.vstack([pose, poses[:-1, :3]])
    blocked = (ring_codes(*goals.T, raster) > 0).any(axis=1)
    np.testing.assert_array_equal(poses[:, 3], blocked)
    np.testing.assert_array_equal(poses[~blocked, :3], goals[~blocked])
    moved = np.abs(poses[blocked, :2] - before[blocked, :2])
    assert moved.max(initial=0) <= 1 + 1e-12  # a push of 1 mm, rounded
    assert (ring_codes(*poses[:, :3].T, raster) == 0).all()
    assert ((poses[:, :2] > 20) & (poses[:, :2] < 280)).all()


@given(
    start=st.integers(0, 2**32 - 1),
    stubborn=st.lists(st.tuples(commands, st.integers(10, 100)), min_size=1, max_size=6),
)
def test_robot_can_always_leave(start, stubborn, drawn_once):
    """However long it was driven against things, random commands soon take it elsewhere."""
    rng = np.random.default_rng(start)
    pose = (85.0, 85.0, rng.uniform(-3.1, 3.1))
    _, poses = driven(pose, held(stubborn), rng, ROBOT, drawn_once)
    stuck = poses[-1, :3]
    freeing = np.repeat(rng.integers(-10, 11, (250, 2)), 8, axis=0)
    _, poses = driven(tuple(stuck.tolist()), freeing, rng, ROBOT, drawn_once)
    assert np.hypot(*(poses[:, :2] - stuck[:2]).T).max() > 30

import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from animat.robot.khepera import Khepera
from animat.robot.motion import move, principal

EXACT = Khepera(motor_noise=False).parameters()
NOISY = Khepera().parameters()
motors = st.integers(-10, 10)
headings = st.floats(-math.pi, math.pi, exclude_min=True)


def drive(left, right, steps, heading=0.0, robot=EXACT):
    x, y = 0.0, 0.0
    for _ in range(steps):
        x, y, heading = move(x, y, heading, left, right, robot, 0.3, 0.9, 0.1)
    return x, y, heading


@given(motors, motors, st.integers(1, 40), headings)
def test_constant_motors_draw_an_arc(left, right, steps, heading):
    """The sum of the steps' chords in closed form, as a geometric series."""
    turn, forward = (right - left) / 100, (left + right) / 4
    series = steps if turn == 0 else math.sin(steps * turn / 2) / math.sin(turn / 2)
    goal = forward * series * cmath.exp(1j * (heading + steps * turn / 2))
    x, y, after = drive(left, right, steps, heading)
    assert complex(x, y) == pytest.approx(goal, abs=1e-10)
    assert cmath.exp(1j * after) == pytest.approx(cmath.exp(1j * (heading + steps * turn)))
    assert -math.pi < after <= math.pi


def test_turn_in_place_stays():
    assert drive(-7, 7, 1) == (0.0, 0.0, 0.14)


def test_straight_line_is_half_a_millimetre_a_unit():
    assert drive(10, 10, 20) == (100.0, 0.0, 0.0)
    x, y, heading = drive(-4, -4, 5, math.pi / 2)
    assert (x, y, heading) == pytest.approx((0.0, -10.0, math.pi / 2), abs=1e-14)


@given(st.integers(-1000, 1000), st.integers(-1000, 1000))
def test_motors_are_held_to_their_range(left, right):
    held = [min(max(motor, -10), 10) for motor in (left, right)]
    assert drive(left, right, 1) == drive(*held, 1)


def test_geometry_is_a_setting():
    robot = Khepera(step_mm=0.25, wheel_base=40.0, max_motor=4, motor_noise=False).parameters()
    x, _, heading = drive(2, 9, 1, robot=robot)
    assert heading == 0.25 * 2 / 40
    assert x == pytest.approx(0.25 * 3 * math.cos(heading / 2))


def test_heading_is_kept_in_its_half_open_circle():
    assert principal(math.pi) == math.pi
    assert principal(-math.pi) == math.pi
    assert principal(math.nextafter(math.pi, 4)) < 0
    assert principal(0.25) == 0.25


def test_noise_bounds():
    assert move(0.0, 0.0, 0.0, 10, 10, NOISY, 0.0, 0.5, 0.5)[0] == pytest.approx(4.5)
    assert move(0.0, 0.0, 0.0, 10, 10, NOISY, 0.5, 0.0, 0.0)[0] == 5.0
    last = 1 - 2**-32
    assert move(0.0, 0.0, 0.0, 10, 10, NOISY, last, 0.5, 0.5)[0] == pytest.approx(5.5)
    assert move(0.0, 0.0, 0.0, -10, 10, NOISY, 0.5, 0.5, 0.0)[2] == pytest.approx(0.19)
    assert move(0.0, 0.0, 0.0, -10, 10, NOISY, 0.5, 0.5, last)[2] == pytest.approx(0.21)


def test_noise_of_each_axis_and_of_the_turn_is_uniform_and_its_own():
    uniforms = np.random.default_rng(5).random((4000, 3))
    poses = np.array([move(0.0, 0.0, 0.5, 8, 8, NOISY, *u) for u in uniforms])
    turns = np.array([move(0.0, 0.0, 0.5, -8, 8, NOISY, *u)[2] - 0.5 for u in uniforms])
    along_x, along_y = poses[:, 0] / math.cos(0.5) / 4, poses[:, 1] / math.sin(0.5) / 4
    assert stats.kstest(along_x, "uniform", (0.90, 0.20)).pvalue > 0.01
    assert stats.kstest(along_y, "uniform", (0.90, 0.20)).pvalue > 0.01
    assert stats.kstest(turns / 0.16, "uniform", (0.95, 0.10)).pvalue > 0.01
    correlation = np.corrcoef([along_x, along_y, turns])
    assert np.abs(correlation - np.eye(3)).max() < 0.06
    assert (poses[:, 2] == 0.5).all()

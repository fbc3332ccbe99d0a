import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from animat.mind.behaviours import (
    ALARM,
    CURVED_WANDER,
    CUSTOM_WANDER,
    approach,
    curved_wander,
    faces,
    has_left,
    leave,
    wander,
)
from animat.numerics.compiled import compiled

# Four sensors that look ahead, two on the left and two on the right, one on each side, two behind.
AHEADS = np.array([0.0, 0.7, 1.0, 1.0, 0.7, 0.0, -1.0, -1.0])
SIDES = np.array([25.0, 20.0, 8.0, -8.0, -20.0, -25.0, 10.0, -10.0])
CLEAR = np.zeros(8, np.int64)
SPEED, TURN = 5, 4
LEFT_TURN, RIGHT_TURN = (-TURN, TURN), (TURN, -TURN)


def readings(**raised):
    out = CLEAR.copy()
    for sensor, reading in raised.items():
        out[int(sensor[1:])] = reading
    return out


def wandering(seen, memory, u_a=0.5, u_b=0.5):
    return curved_wander(seen, AHEADS, SIDES, memory, u_a, u_b, SPEED, TURN)


@pytest.mark.parametrize(
    ("seen", "motors"),
    [
        (readings(s1=ALARM + 1), RIGHT_TURN),
        (readings(s2=1023), RIGHT_TURN),
        (readings(s3=ALARM + 1), LEFT_TURN),
        (readings(s4=1023), LEFT_TURN),
        (readings(s1=400, s2=300, s3=600), RIGHT_TURN),
        (readings(s2=600, s3=400, s4=300), LEFT_TURN),
        (readings(s2=500, s3=500), RIGHT_TURN),
        (readings(s1=ALARM, s2=ALARM, s3=ALARM, s4=ALARM), (SPEED, SPEED)),
        (readings(s0=1023, s5=1023, s6=1023, s7=1023), (SPEED, SPEED)),
    ],
)
def test_wandering_turns_away_from_what_stands_ahead(seen, motors):
    assert wandering(seen, np.zeros(4)) == motors


def test_wandering_keeps_turning_the_same_way_until_the_view_is_free():
    memory = np.zeros(4)
    assert wandering(readings(s2=600), memory) == RIGHT_TURN
    assert wandering(readings(s3=900), memory) == RIGHT_TURN
    assert wandering(CLEAR, memory) == (SPEED, SPEED)
    assert wandering(readings(s3=900), memory) == LEFT_TURN


def test_turning_in_vain_is_broken_off_by_going_back():
    memory, seen = np.zeros(4), readings(s3=900)
    motors = [wandering(seen, memory) for _ in range(1000)]
    back = (-SPEED, -SPEED)
    assert set(motors) == {LEFT_TURN, back}
    vain = motors.index(back)
    retreat = motors[vain:].index(LEFT_TURN)
    assert 30 <= vain <= 70  # about once round
    assert 0 < retreat < vain
    assert 2 < motors.count(back) / retreat < 1000 / vain


def test_a_free_view_ends_the_turn_and_starts_it_anew():
    memory, seen = np.zeros(4), readings(s3=900)
    for _ in range(5):
        for _ in range(30):
            assert wandering(seen, memory) == LEFT_TURN
        assert wandering(CLEAR, memory) == (SPEED, SPEED)


@pytest.mark.parametrize(("luck", "curve"), [(0.0, -1), (0.5, 0), (1 - 2.0**-32, 1)])
@pytest.mark.parametrize(("u_b", "length"), [(0.0, 1), (0.5, 41), (1 - 2.0**-32, 80)])
def test_a_curve_is_kept_for_as_long_as_luck_gave_it(luck, curve, u_b, length):
    memory = np.zeros(4)
    bent = (SPEED - curve, SPEED + curve)
    assert wandering(CLEAR, memory, luck, u_b) == bent
    for _ in range(length - 1):
        assert wandering(CLEAR, memory, 0.5 if curve else 0.0, 0.9) == bent
    assert wandering(CLEAR, memory, 0.5 if curve else 0.0, 0.9) != bent


def test_curves_go_left_right_and_ahead_equally_often():
    rng = np.random.default_rng(5)
    bends = []
    for luck in rng.random(9000):
        left, right = wandering(CLEAR, np.zeros(4), luck, 0.0)
        assert left + right == 2 * SPEED
        bends.append(right - left)
    values, counts = np.unique(bends, return_counts=True)
    np.testing.assert_array_equal(values, [-2, 0, 2])
    assert stats.chisquare(counts).pvalue > 1e-4


@compiled
def stubborn(seen, aheads, sides, memory, u_a, u_b, speed, turn):
    memory[3] += 1.0
    return speed, speed - 1


def test_wander_controllers_answer_to_their_codes():
    seen, senses, rest = readings(s3=900), (AHEADS, SIDES), (0.5, 0.5, SPEED, TURN, stubborn)
    assert wander(CURVED_WANDER, seen, *senses, np.zeros(4), *rest) == LEFT_TURN
    memory = np.zeros(4)
    assert wander(CUSTOM_WANDER, seen, *senses, memory, *rest) == (SPEED, SPEED - 1)
    np.testing.assert_array_equal(memory, [0, 0, 0, 1])


def seen_from(heading, distance=60.0):
    """A point at a distance, straight along x, as a robot at the origin sees it: ahead, aside."""
    return distance * math.cos(heading), -distance * math.sin(heading)


def turned(heading, motors):
    return heading + 0.02 * (motors[1] - motors[0]) / TURN


@given(st.floats(-math.pi, math.pi))
def test_approaching_turns_the_short_way_and_goes(heading):
    ahead, aside = seen_from(heading)
    within = math.degrees(abs(heading)) < math.degrees(math.atan(0.3))
    assert faces(ahead, aside) == within
    motors = approach(ahead, aside, SPEED, TURN)
    if within:
        assert motors == (SPEED, SPEED)
    elif abs(heading) < 3.1:
        assert motors in {LEFT_TURN, RIGHT_TURN}
        assert abs(turned(heading, motors)) < abs(heading)


@given(st.floats(-math.pi, math.pi))
def test_leaving_turns_away_until_the_point_lies_behind(heading):
    ahead, aside = seen_from(heading)
    assert has_left(ahead, aside) == (abs(heading) > 0.75 * math.pi)
    motors = leave(ahead, aside, SPEED, TURN)
    assert motors in {LEFT_TURN, RIGHT_TURN}
    if 0.05 < abs(heading) < 3.1:
        assert abs(turned(heading, motors)) > abs(heading)


@given(st.floats(-math.pi, math.pi))
def test_turning_to_and_from_a_point_comes_to_an_end(heading):
    steps = 0
    while not faces(*seen_from(heading)):
        heading = turned(heading, approach(*seen_from(heading), SPEED, TURN))
        steps += 1
    while not has_left(*seen_from(heading)):
        heading = turned(heading, leave(*seen_from(heading), SPEED, TURN))
        steps += 1
    assert steps < 4 * math.pi / 0.04

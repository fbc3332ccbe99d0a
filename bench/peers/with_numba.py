"""The loop of `with_numpy.py` compiled by Numba: every ray against every obstacle, nothing culled.

The code is what someone would write who has both at hand: scalars, fast maths, sine and cosine once
a step, the library's random numbers, kept on disk. A step costs what its rays cost.
"""

# ruff: noqa: NPY002 - compiled code draws from this generator the fastest
from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import work
from numba import njit

SENSORS = tuple(
    (x, y, math.cos(math.radians(degrees)), math.sin(math.radians(degrees)))
    for x, y, degrees in work.SENSORS
)
X, Y, HEADING, SIDE, CURVE, STEPS_LEFT, BLOCKED = range(7)


@njit(cache=True, fastmath=True)
def seed_random(seed):
    """Seed the generator that compiled code draws from."""
    np.random.seed(seed)


@njit(cache=True, fastmath=True)
def live(states, obstacles, steps):
    """Move robots [R, 7] on by so many steps, in place."""
    for n in range(len(states)):
        for _ in range(steps):
            step(states[n], obstacles)


@njit(cache=True, fastmath=True)
def step(state, obstacles):
    """Sense, decide and move one robot."""
    left = right = work.REACH
    sine, cosine = math.sin(state[HEADING]), math.cos(state[HEADING])
    for sensor in range(len(SENSORS)):
        distance = sense(state, sine, cosine, SENSORS[sensor], obstacles)
        if sensor in work.FRONT_LEFT:
            left = min(left, distance)
        if sensor in work.FRONT_RIGHT:
            right = min(right, distance)
    forward = 0.0
    if state[BLOCKED] != 0.0 or min(left, right) < work.ALARM:
        if state[SIDE] == 0.0:
            state[SIDE] = 1.0 if right < left else -1.0
        turn = state[SIDE] * work.TURN
    else:
        state[SIDE] = 0.0
        if state[STEPS_LEFT] <= 0.0:
            state[CURVE] = np.random.randint(-1, 2)
            state[STEPS_LEFT] = np.random.randint(1, work.CURVE_STEPS + 1)
        state[STEPS_LEFT] -= 1.0
        forward = work.SPEED
        turn = state[CURVE] * work.CURVE
    move(state, forward, turn, obstacles)


@njit(cache=True, fastmath=True)
def sense(state, sine, cosine, sensor, obstacles):
    """Return the distance (mm) a sensor sees, at most REACH, with noise."""
    x, y, ahead, aside = sensor
    from_x = state[X] + cosine * x - sine * y
    from_y = state[Y] + sine * x + cosine * y
    ahead_x = cosine * ahead - sine * aside
    ahead_y = sine * ahead + cosine * aside
    distance = min(work.REACH, to_wall(from_x, ahead_x), to_wall(from_y, ahead_y))
    for n in range(len(obstacles)):
        to_x = obstacles[n, 0] - from_x
        to_y = obstacles[n, 1] - from_y
        along = to_x * ahead_x + to_y * ahead_y
        inside = along * along - to_x * to_x - to_y * to_y + work.OBSTACLE_RADIUS**2
        if inside >= 0.0 and along > 0.0:
            distance = min(distance, along - math.sqrt(inside))
    return distance * (1.0 + work.SENSOR_NOISE * np.random.uniform(-1.0, 1.0))


@njit(cache=True, fastmath=True)
def to_wall(place, ahead):
    """Return how far along a ray the walls across one axis are, in mm."""
    if ahead > 0.0:
        return (work.SIDE - place) / max(ahead, 1e-12)
    return place / max(-ahead, 1e-12)


@njit(cache=True, fastmath=True)
def move(state, forward, turn, obstacles):
    """Move a robot unless something stops it."""
    turn *= 1.0 + work.TURN_NOISE * np.random.uniform(-1.0, 1.0)
    middle = state[HEADING] + turn / 2.0
    by_x = forward * (1.0 + work.POSITION_NOISE * np.random.uniform(-1.0, 1.0))
    by_y = forward * (1.0 + work.POSITION_NOISE * np.random.uniform(-1.0, 1.0))
    x = state[X] + by_x * math.cos(middle)
    y = state[Y] + by_y * math.sin(middle)
    state[HEADING] += turn
    blocked = min(x, y, work.SIDE - x, work.SIDE - y) < work.RADIUS
    for n in range(len(obstacles)):
        to_x = obstacles[n, 0] - x
        to_y = obstacles[n, 1] - y
        if to_x * to_x + to_y * to_y < (work.RADIUS + work.OBSTACLE_RADIUS) ** 2:
            blocked = True
    state[BLOCKED] = 1.0 if blocked else 0.0
    if not blocked:
        state[X] = x
        state[Y] = y


class Robots:
    """Robots [R], each alone in a world of the same obstacles."""

    def __init__(self, obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> None:
        seed_random(seed)
        self.obstacles = np.array(obstacles).reshape(-1, 2)
        self.states = np.zeros((robots, 7))
        self.states[:, :SIDE] = work.starts(robots, obstacles, seed)

    def step(self, steps: int) -> None:
        """Sense, decide and move, so many times."""
        live(self.states, self.obstacles, steps)

    def turning(self) -> float:
        """Return the share of robots that are turning away now."""
        return float((self.states[:, SIDE] != 0.0).mean())


def start(obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> Robots:
    """Return robots at their starts."""
    return Robots(obstacles, robots, seed)

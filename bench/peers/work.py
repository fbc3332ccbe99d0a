"""The work that every simulator does: a robot wanders among round obstacles in a walled square.

One robot to a world. It has the Khepera's size and eight proximity sensors. When a front sensor
sees something near, or the last step was blocked, it turns on the spot, always the same way until
the view is free; otherwise it goes ahead along slow random curves. These are the rule and the
figures of animat's own wandering, in mm, radians and steps. Needs nothing but Python, so that every
peer can read it.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

SIDE = 1000.0
"""mm, of the arena, from 0 to SIDE both ways, walls all round."""

RADIUS = 27.5
"""mm, of the robot."""

WHEEL_BASE = 50.0
"""mm between the wheels."""

OBSTACLE_RADIUS = 20.0
GAP = 80.0
"""mm between obstacles, and between them and the walls, so that the robot passes everywhere."""

SENSORS = (
    (9.5, 23.0, 90.0),
    (18.0, 17.5, 45.0),
    (24.5, 5.5, 0.0),
    (24.5, -5.5, 0.0),
    (18.0, -17.5, -45.0),
    (9.5, -23.0, -90.0),
    (-23.0, -9.5, 180.0),
    (-23.0, 9.5, 180.0),
)
"""Forward and left of the centre (mm), and where it looks (degrees, counter-clockwise)."""

FRONT_LEFT, FRONT_RIGHT = (1, 2), (3, 4)
"""The sensors that look ahead."""

EVEN = tuple(22.5 + 45.0 * n for n in range(8))
"""Directions (degrees) where a simulator casts evenly spaced rays from the robot's centre."""

EVEN_LEFT, EVEN_RIGHT = (0, 1), (7, 6)

REACH = 50.0
"""mm, of a sensor from where it sits; from the robot's centre RADIUS more."""

ALARM = 37.8
"""mm: what is nearer to a front sensor turns the robot away (a reading of 250 with `linear`)."""

SPEED = 2.5
"""mm a step."""

TURN = 0.1
"""rad a step, of turning away on the spot."""

CURVE = 0.02
"""rad a step, of a random curve: to the left, none, or to the right."""

CURVE_STEPS = 80
"""The longest curve, in steps."""

STEP_SECONDS = 0.0625
"""Simulated time, for simulators that want speeds in seconds."""

POSITION_NOISE, TURN_NOISE, SENSOR_NOISE = 0.10, 0.05, 0.01
"""Spreads, as shares: displacements along x and y, turns, distances."""


def obstacles(count: int, seed: int = 1) -> list[tuple[float, float]]:
    """Return the centres (mm) of so many obstacles; more of them are the same and others."""
    draw = random.Random(seed)
    margin = OBSTACLE_RADIUS + GAP
    placed: list[tuple[float, float]] = []
    while len(placed) < count:
        place = draw.uniform(margin, SIDE - margin), draw.uniform(margin, SIDE - margin)
        if all(math.dist(place, other) >= 2 * OBSTACLE_RADIUS + GAP for other in placed):
            placed.append(place)
    return placed


def starts(
    robots: int, placed: Sequence[tuple[float, float]], seed: int = 1
) -> list[tuple[float, float, float]]:
    """Return clear start poses (mm, mm, rad), one for each robot."""
    draw = random.Random(seed)
    margin = RADIUS + 20.0
    poses: list[tuple[float, float, float]] = []
    while len(poses) < robots:
        place = draw.uniform(margin, SIDE - margin), draw.uniform(margin, SIDE - margin)
        if all(math.dist(place, other) >= OBSTACLE_RADIUS + margin for other in placed):
            poses.append((*place, draw.uniform(-math.pi, math.pi)))
    return poses


class Wander:
    """Decides for one robot; simulators that move many robots at once say the same in arrays."""

    def __init__(self, seed: int) -> None:
        self.draw = random.Random(seed)
        self.side = 0  # turning left (1), right (-1) or not (0)
        self.curve = 0
        self.steps_left = 0

    def decide(self, left: float, right: float, blocked: bool) -> tuple[float, float]:
        """Return mm ahead and rad to turn in this step.

        `left` and `right` are the least distances (mm) that the front sensors on each side see.
        """
        if blocked or left < ALARM or right < ALARM:
            if self.side == 0:
                self.side = 1 if right < left else -1
            return 0.0, self.side * TURN
        self.side = 0
        if self.steps_left <= 0:
            self.curve = self.draw.randint(-1, 1)
            self.steps_left = self.draw.randint(1, CURVE_STEPS)
        self.steps_left -= 1
        return SPEED, self.curve * CURVE

"""The work in plain NumPy, as it would be written by hand: every ray against every obstacle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import work


class Robots:
    """Robots [R], each alone in a world of the same obstacles [N]."""

    def __init__(self, obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> None:
        self.draw = np.random.default_rng(seed)
        self.obstacles = np.array(obstacles).reshape(-1, 2)
        self.pose = np.array(work.starts(robots, obstacles, seed))
        x, y, degrees = np.array(work.SENSORS).T
        self.sensor_x, self.sensor_y, self.sensor_angle = x, y, np.radians(degrees)
        self.side, self.curve, self.steps_left = np.zeros((3, robots))
        self.blocked = np.zeros(robots, bool)

    def step(self, steps: int) -> None:
        """Sense, decide and move, so many times."""
        for _ in range(steps):
            distance = self.sense()
            forward, turn = self.decide(distance)
            self.move(forward, turn)

    def turning(self) -> float:
        """Return the share of robots that are turning away now."""
        return float((self.side != 0.0).mean())

    def sense(self) -> np.ndarray:
        """Return the distances [R, 8] (mm) that the sensors see, at most REACH, with noise."""
        x, y, heading = self.pose.T[:, :, None]
        sine, cosine = np.sin(heading), np.cos(heading)
        from_x = x + cosine * self.sensor_x - sine * self.sensor_y
        from_y = y + sine * self.sensor_x + cosine * self.sensor_y
        ahead_x = np.cos(heading + self.sensor_angle)
        ahead_y = np.sin(heading + self.sensor_angle)
        distance = np.minimum(to_wall(from_x, ahead_x), to_wall(from_y, ahead_y))
        if len(self.obstacles):
            to_x = self.obstacles[:, 0] - from_x[:, :, None]
            to_y = self.obstacles[:, 1] - from_y[:, :, None]
            along = to_x * ahead_x[:, :, None] + to_y * ahead_y[:, :, None]
            inside = along**2 - to_x**2 - to_y**2 + work.OBSTACLE_RADIUS**2
            hit = (inside >= 0.0) & (along > 0.0)
            to_obstacle = np.where(hit, along - np.sqrt(np.maximum(inside, 0.0)), np.inf)
            distance = np.minimum(distance, to_obstacle.min(axis=2))
        seen = np.minimum(distance, work.REACH)
        return seen * (1.0 + work.SENSOR_NOISE * self.draw.uniform(-1.0, 1.0, seen.shape))

    def decide(self, distance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return mm ahead and rad to turn [R]."""
        left = distance[:, work.FRONT_LEFT].min(axis=1)
        right = distance[:, work.FRONT_RIGHT].min(axis=1)
        alarm = self.blocked | (np.minimum(left, right) < work.ALARM)
        begins = np.where(right < left, 1.0, -1.0)
        self.side = np.where(alarm, np.where(self.side == 0.0, begins, self.side), 0.0)
        new = ~alarm & (self.steps_left <= 0.0)
        size = len(new)
        self.curve = np.where(new, self.draw.integers(-1, 2, size), self.curve)
        length = self.draw.integers(1, work.CURVE_STEPS + 1, size)
        self.steps_left = np.where(new, length, self.steps_left) - ~alarm
        forward = np.where(alarm, 0.0, work.SPEED)
        return forward, np.where(alarm, self.side * work.TURN, self.curve * work.CURVE)

    def move(self, forward: np.ndarray, turn: np.ndarray) -> None:
        """Move the robots [R] that nothing stops."""
        u_x, u_y, u_turn = self.draw.uniform(-1.0, 1.0, (3, len(turn)))
        turn = turn * (1.0 + work.TURN_NOISE * u_turn)
        x, y, heading = self.pose.T
        middle = heading + turn / 2.0
        x = x + forward * (1.0 + work.POSITION_NOISE * u_x) * np.cos(middle)
        y = y + forward * (1.0 + work.POSITION_NOISE * u_y) * np.sin(middle)
        inner = np.minimum.reduce([x, y, work.SIDE - x, work.SIDE - y]) >= work.RADIUS
        to_x = self.obstacles[:, 0] - x[:, None]
        to_y = self.obstacles[:, 1] - y[:, None]
        near = to_x**2 + to_y**2 < (work.RADIUS + work.OBSTACLE_RADIUS) ** 2
        self.blocked = ~inner | near.any(axis=1)
        free = ~self.blocked
        self.pose[free, 0] = x[free]
        self.pose[free, 1] = y[free]
        self.pose[:, 2] = heading + turn


def to_wall(place: np.ndarray, ahead: np.ndarray) -> np.ndarray:
    """Return how far along a ray the walls across one axis are, in mm."""
    room = np.where(ahead > 0.0, work.SIDE - place, place)
    return room / np.maximum(np.abs(ahead), 1e-12)


def start(obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> Robots:
    """Return robots at their starts."""
    return Robots(obstacles, robots, seed)

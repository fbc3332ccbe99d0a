"""The work in pymunk (Chipmunk): a disc driven by its velocity, a segment query to a sensor."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import pymunk
import work

THIN = 0.1
"""mm, half the thickness of walls and rays."""

SENSORS = [
    (x, y, math.cos(math.radians(degrees)), math.sin(math.radians(degrees)))
    for x, y, degrees in work.SENSORS
]


class Robot:
    """A robot in a space of its own."""

    def __init__(
        self,
        obstacles: Sequence[tuple[float, float]],
        pose: tuple[float, float, float],
        seed: int,
    ) -> None:
        self.space = pymunk.Space()
        still = self.space.static_body
        corners = [(0, 0), (work.SIDE, 0), (work.SIDE, work.SIDE), (0, work.SIDE), (0, 0)]
        for a, b in pairwise(corners):
            self.space.add(pymunk.Segment(still, a, b, THIN))
        for place in obstacles:
            self.space.add(pymunk.Circle(still, work.OBSTACLE_RADIUS, place))
        self.body = pymunk.Body(1.0, pymunk.moment_for_circle(1.0, 0.0, work.RADIUS))
        self.body.position = pose[:2]
        self.body.angle = pose[2]
        disc = pymunk.Circle(self.body, work.RADIUS)
        disc.filter = pymunk.ShapeFilter(group=1)
        self.space.add(self.body, disc)
        self.others = pymunk.ShapeFilter(group=1)
        self.wander = work.Wander(seed)

    def step(self) -> None:
        """Sense, decide and move."""
        distance = self.sense()
        left = min(distance[n] for n in work.FRONT_LEFT)
        right = min(distance[n] for n in work.FRONT_RIGHT)
        forward, turn = self.wander.decide(left, right, blocked=False)
        angle = self.body.angle + turn / 2.0
        self.body.velocity = forward * math.cos(angle), forward * math.sin(angle)
        self.body.angular_velocity = turn
        self.space.step(1.0)

    def sense(self) -> list[float]:
        """Return the distances (mm) that the sensors see, at most REACH."""
        body, query, others = self.body, self.space.segment_query_first, self.others
        x0, y0 = body.position
        cosine, sine = math.cos(body.angle), math.sin(body.angle)
        distances = []
        for x, y, ahead, aside in SENSORS:
            from_x, from_y = x0 + cosine * x - sine * y, y0 + sine * x + cosine * y
            to_x = from_x + work.REACH * (cosine * ahead - sine * aside)
            to_y = from_y + work.REACH * (sine * ahead + cosine * aside)
            hit = query((from_x, from_y), (to_x, to_y), THIN, others)
            distances.append(work.REACH * hit.alpha if hit else work.REACH)
        return distances


class Robots:
    """Robots, each in a space of its own, one after another."""

    def __init__(self, obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> None:
        poses = work.starts(robots, obstacles, seed)
        self.robots = [Robot(obstacles, pose, seed + n) for n, pose in enumerate(poses)]

    def step(self, steps: int) -> None:
        """Sense, decide and move, so many times."""
        for robot in self.robots:
            for _ in range(steps):
                robot.step()

    def turning(self) -> float:
        """Return the share of robots that are turning away now."""
        return sum(robot.wander.side != 0 for robot in self.robots) / len(self.robots)


def start(obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> Robots:
    """Return robots at their starts."""
    return Robots(obstacles, robots, seed)

"""The work in Mesa: agents in its continuous space, which knows points and who is near, no rays.

A sensor sees a neighbour whose bearing is within half the angle to the next sensor. Walls are
looked up by coordinates, as a modeller would.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import mesa
import numpy as np
import work
from mesa.experimental.continuous_space import ContinuousSpace, ContinuousSpaceAgent

FRONT = math.pi / 2.0
"""Half the angle that the front sensors see: everything before the axle."""

SIGHT = work.OBSTACLE_RADIUS + work.RADIUS + work.REACH
TOUCH = work.OBSTACLE_RADIUS + work.RADIUS


class Obstacle(ContinuousSpaceAgent):
    """Stands where it stands."""


class Robot(ContinuousSpaceAgent):
    """A robot that wanders."""

    def __init__(self, space: ContinuousSpace, model: mesa.Model, heading: float) -> None:
        super().__init__(space, model)
        self.heading = heading
        self.blocked = False
        self.wander = work.Wander(model.random.randrange(1 << 30))

    def step(self) -> None:
        """Sense, decide and move."""
        near, distances = self.get_neighbors_in_radius(SIGHT)
        left = right = work.REACH
        for agent, distance in zip(near, distances, strict=True):
            dx, dy = agent.position - self.position
            bearing = math.remainder(math.atan2(dy, dx) - self.heading, math.tau)
            left, right = seen(left, right, bearing, distance - TOUCH)
        for direction, distance in walls(*self.position):
            bearing = math.remainder(direction - self.heading, math.tau)
            left, right = seen(left, right, bearing, distance - work.RADIUS)
        forward, turn = self.wander.decide(left, right, self.blocked)
        draw = self.model.random.uniform
        turn *= 1.0 + draw(-work.TURN_NOISE, work.TURN_NOISE)
        middle = self.heading + turn / 2.0
        self.heading += turn
        by_x = forward * (1.0 + draw(-work.POSITION_NOISE, work.POSITION_NOISE))
        by_y = forward * (1.0 + draw(-work.POSITION_NOISE, work.POSITION_NOISE))
        place = self.position + np.array([by_x * math.cos(middle), by_y * math.sin(middle)])
        inside = place.min() >= work.RADIUS and place.max() <= work.SIDE - work.RADIUS
        self.blocked = not inside or any(math.dist(place, agent.position) < TOUCH for agent in near)
        if not self.blocked:
            self.position = place


def seen(left: float, right: float, bearing: float, distance: float) -> tuple[float, float]:
    """Return the least distances on the left and on the right with one more thing in view."""
    if abs(bearing) > FRONT:
        return left, right
    if bearing > 0.0:
        return min(left, distance), right
    return left, min(right, distance)


def walls(x: float, y: float) -> list[tuple[float, float]]:
    """Return the direction (rad) and the distance (mm) of every wall."""
    return [
        (0.0, work.SIDE - x),
        (math.pi / 2.0, work.SIDE - y),
        (math.pi, x),
        (-math.pi / 2.0, y),
    ]


class World(mesa.Model):
    """A robot in a space of its own."""

    def __init__(
        self, obstacles: Sequence[tuple[float, float]], pose: tuple[float, float, float], seed: int
    ) -> None:
        super().__init__(seed=seed)
        side = (0.0, work.SIDE)
        space = ContinuousSpace([side, side], random=self.random, n_agents=len(obstacles) + 1)
        for place in obstacles:
            Obstacle(space, self).position = np.array(place)
        self.robot = Robot(space, self, pose[2])
        self.robot.position = np.array(pose[:2])

    def step(self) -> None:
        """Let the robot step."""
        self.robot.step()


class Robots:
    """Robots, each in a model of its own, one after another."""

    def __init__(self, obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> None:
        poses = work.starts(robots, obstacles, seed)
        self.worlds = [World(obstacles, pose, seed + n) for n, pose in enumerate(poses)]

    def step(self, steps: int) -> None:
        """Sense, decide and move, so many times."""
        for world in self.worlds:
            for _ in range(steps):
                world.step()

    def turning(self) -> float:
        """Return the share of robots that are turning away now."""
        return sum(world.robot.wander.side != 0 for world in self.worlds) / len(self.worlds)


def start(obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> Robots:
    """Return robots at their starts."""
    return Robots(obstacles, robots, seed)

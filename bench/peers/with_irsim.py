"""The work in ir-sim: a differential robot with a LiDAR of eight beams, one environment a robot."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

os.environ.setdefault("MPLBACKEND", "Agg")

import irsim
import work
import yaml

M = 0.001  # mm


def world(obstacles: Sequence[tuple[float, float]], pose: tuple[float, float, float]) -> dict:
    """Return the world as ir-sim reads it from YAML, in metres and seconds."""
    side = work.SIDE * M
    corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side), (0.0, 0.0)]
    sides = pairwise(corners)
    walls = [
        {
            "shape": {"name": "linestring", "vertices": [list(a), list(b)]},
            "state": [0.0, 0.0, 0.0],
        }
        for a, b in sides
    ]
    discs = [
        {
            "shape": {"name": "circle", "radius": work.OBSTACLE_RADIUS * M},
            "state": [x * M, y * M, 0.0],
        }
        for x, y in obstacles
    ]
    lidar = {
        "name": "lidar2d",
        "range_max": (work.RADIUS + work.REACH) * M,
        "angle_range": math.radians(work.EVEN[-1] - work.EVEN[0]),
        "number": len(work.EVEN),
        "noise": True,
        "std": work.SENSOR_NOISE * work.REACH * M,
    }
    robot = {
        "kinematics": {"name": "diff", "noise": True, "alpha": [0.003, 0.0, 0.0, 0.001]},
        "shape": {"name": "circle", "radius": work.RADIUS * M},
        "state": [pose[0] * M, pose[1] * M, pose[2]],
        "vel_min": [-1.0, -10.0],
        "vel_max": [1.0, 10.0],
        "sensors": [lidar],
    }
    return {
        "world": {
            "width": side,
            "height": side,
            "step_time": work.STEP_SECONDS,
            "collision_mode": "stop",
        },
        "robot": [robot],
        "obstacle": [*walls, *discs],
    }


class Robot:
    """A robot in an environment of its own."""

    def __init__(
        self, obstacles: Sequence[tuple[float, float]], pose: tuple[float, float, float], seed: int
    ) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "world.yaml"
            file.write_text(yaml.safe_dump(world(obstacles, pose)), encoding="utf-8")
            self.env = irsim.make(str(file), headless=True, seed=seed, log_level="ERROR")
        self.wander = work.Wander(seed)

    def step(self) -> None:
        """Sense, decide and move."""
        ranges = self.env.get_lidar_scan()["ranges"] / M - work.RADIUS
        # Beams go from the back right to the back left: 2 and 3 look ahead to the right.
        right = min(ranges[2], ranges[3])
        left = min(ranges[4], ranges[5])
        forward, turn = self.wander.decide(left, right, blocked=False)
        self.env.step([forward * M / work.STEP_SECONDS, turn / work.STEP_SECONDS])


class Robots:
    """Robots, each in an environment of its own, one after another."""

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

"""The work in VMAS: a scenario with a LiDAR of eight rays, many environments at once under PyTorch.

The robot is a sphere with differential drive, obstacles are spheres and walls lines. LiDAR starts
in the robot's centre.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import torch
import vmas
import work
from vmas.simulator.core import Agent, Landmark, Line, Sphere, World
from vmas.simulator.dynamics.diff_drive import DiffDrive
from vmas.simulator.scenario import BaseScenario
from vmas.simulator.sensors import Lidar

M = 0.001  # mm
EVEN = work.EVEN[0], work.EVEN[0] + 360.0


class Scenario(BaseScenario):
    """A walled square metre with obstacles and one robot."""

    def make_world(self, batch_dim, device, obstacles, poses):
        """Return the world, its robot and everything in it."""
        self.obstacles = obstacles
        self.poses = poses
        world = World(batch_dim, device, dt=work.STEP_SECONDS, drag=0.0)
        robot = Agent(
            "robot",
            shape=Sphere(work.RADIUS * M),
            dynamics=DiffDrive(world, integration="euler"),
            u_range=(1.0, 10.0),
            sensors=[
                Lidar(
                    world,
                    angle_start=math.radians(EVEN[0]),
                    angle_end=math.radians(EVEN[1]),
                    n_rays=len(work.EVEN),
                    max_range=(work.RADIUS + work.REACH) * M,
                    entity_filter=lambda entity: isinstance(entity, Landmark),
                    render=False,
                )
            ],
        )
        world.add_agent(robot)
        for n in range(len(obstacles)):
            shape = Sphere(work.OBSTACLE_RADIUS * M)
            world.add_landmark(Landmark(f"obstacle {n}", shape=shape, collide=True))
        for n in range(4):
            shape = Line(work.SIDE * M)
            world.add_landmark(Landmark(f"wall {n}", shape=shape, collide=True))
        return world

    def reset_world_at(self, env_index=None):
        """Put everything in its place."""
        robot = self.world.agents[0]
        robot.set_pos(self.poses[:, :2], env_index)
        robot.set_rot(self.poses[:, 2:], env_index)
        half = work.SIDE * M / 2.0
        sides = [
            (half, 0.0, 0.0),
            (2 * half, half, math.pi / 2.0),
            (half, 2 * half, 0.0),
            (0.0, half, math.pi / 2.0),
        ]
        places = [(x * M, y * M, 0.0) for x, y in self.obstacles] + sides
        for landmark, (x, y, angle) in zip(self.world.landmarks, places, strict=True):
            landmark.set_pos(torch.tensor([x, y]), env_index)
            landmark.set_rot(torch.tensor([angle]), env_index)

    def observation(self, agent):
        """Return what the LiDAR sees."""
        return agent.sensors[0].measure()

    def reward(self, agent):
        """Return none."""
        return torch.zeros(self.world.batch_dim)


class Robots:
    """Robots [R], each in an environment of its own."""

    def __init__(self, obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> None:
        torch.set_num_threads(1)
        poses = torch.tensor(work.starts(robots, obstacles, seed)) * torch.tensor([M, M, 1.0])
        self.env = vmas.make_env(
            Scenario(), num_envs=robots, seed=seed, obstacles=obstacles, poses=poses
        )
        self.seen = self.env.reset()[0]
        self.side, self.curve, self.steps_left = torch.zeros(3, robots)

    @torch.no_grad()
    def step(self, steps: int) -> None:
        """Sense, decide and move, so many times."""
        for _ in range(steps):
            (self.seen,), _, _, _ = self.env.step([self.decide()])

    def turning(self) -> float:
        """Return the share of robots that are turning away now."""
        return float((self.side != 0.0).float().mean())

    def decide(self) -> torch.Tensor:
        """Return the speeds [R, 2] ahead and of turning, in metres and radians a second."""
        seen = self.seen / M - work.RADIUS
        seen = seen * (1.0 + work.SENSOR_NOISE * (2.0 * torch.rand_like(seen) - 1.0))
        left = seen[:, work.EVEN_LEFT].amin(dim=1)
        right = seen[:, work.EVEN_RIGHT].amin(dim=1)
        alarm = torch.minimum(left, right) < work.ALARM
        begins = torch.where(right < left, 1.0, -1.0)
        self.side = torch.where(alarm, torch.where(self.side == 0.0, begins, self.side), 0.0)
        new = ~alarm & (self.steps_left <= 0.0)
        curve = torch.randint(-1, 2, new.shape).float()
        length = torch.randint(1, work.CURVE_STEPS + 1, new.shape).float()
        self.curve = torch.where(new, curve, self.curve)
        self.steps_left = torch.where(new, length, self.steps_left) - (~alarm).float()
        forward = torch.where(alarm, 0.0, work.SPEED * M)
        turn = torch.where(alarm, self.side * work.TURN, self.curve * work.CURVE)
        forward = forward * (1.0 + work.POSITION_NOISE * (2.0 * torch.rand_like(forward) - 1.0))
        turn = turn * (1.0 + work.TURN_NOISE * (2.0 * torch.rand_like(turn) - 1.0))
        return torch.stack([forward, turn], dim=1) / work.STEP_SECONDS


def start(obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> Robots:
    """Return robots at their starts."""
    return Robots(obstacles, robots, seed)

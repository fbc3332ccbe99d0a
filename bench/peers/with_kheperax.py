"""The work in kheperax: its robot, lasers and maze of segments, many robots at once under JAX.

The task that its users step is taken as it is; lasers start in the robot's centre, and an obstacle
is a square of four segments.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import jax
import jax.numpy as jnp
import work
from kheperax.simu.geoms import Pos, Segment
from kheperax.simu.maze import Maze
from kheperax.simu.posture import Posture
from kheperax.simu.robot import Robot
from kheperax.tasks.config import KheperaxConfig
from kheperax.tasks.main import KheperaxTask

# kheperax 0.2.0 calls a function that JAX has moved since.
jax.tree_leaves = jax.tree_util.tree_leaves

M = 0.001  # mm
HALF = work.OBSTACLE_RADIUS * M
LEFT = jnp.array(work.FRONT_LEFT)
RIGHT = jnp.array(work.FRONT_RIGHT)


def maze(obstacles: Sequence[tuple[float, float]]) -> Maze:
    """Return the walled square metre with these obstacles."""
    border = Maze.make_border_walls()
    corners = [(-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF)]
    ends = [
        (x * M + a[0], y * M + a[1], x * M + b[0], y * M + b[1])
        for x, y in obstacles
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    ]
    x1, y1, x2, y2 = jnp.array(ends, dtype=jnp.float32).reshape(-1, 4).T
    return Maze(inside_walls=Segment(Pos(x1, y1), Pos(x2, y2)), border_walls=border)


class Robots:
    """Robots [R] in copies of one maze."""

    def __init__(self, obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> None:
        config = KheperaxConfig.get_default()
        config.maze = maze(obstacles)
        config.action_scale = (work.SPEED + work.TURN * work.RADIUS) * M
        config.std_noise_wheel_velocities = work.POSITION_NOISE / 2.0 * work.SPEED * M
        robot = Robot(
            posture=Posture(0.0, 0.0, 0.0),
            radius=work.RADIUS * M,
            laser_ranges=(work.RADIUS + work.REACH) * M,
            laser_angles=jnp.radians(jnp.array([degrees for _, _, degrees in work.SENSORS])),
            std_noise_sensor_measures=work.SENSOR_NOISE * work.REACH * M,
        )
        config.robot = robot
        self.task = KheperaxTask(config)
        poses = jnp.array(work.starts(robots, obstacles, seed)) * jnp.array([M, M, 1.0])

        def born(pose, key):
            state = self.task.reset(key)
            placed = state.robot.replace(posture=Posture(*pose))
            # The reward as a step returns it: another type would compile the step once more.
            return state.replace(robot=placed, reward=jnp.float32(0.0))

        keys = jax.random.split(jax.random.PRNGKey(seed), robots)
        self.states = jax.jit(jax.vmap(born))(poses, keys)
        # side of turning, curve, steps left of it
        self.memory = jnp.zeros((robots, 3))
        self.go = jax.jit(partial(many_steps, self.task))

    def step(self, steps: int) -> None:
        """Sense, decide and move, so many times."""
        self.states, self.memory = self.go(self.states, self.memory, steps)
        self.memory.block_until_ready()

    def turning(self) -> float:
        """Return the share of robots that are turning away now."""
        return float((self.memory[:, 0] != 0.0).mean())


def many_steps(task, states, memory, steps):
    """Move robots [R] on by so many steps."""

    def one(state, memory):
        action, memory = decide(state, memory, task.kheperax_config.action_scale)
        return task.step(state, action), memory

    def body(_, carried):
        return jax.vmap(one)(*carried)

    return jax.lax.fori_loop(0, steps, body, (states, memory))


def decide(state, memory, scale):
    """Return the action of one robot, the speeds of its wheels as shares of the greatest."""
    seen = state.obs[: len(work.SENSORS)] / M - work.RADIUS
    left, right = seen[LEFT].min(), seen[RIGHT].min()
    side, curve, steps_left = memory
    alarm = jnp.minimum(left, right) < work.ALARM
    begins = jnp.where(right < left, 1.0, -1.0)
    side = jnp.where(alarm, jnp.where(side == 0.0, begins, side), 0.0)
    key_curve, key_length = jax.random.split(state.random_key)
    new = ~alarm & (steps_left <= 0.0)
    curve = jnp.where(new, jax.random.randint(key_curve, (), -1, 2), curve)
    length = jax.random.randint(key_length, (), 1, work.CURVE_STEPS + 1)
    steps_left = jnp.where(new, length, steps_left) - ~alarm
    forward = jnp.where(alarm, 0.0, work.SPEED)
    turn = jnp.where(alarm, side * work.TURN, curve * work.CURVE) * work.RADIUS
    wheels = jnp.array([forward - turn, forward + turn]) * M / scale
    return wheels, jnp.array([side, curve, steps_left])


def start(obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> Robots:
    """Return robots at their starts."""
    return Robots(obstacles, robots, seed)

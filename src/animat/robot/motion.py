"""How the wheels move the robot in one step, and the noise in it."""

from __future__ import annotations

import math

import numpy as np

from animat.numerics.compiled import compiled
from animat.numerics.elementary import sine_cosine

TURN = 2.0 * math.pi


@compiled
def move(
    x: float,
    y: float,
    heading: float,
    left: int,
    right: int,
    robot: np.record,
    u_x: float,
    u_y: float,
    u_turn: float,
) -> tuple[float, float, float]:
    """Return the pose (mm, mm, rad) that one step of the motors leads to in free space.

    Half the turn, the translation, the other half of the turn, as in Michel's simulator. `left`
    and `right` are motor commands, held to +-`max_motor`. The uniforms in [0, 1) are the noise:
    the displacements along x and y are each multiplied by U[1 - position_noise,
    1 + position_noise), the turn by U[1 - turn_noise, 1 + turn_noise); without `motor_noise` by
    nothing. `heading` is within (-pi, pi], before and after.
    """
    left = min(max(left, -robot.max_motor), robot.max_motor)
    right = min(max(right, -robot.max_motor), robot.max_motor)
    turn = robot.step_mm * (right - left) / robot.wheel_base
    forward = robot.step_mm * (left + right) / 2.0
    forward_x = forward_y = forward
    if robot.motor_noise:
        turn *= 1.0 + robot.turn_noise * (2.0 * u_turn - 1.0)
        forward_x *= 1.0 + robot.position_noise * (2.0 * u_x - 1.0)
        forward_y *= 1.0 + robot.position_noise * (2.0 * u_y - 1.0)
    sine, cosine = sine_cosine(heading + turn / 2.0)
    return x + forward_x * cosine, y + forward_y * sine, principal(heading + turn)


@compiled
def principal(angle: float) -> float:
    """Return an angle (rad) within (-3 pi, 3 pi] as the same angle within (-pi, pi]."""
    if angle > math.pi:
        return angle - TURN
    if angle <= -math.pi:
        return angle + TURN
    return angle

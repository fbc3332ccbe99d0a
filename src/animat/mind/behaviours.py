"""Behaviours as motor commands: wander, approach, act, leave.

The paper says of the search only that it is random. Wandering here goes ahead along slow random
curves and turns on the spot, always the same way until the view is free, when something stands
before it. A corner that the rays of `linear` miss can come to stand between two points of the
collision ring, where no turn gets free of it; so turning in vain is broken off by going straight.

A wander controller has the signature `wander(readings, aheads, sides, memory, u_a, u_b,
speed, turn) -> (left, right)`: `readings` [N] of the proximity sensors, 0..1023; `aheads` [N], the
cosines of their directions (1 looks ahead); `sides` [N], how far to the left they sit, in mm;
`memory` [4], the controller's own, zero at birth; two uniforms in [0, 1); the speeds of the mind
in motor units. It returns the two motor commands.
"""

from __future__ import annotations

from typing import Any

from animat.numerics.compiled import compiled

WANDER, APPROACH, ACT, LEAVE = range(4)
"""What the robot is doing; ACT stands for the behaviour that was chosen."""

CURVED_WANDER, CUSTOM_WANDER = range(2)

WANDERERS: dict[Any, int] = {"curved": CURVED_WANDER}
"""The code of each built-in wander controller, by its name."""

ALARM = 250
"""A reading above this turns the robot away; about 40 mm from a wall with `michel1996`."""

CURVE_STEPS = 40
"""How long a curve lasts on average, in steps; 100 mm at cruising speed."""

TURN_STEPS, RETREAT_STEPS, AROUND_STEPS = 45, 10, 20
"""After turning in vain for so long, 3/4 round at the default speed, it goes straight back (or
ahead, if more stands behind it) for the second number of steps, and then turns for the third,
whatever it sees."""


@compiled
def curved_wander(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    """Go ahead along slow random curves; turn away from what comes near.

    `memory` holds the side it is turning to (+1 left, -1 right, 0 not turning), the present
    curve in motor units, the steps left of it, and how long it has been turning.
    """
    left_alarm = 0.0
    right_alarm = 0.0
    for n in range(len(readings)):
        if readings[n] > ALARM and aheads[n] > 0.5:
            if sides[n] > 0.0:
                left_alarm += readings[n]
            else:
                right_alarm += readings[n]
    if memory[3] >= TURN_STEPS + RETREAT_STEPS + AROUND_STEPS:
        memory[3] = 0.0
    if left_alarm + right_alarm > 0.0 or memory[3] >= TURN_STEPS:
        if memory[0] == 0.0:
            memory[0] = 1.0 if right_alarm > left_alarm else -1.0
        memory[3] += 1.0
        if TURN_STEPS < memory[3] <= TURN_STEPS + RETREAT_STEPS:
            retreat = speed if behind(readings, aheads) > left_alarm + right_alarm else -speed
            return 1.0 * retreat, 1.0 * retreat
        return -turn * memory[0], turn * memory[0]
    memory[0] = 0.0
    memory[3] = 0.0
    if memory[2] <= 0.0:
        memory[1] = int(u_a * 3.0) - 1.0
        memory[2] = 1.0 + int(u_b * 2.0 * CURVE_STEPS)
    memory[2] -= 1.0
    return speed - memory[1], speed + memory[1]


@compiled
def behind(readings, aheads):
    """Return the sum of what the sensors read that look back."""
    total = 0.0
    for n in range(len(readings)):
        if aheads[n] < -0.5:
            total += readings[n]
    return total


@compiled
def ignores_the_dark(controller):
    """Tell whether a controller does the same whatever sensors read that see nothing."""
    return controller == CURVED_WANDER


@compiled
def needs_numbers(controller, memory):
    """Tell whether a controller needs random numbers this step: a tenth of a step to draw."""
    return controller != CURVED_WANDER or memory[2] <= 0.0


@compiled
def wander(controller, readings, aheads, sides, memory, u_a, u_b, speed, turn, custom):
    """Wander by the controller of the given code; `custom` is the user's own function."""
    if controller == CURVED_WANDER:
        return curved_wander(readings, aheads, sides, memory, u_a, u_b, speed, turn)
    return custom(readings, aheads, sides, memory, u_a, u_b, speed, turn)


@compiled
def faces(ahead, aside):
    """Tell whether a point `ahead` and `aside` (left positive, mm) lies within 17 degrees."""
    return ahead > 0.0 and abs(aside) < 0.3 * ahead


@compiled
def approach(ahead, aside, speed, turn):
    """Return the motor commands that turn to a point and go to it."""
    if faces(ahead, aside):
        return speed, speed
    if aside > 0.0:
        return -turn, turn
    return turn, -turn


@compiled
def leave(ahead, aside, speed, turn):
    """Return the motor commands that turn the back on a point."""
    if aside > 0.0:
        return turn, -turn
    return -turn, turn


@compiled
def has_left(ahead, aside):
    """Tell whether a point lies behind, so that going ahead leads away from it."""
    return ahead < -abs(aside)

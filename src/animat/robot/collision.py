"""What happens when a step would take the robot into a wall or an object.

Eight points stand on a ring round the centre, from the front counter-clockwise (0 front, 2 left,
4 back, 6 right). The rule is Michel's (Khepera Simulator 2.0): a hit at the front or the back
undoes the step; a hit at the side undoes the translation, pushes the robot 1 mm per axis away from
the hit, and keeps the new heading.

Taken alone that rule can drive the robot, push by push, into what stands on its other side, until
no command gets it out again. So a push never ends in another hit: where the pushed robot with its
new heading would touch something, the turn waits (pushed, the old heading); where even that would,
so does the push (the old place, the new heading); and if nothing else is left the step is undone.
A robot that starts clear is therefore clear after every step.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from animat.numerics.compiled import compiled
from animat.numerics.elementary import sine_cosine
from animat.robot.probe import occupied, room
from animat.world.raster import Raster

FRONT, BACK, CLEAR = 0, 4, -1
ORDER = (FRONT, BACK, 1, 2, 3, 5, 6, 7)
PUSH = 1.0
ON_AXIS = 1e-6


@compiled
def collide(
    old_x: float,
    old_y: float,
    old_heading: float,
    x: float,
    y: float,
    heading: float,
    robot: np.record,
    raster: Raster,
    present: NDArray[np.uint8],
) -> tuple[float, float, float, bool]:
    """Return the pose (mm, mm, rad) a step ends in, and whether something stopped it.

    `old_*` is the pose before the step, the other the one its motion leads to. `present[S]` tells
    which sites hold their object; only those and walls stop the robot.
    """
    hit = touched(x, y, heading, robot, raster, present)
    if hit == CLEAR:
        return x, y, heading, False
    if hit not in (FRONT, BACK):
        sine, cosine = sine_cosine(heading)
        ring_x, ring_y = robot.ring_x[hit], robot.ring_y[hit]
        pushed_x = old_x + _push(cosine * ring_x - sine * ring_y)
        pushed_y = old_y + _push(sine * ring_x + cosine * ring_y)
        if touched(pushed_x, pushed_y, heading, robot, raster, present) == CLEAR:
            return pushed_x, pushed_y, heading, True
        if touched(pushed_x, pushed_y, old_heading, robot, raster, present) == CLEAR:
            return pushed_x, pushed_y, old_heading, True
        if touched(old_x, old_y, heading, robot, raster, present) == CLEAR:
            return old_x, old_y, heading, True
    return old_x, old_y, old_heading, True


@compiled
def touched(
    x: float,
    y: float,
    heading: float,
    robot: np.record,
    raster: Raster,
    present: NDArray[np.uint8],
) -> int:
    """Return the number of the ring point that is hit in this pose, or CLEAR.

    Of several the front counts first, then the back, then the others in their order.
    """
    u = x * raster.cells_per_mm + raster.border
    v = y * raster.cells_per_mm + raster.border
    if room(u, v, raster) > robot.ring_radius:
        return CLEAR
    sine, cosine = sine_cosine(heading)
    for point in ORDER:
        ring_x = robot.ring_x[point] * raster.cells_per_mm
        ring_y = robot.ring_y[point] * raster.cells_per_mm
        ring_u = u + (cosine * ring_x - sine * ring_y)
        ring_v = v + (sine * ring_x + cosine * ring_y)
        if occupied(ring_u, ring_v, raster.solid, present):
            return point
    return CLEAR


@compiled
def _push(offset: float) -> float:
    """Return the push (mm) along an axis on which the hit point lies `offset` mm away."""
    if offset > ON_AXIS:
        return -PUSH
    if offset < -ON_AXIS:
        return PUSH
    return 0.0

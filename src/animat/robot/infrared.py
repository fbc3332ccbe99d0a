"""What infrared sensors read, however many a body has.

`michel1996` (Michel's Khepera Simulator 2.0) looks at three columns of five points before each
sensor; `linear` (as in Webots) sends one ray. Both read whole numbers 0..1023, and cut off what is
behind the point, as an assignment to an integer does.

Most points need no look at all. The room under the robot's centre says whether there is anything
to see at all; the room before a sensor, whether it sees any of it; the room under a sensor, which
of its probes are free. All skip only what is free for certain: what is read is the same with and
without them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from animat.numerics.compiled import compiled
from animat.numerics.elementary import sine_cosine
from animat.robot.parameters import LINEAR_REACH, MICHEL1996
from animat.robot.probe import occupied, room
from animat.world.raster import Raster

BRIGHTEST = 1023
DIMMEST_SEEN = 7
SPREAD = 0.10
LINEAR_SPREAD = 0.01

TWO_BY_WORD = 2.0 / 65536.0
DARK_READINGS = 7
HALF_WORD = np.uint64(16)
HALF_WORD_MASK = np.uint64(0xFFFF)

# The circle before a sensor that holds all its probes, in mm.
PROBES_CENTRE, PROBES_RADIUS = 31.0, 27.3

# Past the border of a cell by so much (in cells), a ray is in the next one whatever the rounding.
NUDGE = 1e-9

NOISES = 8
"""How many sensors a block of random words has noise for."""

Words = tuple[np.uint64, np.uint64, np.uint64, np.uint64]


@compiled
def read_infrared(
    x: float,
    y: float,
    heading: float,
    robot: np.record,
    raster: Raster,
    present: NDArray[np.uint8],
    words: Words,
    readings: NDArray[np.int64],
    first: int,
) -> None:
    """Write what eight sensors from `first` on read in a pose (mm, mm, rad) to `readings` [N].

    `present[S]` tells which sites hold their object. `words` are four random words of 32 bits, a
    block of the stream SENSORS, and all the noise of these sensors in a step (see `sensor_noise`).
    """
    last = min(first + NOISES, len(readings))
    u = x * raster.cells_per_mm + raster.border
    v = y * raster.cells_per_mm + raster.border
    free = room(u, v, raster) - robot.sensor_radius
    if robot.infrared == MICHEL1996:
        _read_michel1996(u, v, heading, free, robot, raster, present, words, readings, first, last)
    else:
        _read_linear(u, v, heading, free, robot, raster, present, words, readings, first, last)


@compiled
def is_dark(x: float, y: float, robot: np.record, raster: Raster) -> bool:
    """Tell whether there is nothing for any sensor to see of a robot at (x, y) mm, for certain."""
    u = x * raster.cells_per_mm + raster.border
    v = y * raster.cells_per_mm + raster.border
    return room(u, v, raster) > robot.sensor_radius + robot.reach


@compiled
def sensor_noise(words: Words, sensor: int) -> np.int64:
    """Return the noise of a sensor, 16 random bits.

    Sensors 2 n and 2 n + 1 take the low and the high half of word n.
    """
    # Chosen by hand: to index a tuple is to raise an exception where the index is too large.
    word = words[0]
    if sensor >= 6:
        word = words[3]
    elif sensor >= 4:
        word = words[2]
    elif sensor >= 2:
        word = words[1]
    return np.int64((np.uint64(word) >> (HALF_WORD * np.uint64(sensor & 1))) & HALF_WORD_MASK)


@compiled
def centred(noise: int | np.int64) -> float:
    """Return 16 random bits as a number in [-1, 1)."""
    return float(noise) * TWO_BY_WORD - 1.0


@compiled
def _read_michel1996(
    u: float,
    v: float,
    heading: float,
    free: float,
    robot: np.record,
    raster: Raster,
    present: NDArray[np.uint8],
    words: Words,
    readings: NDArray[np.int64],
    first: int,
    last: int,
) -> None:
    """Read sensors of a robot at (u, v), in cells; within `free` mm of each all is free."""
    if free > robot.reach:
        for sensor in range(first, last):
            readings[sensor] = unlit(sensor_noise(words, sensor - first), robot)
        return
    sine, cosine = sine_cosine(heading)
    cosine *= raster.cells_per_mm  # from here on 1 mm is measured in cells
    sine *= raster.cells_per_mm
    for sensor in range(first, last):
        x, y = robot.sensor_x[sensor], robot.sensor_y[sensor]
        ahead_x, ahead_y = robot.sensor_cosine[sensor], robot.sensor_sine[sensor]
        noise = sensor_noise(words, sensor - first)
        mid_x, mid_y = x + PROBES_CENTRE * ahead_x, y + PROBES_CENTRE * ahead_y
        mid_u = u + (cosine * mid_x - sine * mid_y)
        mid_v = v + (sine * mid_x + cosine * mid_y)
        if room(mid_u, mid_v, raster) > PROBES_RADIUS:
            readings[sensor] = unlit(noise, robot)
            continue
        sensor_u = u + (cosine * x - sine * y)
        sensor_v = v + (sine * x + cosine * y)
        light = light_of_probes(
            sensor_u,
            sensor_v,
            cosine * ahead_x - sine * ahead_y,
            sine * ahead_x + cosine * ahead_y,
            room(sensor_u, sensor_v, raster),
            raster.solid,
            present,
        )
        readings[sensor] = michel1996(light, noise, robot)


@compiled
def light_of_probes(
    u: float,
    v: float,
    ahead_u: float,
    ahead_v: float,
    free: float,
    solid: NDArray[np.int16],
    present: NDArray[np.uint8],
) -> int:
    """Return the sum of the three columns of probes before a sensor at (u, v), in cells.

    (ahead_u, ahead_v) is 1 mm in the sensor's direction, in cells. Probes nearer to the sensor than
    `free` mm need no look.
    """
    return (
        _centre_column(u, v, ahead_u, ahead_v, free, solid, present)
        + _side_column(u, v, ahead_u, ahead_v, -ahead_v, ahead_u, free, solid, present)
        + _side_column(u, v, ahead_u, ahead_v, ahead_v, -ahead_u, free, solid, present)
    )


@compiled
def _centre_column(
    u: float,
    v: float,
    a_u: float,
    a_v: float,
    free: float,
    solid: NDArray[np.int16],
    present: NDArray[np.uint8],
) -> int:
    """Return the value of the first occupied probe straight ahead, 0 if there is none."""
    if free < 12.0 and occupied(u + 12.0 * a_u, v + 12.0 * a_v, solid, present):
        return 900
    if free < 20.0 and occupied(u + 20.0 * a_u, v + 20.0 * a_v, solid, present):
        return 750
    if free < 32.0 and occupied(u + 32.0 * a_u, v + 32.0 * a_v, solid, present):
        return 650
    if free < 44.0 and occupied(u + 44.0 * a_u, v + 44.0 * a_v, solid, present):
        return 160
    if occupied(u + 58.0 * a_u, v + 58.0 * a_v, solid, present):
        return 40
    return 0


@compiled
def _side_column(
    u: float,
    v: float,
    a_u: float,
    a_v: float,
    s_u: float,
    s_v: float,
    free: float,
    solid: NDArray[np.int16],
    present: NDArray[np.uint8],
) -> int:
    """Return the same for the column on the side towards (s_u, s_v), 1 mm in cells.

    A probe is farther from the sensor than it is ahead of it: `free` is compared with its distance,
    rounded up.
    """
    if free < 5.7 and occupied(
        u + 4.0 * a_u + 4.0 * s_u, v + 4.0 * a_v + 4.0 * s_v, solid, present
    ):
        return 1023
    if free < 11.4 and occupied(
        u + 8.0 * a_u + 8.0 * s_u, v + 8.0 * a_v + 8.0 * s_v, solid, present
    ):
        return 800
    if free < 18.9 and occupied(
        u + 16.0 * a_u + 10.0 * s_u, v + 16.0 * a_v + 10.0 * s_v, solid, present
    ):
        return 600
    if free < 29.6 and occupied(
        u + 26.0 * a_u + 14.0 * s_u, v + 26.0 * a_v + 14.0 * s_v, solid, present
    ):
        return 400
    if free < 43.9 and occupied(
        u + 40.0 * a_u + 18.0 * s_u, v + 40.0 * a_v + 18.0 * s_v, solid, present
    ):
        return 60
    return 0


@compiled
def michel1996(light: int, noise: int | np.int64, robot: np.record) -> int | np.int64:
    """Return the reading for a sum of probe values.

    Under 7 a uniform integer 0..6 (0 without noise), over 1022 always 1023, else the sum times
    U[0.90, 1.10), at most 1023. Sixteen bits make each of the seven integers as probable as the
    others to within 1 / 9000 of it, and the factor a multiple of 0.2 / 65536.
    """
    if light < DIMMEST_SEEN:
        return unlit(noise, robot)
    if light >= BRIGHTEST:
        return BRIGHTEST
    if not robot.infrared_noise:
        return light
    return min(int(light * (1.0 + SPREAD * centred(noise))), BRIGHTEST)


@compiled
def unlit(noise: int | np.int64, robot: np.record) -> int | np.int64:
    """Return what a sensor of michel1996 reads when it sees nothing."""
    if robot.infrared_noise:
        return (noise * DARK_READINGS) >> 16
    return 0


@compiled
def _read_linear(
    u: float,
    v: float,
    heading: float,
    free: float,
    robot: np.record,
    raster: Raster,
    present: NDArray[np.uint8],
    words: Words,
    readings: NDArray[np.int64],
    first: int,
    last: int,
) -> None:
    """Read sensors of a robot at (u, v), in cells; within `free` mm of each all is free."""
    if free > robot.reach:
        for sensor in range(first, last):
            readings[sensor] = 0
        return
    sine, cosine = sine_cosine(heading)
    cosine *= raster.cells_per_mm
    sine *= raster.cells_per_mm
    for sensor in range(first, last):
        x, y = robot.sensor_x[sensor], robot.sensor_y[sensor]
        ahead_x, ahead_y = robot.sensor_cosine[sensor], robot.sensor_sine[sensor]
        distance = free_way(
            u + (cosine * x - sine * y),
            v + (sine * x + cosine * y),
            cosine * ahead_x - sine * ahead_y,
            sine * ahead_x + cosine * ahead_y,
            max(free, 0.0),
            raster,
            present,
        )
        readings[sensor] = linear(distance, sensor_noise(words, sensor - first), robot)


@compiled
def free_way(
    u: float,
    v: float,
    ahead_u: float,
    ahead_v: float,
    free: float,
    raster: Raster,
    present: NDArray[np.uint8],
) -> float:
    """Return how far (mm) from (u, v), in cells, a ray meets its first occupied cell; at most 50.

    (ahead_u, ahead_v) is 1 mm of the ray, in cells; its first `free` mm need no look. The ray leaps
    as far as the clearance lets it and else goes from cell to cell, so it misses none.
    """
    way = free
    while way < LINEAR_REACH:
        ray_u, ray_v = u + way * ahead_u, v + way * ahead_v
        if occupied(ray_u, ray_v, raster.solid, present):
            return way
        leap = room(ray_u, ray_v, raster)
        if leap < 2.0 * raster.resolution:  # else it leaves its cell for certain
            leap = max(min(_to_border(ray_u, ahead_u), _to_border(ray_v, ahead_v)), leap)
        way += leap
    return LINEAR_REACH


@compiled
def _to_border(place: float, ahead: float) -> float:
    """Return the way (mm) to just past the next border of a cell along one axis, in cells."""
    if ahead > 0.0:
        return (int(place) + 1 - place + NUDGE) / ahead
    if ahead < 0.0:
        return (int(place) - place - NUDGE) / ahead
    return LINEAR_REACH


@compiled
def linear(distance: float, noise: int | np.int64, robot: np.record) -> int | np.int64:
    """Return the reading for a free way of so many mm: 1023 at 0, falling to 0 at 50.

    The noise grows with the distance: times U[1 - a, 1 + a), a = 0.01 at 50 mm and 0 at 0.
    """
    share = distance / LINEAR_REACH
    if share >= 1.0:
        return 0
    light = BRIGHTEST * (1.0 - share)
    if robot.infrared_noise:
        light *= 1.0 + LINEAR_SPREAD * share * centred(noise)
    return min(int(light), BRIGHTEST)

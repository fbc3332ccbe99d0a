"""Drive a robot about a small world and print where it was and what it read, to the last bit."""

import math

import numpy as np

from animat.numerics.streams import MOTORS, SENSORS, bits, uniforms
from animat.robot.collision import collide
from animat.robot.infrared import read_infrared
from animat.robot.khepera import Khepera
from animat.robot.motion import move
from animat.world.raster import Raster, tiled_room

STEPS = 150


def world() -> Raster:
    """Return a square floor with two discs on it, one of them absent in `drive`."""
    border, cells = 50, 250
    centres = (np.arange(cells) - border + 0.5) * 2.0
    x, y = np.meshgrid(centres, centres)
    walls = np.minimum.reduce([x - 20, 280 - x, y - 20, 280 - y])
    solid = (walls <= 0).astype(np.int16)
    clearance = np.maximum(walls, 0)
    for site, (disc_x, disc_y) in enumerate([(200.0, 150.0), (110.0, 220.0)]):
        away = np.sqrt((x - disc_x) ** 2 + (y - disc_y) ** 2) - 25
        solid[away <= 0] = site + 2
        clearance = np.minimum(clearance, np.maximum(away, 0))
    clearance = clearance.astype(np.float32)
    tiles, room = tiled_room(clearance, 2.0)
    return Raster(
        resolution=2.0,
        cells_per_mm=0.5,
        border=border,
        tiles=tiles,
        room=room,
        solid=solid,
        clearance=clearance,
        near_site=np.full((cells, cells, 1), -1, dtype=np.int16),
        near_distance=np.full((cells, cells, 1), np.inf, dtype=np.float32),
        site_x=np.array([200.0, 110.0]),
        site_y=np.array([150.0, 220.0]),
        site_type=np.zeros(2, dtype=np.int64),
        features=np.zeros((1, 2)),
        affords=np.zeros((1, 3)),
    )


def drive() -> list[str]:
    """Return every coordinate, heading and reading of a few short drives, in hexadecimal."""
    raster, present = world(), np.array([1, 0], dtype=np.uint8)
    readings = np.zeros(8, dtype=np.int64)
    seed, life = np.uint64(3), np.uint64(1)
    said = []
    for infrared in ("michel1996", "linear"):
        for noise in (True, False):
            settings = Khepera(infrared=infrared, infrared_noise=noise, motor_noise=noise)
            robot = settings.parameters()
            x, y, heading = 80.0, 80.0, 0.5
            for step in range(STEPS):
                read_infrared(
                    x,
                    y,
                    heading,
                    robot,
                    raster,
                    present,
                    bits(seed, life, SENSORS, step),
                    readings,
                    0,
                )
                left, right = ((10, 8), (9, 10), (-9, -4))[step // 15 % 3]
                u_x, u_y, u_turn, _ = uniforms(seed, life, MOTORS, step)
                goal = move(x, y, heading, left, right, robot, u_x, u_y, u_turn)
                x, y, heading, hit = collide(x, y, heading, *goal, robot, raster, present)
                assert -math.pi < heading <= math.pi
                said += [float(x).hex(), float(y).hex(), float(heading).hex(), str(int(hit))]
                said += [str(reading) for reading in readings.tolist()]
    return said


if __name__ == "__main__":
    print(*drive())  # noqa: T201

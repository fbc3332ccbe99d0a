"""Worlds, robots and lives as the figures want them: plain numbers and names."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from animat.figures.life import life_figure
from animat.figures.worlds import RobotDrawing, WorldDrawing
from animat.mind.mind import Drive, Mind
from animat.numerics.elementary import sine_cosine
from animat.robot.khepera import Khepera
from animat.robot.parameters import REACH
from animat.world.files import WorldFile
from animat.world.world import World

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPREAD = math.radians(20.0)
"""Half the opening angle a sensor is drawn with; its probes reach 18 mm aside at 40 mm."""


def world_drawing(
    world: World, title: str, pose: tuple[float, float, float] | None = None
) -> WorldDrawing:
    """Return a world as a figure draws it, objects as they stand at the start."""
    return WorldDrawing(
        title=title,
        width=world.arena.width,
        height=world.arena.height,
        free=world.arena.free,
        polygons=world.polygons()[: world.n_objects],
        types=[one.type for one in world.layout.placements],
        pose=pose,
    )


def file_drawing(file: WorldFile) -> WorldDrawing:
    """Return a world as its file has it, also where its objects cannot stand so."""
    kinds = {kind.name: kind.polygon() for kind in file.types}
    polygons = []
    for one in file.objects:
        sine, cosine = sine_cosine(one.angle)
        turned = kinds[one.type] @ np.array([[cosine, sine], [-sine, cosine]])
        polygons.append(turned + np.array([one.x, one.y]))
    return WorldDrawing(
        title=file.name,
        width=file.arena.width,
        height=file.arena.height,
        free=file.arena.free,
        polygons=polygons,
        types=[one.type for one in file.objects],
    )


def robot_drawing(robot: Khepera) -> RobotDrawing:
    """Return a robot as a figure draws it."""
    sensors = [(one.x, one.y, math.radians(one.direction)) for one in robot.sensors]
    return RobotDrawing(robot.radius, np.array(sensors), REACH[robot.infrared], SPREAD)


def _need(drive: Drive) -> str:
    """Return the variable a drive is about: of several, the one that weighs most in it."""
    weights = {
        name: abs(drive.a.get(name, 0.0)) + abs(drive.b.get(name, 0.0))
        for name in sorted({*drive.a, *drive.b})
    }
    return max(weights, key=lambda name: weights[name])


def draw_life(
    trace: pa.Table | Iterable[pa.Table],
    mind: Mind,
    world: World,
    title: str,
    span: tuple[int, int] | None,
) -> Figure:
    """Return the figure of a life by its trace: needs, drives, behaviours, events and the path.

    Of a trace in parts, `span` is its first step and the one after its last.
    """
    return life_figure(
        trace,
        span=span,
        set_points={
            name: variable.set_point for name, variable in mind.resolved_variables().items()
        },
        drives=(needs := {name: _need(drive) for name, drive in mind.drives.items()}),
        behaviours={name: needs[one.serves] for name, one in mind.behaviours.items()},
        world=world_drawing(world, world.name),
        title=title,
    )

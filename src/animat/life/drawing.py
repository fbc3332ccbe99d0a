"""Worlds, robots and lives as the figures want them: plain numbers and names."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from animat.report.figures.life import life_figure
from animat.report.figures.worlds import RobotDrawing, WorldDrawing
from animat.robot.khepera import REACH, Khepera
from animat.world.files import WorldFile
from animat.world.world import World

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from animat.life.life import Life

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
        sine, cosine = math.sin(one.angle), math.cos(one.angle)
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


def draw_life(life: Life) -> Figure:
    """Return the figure of a recorded life: needs, drives, behaviours, events and the path."""
    assert life.trace is not None
    title = f"{life.mind.agent}, {life.world.name}, seed {life.seed}: {life.lifespan:,} steps"
    return life_figure(
        life.trace,
        set_points={
            name: variable.set_point for name, variable in life.mind.resolved_variables().items()
        },
        drives=list(life.mind.drives),
        world=world_drawing(life.world, life.world.name),
        title=title if life.death is None else f"{title}, died of {life.death}",
    )

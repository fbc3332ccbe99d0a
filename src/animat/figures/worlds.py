"""Figure 2: worlds drawn to scale, with a robot and what its sensors reach."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch, Polygon, Rectangle, Wedge
from numpy.typing import NDArray

from animat.figures.style import (
    BLACK,
    GREEN,
    new_figure,
    styled,
    type_colours,
    type_words,
)


class WorldDrawing(NamedTuple):
    """A world as it is drawn; all lengths in mm.

    `free` is (left, right, bottom, top) of the free rectangle; `polygons` are arrays [n, 2] and
    `types` the name of each one's object type. `pose` is where the robot stands: x, y and
    heading in rad, or None.
    """

    title: str
    width: float
    height: float
    free: tuple[float, float, float, float]
    polygons: Sequence[NDArray[np.float64]]
    types: Sequence[str]
    pose: tuple[float, float, float] | None = None


class RobotDrawing(NamedTuple):
    """A robot as it is drawn. `sensors` [n, 3]: forward mm, left mm, direction rad.

    `reach` mm and `spread` rad: length and half the opening angle of what a sensor sees.
    """

    radius: float
    sensors: NDArray[np.float64]
    reach: float
    spread: float


@styled
def worlds_figure(worlds: Sequence[WorldDrawing], robot: RobotDrawing) -> Figure:
    """The worlds side by side at one scale, objects coloured by type."""
    fig = new_figure(3.7 * len(worlds) + 0.2, 4.25)
    axes = fig.subplots(1, len(worlds), squeeze=False)[0]
    colours = type_colours(name for world in worlds for name in world.types)
    widest = max(world.width for world in worlds)
    highest = max(world.height for world in worlds)
    for ax, world in zip(axes, worlds, strict=True):
        draw_world(ax, world, colours)
        if world.pose is not None:
            draw_robot(ax, robot, world.pose)
        ax.set_xlim(-0.01 * widest, 1.01 * widest)
        ax.set_ylim(-0.01 * highest, 1.01 * highest)
        ax.set_title(f"{world.title}: {_count(len(world.types))}")
    handles = type_handles(colours)
    if any(world.pose is not None for world in worlds):
        handles.append(
            Patch(facecolor="white", edgecolor=BLACK, linewidth=1.0, label="robot, to scale")
        )
        handles.append(Patch(facecolor=GREEN, alpha=0.35, label="reach of its sensors"))
    fig.legend(handles=handles, loc="outside lower center", ncols=min(3, len(handles)))
    return fig


def draw_world(ax: Axes, world: WorldDrawing, colours: dict[str, str]) -> None:
    """Draw the arena, its walls and its objects into `ax`, axes in mm."""
    ax.add_patch(Rectangle((0, 0), world.width, world.height, facecolor="#B8B8B8", edgecolor=BLACK))
    left, right, bottom, top = world.free
    ax.add_patch(Rectangle((left, bottom), right - left, top - bottom, facecolor="white"))
    for polygon, name in zip(world.polygons, world.types, strict=True):
        ax.add_patch(
            Polygon(polygon, closed=True, facecolor=colours[name], edgecolor=BLACK, linewidth=0.6)
        )
    ax.set_aspect("equal")
    ax.spines[["left", "bottom"]].set_visible(False)
    ax.set_xlim(0, world.width)
    ax.set_ylim(0, world.height)
    ax.set_xlabel("x (mm)")
    ax.set_ylabel("y (mm)")


def type_handles(colours: Mapping[str, str]) -> list[Patch]:
    """What a legend says of object types."""
    return [
        Patch(facecolor=colour, edgecolor=BLACK, linewidth=0.6, label=type_words(name))
        for name, colour in colours.items()
    ]


def draw_robot(ax: Axes, robot: RobotDrawing, pose: tuple[float, float, float]) -> None:
    """Draw the robot at `pose` (mm, mm, rad) with a line to its front."""
    x, y, heading = pose
    sine, cosine = np.sin(heading), np.cos(heading)
    for forward, sideways, direction in robot.sensors:
        at = (x + cosine * forward - sine * sideways, y + sine * forward + cosine * sideways)
        angle = np.degrees(heading + direction)
        spread = np.degrees(robot.spread)
        ax.add_patch(
            Wedge(at, robot.reach, angle - spread, angle + spread, facecolor=GREEN, alpha=0.35)
        )
    ax.add_patch(Circle((x, y), robot.radius, facecolor="white", edgecolor=BLACK, zorder=3))
    ax.plot(
        [x, x + cosine * robot.radius], [y, y + sine * robot.radius], color=BLACK, lw=1.2, zorder=4
    )


def _count(objects: int) -> str:
    return f"{objects} object" if objects == 1 else f"{objects} objects"

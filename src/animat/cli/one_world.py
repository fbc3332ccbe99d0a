"""A world before anyone lives in it: what stands there, what is free, what is wrong or odd."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np

from animat.cli.one_life import DRAWINGS
from animat.figures.worlds import worlds_figure
from animat.files.atomic import check_writable, whole
from animat.files.settings import SettingsError, read_toml
from animat.life.drawing import file_drawing, robot_drawing
from animat.robot.khepera import Khepera
from animat.study.file.settings import PUBLISHED, named, unknown
from animat.world.files import LARGEST_FILE, WorldFile, world_file
from animat.world.hints import IN_REACH, Room, hints_of_file, hints_of_world, room
from animat.world.world import World


class Look(NamedTuple):
    """A world looked at. With `problems` nobody can live in it, and its `room` is not known."""

    file: WorldFile
    room: Room | None
    problems: tuple[str, ...]
    hints: list[str]


def look(name: str) -> Look:
    """Look at a world of the paper or of a file. Raises SettingsError for a file with mistakes."""
    file = _file_of(name)
    hints = list(hints_of_file(file))
    try:
        world = World(file.layout(), file.name, file.resolution)
        raster = world.raster(IN_REACH)
    except SettingsError as error:
        return Look(file, None, tuple(f"{name}: {line}" for line in error.problems), hints)
    except ValueError as error:
        return Look(file, None, (f"{name}: {error}",), hints)
    return Look(file, room(raster), (), [*hints, *hints_of_world(world, raster)])


def draw(file: WorldFile, path: Path, *, force: bool) -> None:
    """Draw a world, whether it can be or not. Raises SettingsError where it cannot be written."""
    check_writable(path, DRAWINGS, force=force)
    fig = worlds_figure([file_drawing(file)], robot_drawing(Khepera()))
    with whole(path) as partial:
        fig.savefig(partial, format=path.suffix[1:].lower())


def table(file: WorldFile) -> list[tuple[str, ...]]:
    """Return a row for each object type: name, width and length, objects, spares, affordances."""
    objects = Counter(site.type for site in file.objects)
    spares = Counter(site.type for site in file.spares)
    rows = []
    for kind in file.types:
        across = " x ".join(f"{side:.0f}" for side in np.ptp(kind.polygon(), axis=0))
        affords = ", ".join(f"{name} {chance:g}" for name, chance in kind.affords.items())
        rows.append((kind.name, across, str(objects[kind.name]), str(spares[kind.name]), affords))
    return rows


def _file_of(name: str) -> WorldFile:
    if name in PUBLISHED:
        world = named(name)
        return world_file(world.name, world.layout, world.resolution)
    if Path(name).suffix != ".toml":
        raise unknown(name, PUBLISHED)
    return read_toml(name, WorldFile, LARGEST_FILE)

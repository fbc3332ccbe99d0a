"""Worlds as TOML files.

name = "two islands"
resolution = 2.0                # mm; optional
minimum_gap = 70.0              # mm; optional

[arena]                         # optional, as is each of its keys
width = 1000.0

[[types]]                       # optional: without any, those of Table 1
name = "TS"
shape = "triangle"              # or a number of sides, or corners [[x, y], ...]
size_mm = 45.0
features = { shape = 0.0, size = 0.0 }
affords = { grasp = 1.0, shelter = 0.0, interact = 1.0 }

[[objects]]
type = "TS"
x = 300.0                       # mm
y = 400.0
angle = 0.5                     # rad; optional

[[spares]]                      # optional; written like objects
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import tomli_w
from pydantic import AfterValidator, Field, ValidationInfo

from animat.files.atomic import write_whole
from animat.files.settings import Settings, SettingsError, nearest, read_toml
from animat.names import malformed
from animat.world.arena import Arena
from animat.world.layout import MINIMUM_GAP, Layout, Placement
from animat.world.objects import TABLE_1, ObjectType

LARGEST_FILE = 10_000_000
"""Bytes; as many sites as a world may have need about a quarter of it."""


def _known_type(site: Placement, info: ValidationInfo) -> Placement:
    """Refuse a site of unknown type here, so that it is told together with other mistakes."""
    types = info.data.get("types")
    known = [kind.name for kind in types or ()]
    if known and site.type not in known:
        raise ValueError(f'type "{site.type}" is unknown{nearest(site.type, known)}')
    return site


def _writable(name: str) -> str:
    if problem := malformed(name):
        raise ValueError(problem)
    return name


Name = Annotated[str, AfterValidator(_writable)]
"""The name of a world."""

Site = Annotated[Placement, AfterValidator(_known_type)]


class WorldFile(Settings):
    """What a world's file may say."""

    name: Name
    resolution: Annotated[float, Field(ge=0.1, le=50)] = 2.0
    minimum_gap: Annotated[float, Field(ge=0)] = MINIMUM_GAP
    arena: Arena = Arena()
    types: tuple[ObjectType, ...] = TABLE_1
    objects: tuple[Site, ...]
    spares: tuple[Site, ...] = ()

    def layout(self) -> Layout:
        """Return the layout. Raises LayoutError."""
        return Layout(
            placements=self.objects,
            types=self.types,
            spares=self.spares,
            arena=self.arena,
            minimum_gap=self.minimum_gap,
        )


def read_world(path: Path) -> tuple[str, Layout, float]:
    """Return name, layout and resolution (mm) of a world's file.

    Raises:
        SettingsError: a file that is missing or no TOML, or a line for every mistake in it.
    """
    content = read_toml(path, WorldFile, LARGEST_FILE)
    try:
        layout = content.layout()
    except SettingsError as error:
        raise type(error)(*(f"{path}: {line}" for line in error.problems)) from None
    return content.name, layout, content.resolution


def write_world(path: Path, name: str, layout: Layout, resolution: float) -> None:
    """Write a world's file, whole or not at all.

    Raises:
        SettingsError: the file cannot be written.
    """
    content = world_file(name, layout, resolution).model_dump(exclude_none=True)
    write_whole(path, tomli_w.dumps(content).encode())


def world_file(name: str, layout: Layout, resolution: float) -> WorldFile:
    """Return a world as its file says it."""
    return WorldFile.model_construct(
        name=name,
        resolution=float(resolution),
        minimum_gap=float(layout.minimum_gap),
        arena=layout.arena,
        types=layout.types,
        objects=layout.placements,
        spares=layout.spares,
    )

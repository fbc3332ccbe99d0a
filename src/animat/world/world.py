"""A world: object types, where they stand, and the raster that lives read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from importlib.resources import as_file, files
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from animat.files import arguments
from animat.files.arguments import instance, real, whole
from animat.files.settings import SettingsError
from animat.files.validation_errors import brief
from animat.names import malformed
from animat.world.arena import Arena
from animat.world.files import read_world, write_world
from animat.world.layout import MINIMUM_GAP, Layout, LayoutError
from animat.world.objects import TABLE_1, ObjectType
from animat.world.raster import Raster, draw
from animat.world.scatter import scattered, with_spares

RESOLUTION = 2.0
"""mm to a cell's side, as in Michel's Khepera Simulator."""

FINEST, COARSEST = 0.1, 50.0
_RASTERS_KEPT = 16


@dataclass(frozen=True)
class World:
    """Where lives are lived. Two worlds of the same content are equal and share their raster.

    `resolution` is the side (mm) of a cell of the raster.
    """

    layout: Layout
    name: str = "world"
    resolution: float = RESOLUTION

    def __post_init__(self) -> None:
        """Refuse what is no world. Raises SettingsError."""
        instance("layout", self.layout, Layout)
        if problem := malformed(instance("name", self.name, str)):
            raise SettingsError(f"name = {brief(self.name)}: {problem}")
        object.__setattr__(self, "name", str.__str__(self.name))
        resolution = real("resolution", self.resolution, FINEST, COARSEST)
        object.__setattr__(self, "resolution", resolution)

    @classmethod
    def abundant(cls) -> World:
        """Return World 1 of the paper, as laid out here."""
        return cls._published("world1.toml")

    @classmethod
    def scarce(cls) -> World:
        """Return World 2 of the paper, as laid out here: the same arena, fewer objects."""
        return cls._published("world2.toml")

    @classmethod
    def random(
        cls,
        counts: Mapping[str, int],
        seed: int = 0,
        gap: float = MINIMUM_GAP,
        arena: Arena | None = None,
        types: tuple[ObjectType, ...] = TABLE_1,
        spares: int = 0,
        resolution: float = RESOLUTION,
        name: str | None = None,
    ) -> World:
        """Return a world with `counts` objects of each type at random places and angles.

        `gap` is the least distance (mm) between objects and from the walls, `spares` the number
        of spare sites of every type that occurs. The objects do not depend on `spares`.

        Raises:
            LayoutError: unknown types, impossible values, or counts that do not fit.
        """
        spares = whole("spares", spares, error=LayoutError)
        layout = scattered(counts, seed, gap, Arena() if arena is None else arena, types)
        if name is None:
            told = " ".join(f"{count} {kind}" for kind, count in counts.items() if count)
            name = f"random {told or 'empty'}, seed {seed}"
        world = cls(layout=layout, name=name, resolution=resolution)
        return world.with_spares(spares, seed=seed) if spares else world

    @classmethod
    def load(cls, path: str | Path) -> World:
        """Return the world of a TOML file.

        Raises:
            SettingsError: with a line for everything that is wrong with the file.
        """
        name, layout, resolution = read_world(arguments.path("path", path))
        return cls(layout=layout, name=name, resolution=resolution)

    def save(self, path: str | Path) -> None:
        """Write the world as a TOML file that `load` reads back as the same world.

        Raises:
            SettingsError: the file cannot be written.
        """
        write_world(arguments.file("path", path), self.name, self.layout, self.resolution)

    def with_spares(self, n_per_type: int, seed: int = 0, gap: float | None = None) -> World:
        """Return the world with `n_per_type` more spare sites of every type that occurs in it.

        `gap` (mm) is the layout's own unless given.

        Raises:
            LayoutError: an impossible value, or spares that do not fit.
        """
        own = self.layout.minimum_gap if gap is None else gap
        return replace(self, layout=with_spares(self.layout, n_per_type, seed, own))

    @property
    def arena(self) -> Arena:
        """The arena."""
        return self.layout.arena

    @property
    def types(self) -> tuple[ObjectType, ...]:
        """The object types, in the order of the raster's features and affords."""
        return self.layout.types

    @property
    def n_objects(self) -> int:
        """How many objects stand at the start; theirs are the first sites."""
        return len(self.layout.placements)

    @property
    def n_sites(self) -> int:
        """How many sites there are, spare ones included."""
        return len(self.layout.sites)

    @property
    def feature_names(self) -> tuple[str, ...]:
        """The features' names, in the order of the raster's columns."""
        return tuple(self.types[0].features)

    @property
    def affordances(self) -> tuple[str, ...]:
        """The affordances' names, in the order of the raster's columns."""
        return tuple(self.types[0].affords)

    def polygons(self) -> list[NDArray[np.float64]]:
        """Return the corners [n, 2] of every site in arena coordinates (mm)."""
        outlines = self.layout.outlines()
        return np.split(outlines.outline, outlines.first[1:-1])[: self.n_sites]

    def raster(self, horizon: float) -> Raster:
        """Return the world drawn on cells; sites within `horizon` mm of a cell are near it.

        Drawn once for a content, a horizon and a resolution, then kept and shared: read only.

        Raises:
            SettingsError: an impossible horizon, or too many cells.
        """
        return _raster(self, real("horizon", horizon, 0.0))

    @classmethod
    @cache
    def _published(cls, name: str) -> World:
        with as_file(files("animat.world") / "data" / name) as path:
            return cls.load(path)


@lru_cache(maxsize=_RASTERS_KEPT)
def _raster(world: World, horizon: float) -> Raster:
    features = [[t.features[name] for name in world.feature_names] for t in world.types]
    affords = [[t.affords[name] for name in world.affordances] for t in world.types]
    return draw(
        world.arena,
        world.layout.outlines(),
        world.layout.site_types(),
        np.array(features, dtype=np.float64),
        np.array(affords, dtype=np.float64),
        horizon,
        world.resolution,
    )

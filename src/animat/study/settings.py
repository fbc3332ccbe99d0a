"""Settings files: the world, the robot and the mind of a study, in TOML.

A section left out has the defaults of the paper. Every name in a file is checked, and every
mistake told at once.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

from pydantic import Field, model_validator

from animat.mind.mind import Mind
from animat.robot.khepera import Khepera
from animat.settings import Settings, SettingsError, nearest
from animat.world.layout import MINIMUM_GAP
from animat.world.world import RESOLUTION, World

PUBLISHED = ("abundant", "scarce")


class WorldChoice(Settings):
    """Which world: `abundant`, `scarce`, `random` (by counts, seed and gap), or a world's file.

    The tables call it by `name`, or where that is left out by the name it has of itself.
    """

    layout: str = "abundant"
    name: Annotated[str, Field(min_length=1)] | None = None
    counts: dict[str, Annotated[int, Field(ge=0)]] | None = None
    seed: Annotated[int, Field(ge=0)] = 0
    gap: Annotated[float, Field(ge=0.0)] = MINIMUM_GAP
    spares: Annotated[int, Field(ge=0)] = 0
    resolution: Annotated[float, Field(gt=0.0)] = RESOLUTION

    @model_validator(mode="after")
    def _consistent(self) -> WorldChoice:
        if (self.layout == "random") != (self.counts is not None):
            raise ValueError('layout = "random" and counts = {...} go together')
        return self

    def world(self) -> World:
        """Return the world. Raises SettingsError for one that is unknown or impossible."""
        world = self._laid_out()
        return world if self.name is None else replace(world, name=self.name)

    def _laid_out(self) -> World:
        if self.layout == "random":
            assert self.counts is not None
            return World.random(
                self.counts,
                seed=self.seed,
                gap=self.gap,
                spares=self.spares,
                resolution=self.resolution,
            )
        world = named(self.layout)
        if self.resolution != RESOLUTION:
            world = World(world.layout, world.name, self.resolution)
        return world.with_spares(self.spares, seed=self.seed) if self.spares else world


def named(name: str) -> World:
    """Return a published world by its name, or the world of a TOML file.

    Raises SettingsError for one that is unknown.
    """
    if name == "abundant":
        return World.abundant()
    if name == "scarce":
        return World.scarce()
    if Path(name).suffix == ".toml":
        return World.load(name)
    raise SettingsError(
        f'world "{name}": no such world, and no .toml file of one{nearest(name, PUBLISHED)}'
    )


class LifeSettings(Settings):
    """A settings file: [world], [robot] and [mind]."""

    world: WorldChoice = WorldChoice()
    robot: Khepera = Khepera()
    mind: Mind = Mind()

"""Settings files: the world, the robot and the mind of a study, in TOML.

A section left out has the defaults of the paper. Every name in a file is checked, and every
mistake told at once. A study file has more: what else may differ from case to case is here, too.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, field_validator, model_validator

from animat.files.arguments import instance
from animat.files.settings import Settings, SettingsError, nearest
from animat.files.validation_errors import plain
from animat.life.life import LONGEST
from animat.mind.mind import Mind
from animat.names import malformed
from animat.robot.khepera import Khepera
from animat.world.arena import Arena
from animat.world.files import Name
from animat.world.layout import MINIMUM_GAP
from animat.world.world import RESOLUTION, World

PUBLISHED = ("abundant", "scarce")

Steps = Annotated[int, Field(ge=1, le=LONGEST)]


class WorldChoice(Settings):
    """Which world: `abundant`, `scarce`, `random` (by counts, seed, gap and arena), or a file.

    The tables call it by `name`, or where that is left out by the name it has of itself.
    """

    layout: str = "abundant"
    name: Name | None = None
    counts: dict[str, Annotated[int, Field(ge=0)]] | None = None
    seed: Annotated[int, Field(ge=0)] = 0
    gap: Annotated[float, Field(ge=0.0)] = MINIMUM_GAP
    arena: Arena | None = None
    spares: Annotated[int, Field(ge=0)] = 0
    resolution: Annotated[float, Field(gt=0.0)] = RESOLUTION

    @model_validator(mode="after")
    def _consistent(self) -> WorldChoice:
        if (self.layout == "random") != (self.counts is not None):
            raise ValueError('layout = "random" and counts = {...} go together')
        if self.arena is not None and self.layout != "random":
            raise ValueError('arena = {...} needs layout = "random"; other worlds have their own')
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
                arena=self.arena,
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
    raise unknown(name, PUBLISHED)


def unknown(name: str, known: Sequence[str]) -> SettingsError:
    """Return what to say of the name of a world that there is not."""
    return SettingsError(
        f'world "{name}": no such world, and no .toml file of one{nearest(name, known)}'
    )


class LifeSettings(Settings):
    """A settings file: [world], [robot] and [mind]."""

    world: WorldChoice = WorldChoice()
    robot: Khepera = Khepera()
    mind: Mind = Mind()


def _by_name(world: Any) -> Any:
    """Let the name of a world stand for the choice of it."""
    if isinstance(world, dict | WorldChoice):
        return world
    if not isinstance(world, str):
        raise ValueError("must be the name of a world, or a table")
    return {"layout": world}


class Teacher(Settings):
    """Who learnt the networks of AF: life i has those of robot i modulo `robots`.

    The robots have the mind of the case, with the agent LEARNING.
    """

    robots: Annotated[int, Field(ge=1, le=1_000_000)] = 100
    steps: Steps = 300_000
    world: Annotated[
        WorldChoice, BeforeValidator(_by_name, json_schema_input_type=WorldChoice | str)
    ] = WorldChoice()


class CaseSettings(LifeSettings):
    """What may differ from case to case: further, the cap of a life, worlds, and who teaches AF."""

    steps: Steps = 300_000
    worlds: dict[str, WorldChoice] = {}
    teacher: Teacher | None = None

    @field_validator("worlds")
    @classmethod
    def _own(cls, worlds: dict[str, WorldChoice]) -> dict[str, WorldChoice]:
        problems = []
        for name, choice in worlds.items():
            if problem := malformed(name):
                problems.append(f"{plain(name)}: {problem}")
            elif name in {"", "random", *PUBLISHED} or Path(name).suffix == ".toml":
                problems.append(f"{plain(name)} is taken; give the world a name of its own")
            elif choice.layout in worlds:
                problems.append(f'{plain(name)} has layout = "{choice.layout}", itself one of them')
        told = Counter(choice.name or name for name, choice in worlds.items())
        problems += [f"{times} are called {plain(n)}" for n, times in told.items() if times > 1]
        if problems:
            raise ValueError("\n".join(problems))
        return worlds

    def chosen(self, choice: WorldChoice) -> WorldChoice:
        """Return a choice of a world in which no name of one of `worlds` is left.

        What is set beside the name goes before what that world sets. Raises SettingsError for a
        layout that is no world.
        """
        instance("choice", choice, WorldChoice)
        if choice.layout not in self.worlds:
            _refuse_unknown(choice.layout, [*self.worlds, *PUBLISHED, "random"])
            return choice
        own = self.worlds[choice.layout]
        _refuse_unknown(own.layout, [*PUBLISHED, "random"])
        beside = {name: getattr(choice, name) for name in choice.model_fields_set - {"layout"}}
        name = {"name": own.name or choice.layout}
        return WorldChoice(**{**own.model_dump(), **name, **beside})


def _refuse_unknown(layout: str, known: Sequence[str]) -> None:
    if layout not in known and Path(layout).suffix != ".toml":
        raise unknown(layout, known)

"""A study: base settings, a design that varies them, and how many lives each case is.

A study file is a settings file with more in it; docs/studies.md describes it.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import tomli_w
from pydantic import BeforeValidator, Field, ValidationError, field_validator, model_validator

from animat.life.life import LONGEST, Recording
from animat.mistakes import plain
from animat.settings import Settings, SettingsError, explain, parse_toml, validated
from animat.study.design import Design
from animat.study.keys import UnknownKeyError, put, read_key
from animat.study.settings import PUBLISHED, LifeSettings, WorldChoice

Steps = Annotated[int, Field(ge=1, le=LONGEST)]

MOST_LIVES = 10**9
"""Lives a case may have; so the index of every life stays a whole number of 64 bits."""


def _by_name(world: Any) -> Any:
    return {"layout": world} if isinstance(world, str) else world


class Teacher(Settings):
    """Who learnt the networks of AF: life i has those of robot i modulo `robots`.

    The robots have the mind of the case, with the agent LEARNING.
    """

    robots: Annotated[int, Field(ge=1, le=1_000_000)] = 100
    steps: Steps = 300_000
    world: Annotated[WorldChoice, BeforeValidator(_by_name)] = WorldChoice()


class Record(Settings):
    """The traces that are written: `what` of the first `lives` lives of every case."""

    what: str
    lives: Annotated[int, Field(ge=1)] = 1

    @field_validator("what")
    @classmethod
    def _known(cls, what: str) -> str:
        Recording.parse(what)
        return what


class CaseSettings(LifeSettings):
    """What may differ from case to case."""

    steps: Steps = 300_000
    worlds: dict[str, WorldChoice] = {}
    teacher: Teacher | None = None


class Study(CaseSettings):
    """A study, as its file has it."""

    name: Annotated[str, Field(pattern=r"^\w[\w .-]{0,79}$")]
    seed: Annotated[int, Field(ge=0, lt=1 << 63)] = 0
    lives: Annotated[int, Field(ge=1, le=MOST_LIVES)] = 100
    paired: bool = True
    measures: list[Literal["likelihoods", "learning_curve"]] = []
    record: Record | None = None
    design: Design = Design()

    @model_validator(mode="after")
    def _possible(self) -> Study:
        problems = []
        for name in self.worlds:
            if name in {*PUBLISHED, "random"} or name.endswith(".toml") or not name:
                problems.append(f"worlds.{plain(name)}: this name is taken; give it another")
        if self.record is not None and self.record.lives > self.lives:
            problems.append(f"record.lives = {self.record.lives} is more than lives = {self.lives}")
        if self.mind.networks is not None:
            problems.append("mind.networks: a study has no networks; give [teacher], who learns")
        if problems:
            raise ValueError("\n".join(problems))
        return self

    def to_toml(self) -> str:
        """Return the study as a file that reads back as the same study, every default written."""
        data = self.model_dump(mode="json", exclude_none=True)
        # What a world leaves out it has from the world that its layout names.
        data["world"] = self.world.model_dump(mode="json", exclude_unset=True)
        if self.teacher is not None:
            data["teacher"]["world"] = self.teacher.world.model_dump(
                mode="json", exclude_unset=True
            )
        design = self.design.to_toml()
        del data["design"]
        first = {"name": data.pop("name")}
        rest = {key: value for key, value in data.items() if value != {}}
        return tomli_w.dumps(first | rest) + design


def read_study(path: Path | str, overrides: Sequence[str] = ()) -> Study:
    """Return the study of a file, changed by `overrides`, each "key=value".

    Raises:
        SettingsError: with a line for every mistake in file, overrides and design.
    """
    from animat.study.design import cases

    data = parse_toml(path)
    problems: list[str] = []
    for text in overrides:
        try:
            key, value = _override(text)
            put(data, Study, key, value)
        except UnknownKeyError as mistake:
            problems.append(f"--set {plain(text)}: {mistake}")
    try:
        study = validated(data, Study)
        cases(study)
    except ValidationError as error:
        problems += explain(error, Study, str(path)).problems
    except SettingsError as error:
        problems += [f"{path}: {line}" for line in error.problems]
    if problems:
        raise SettingsError(*problems)
    return study


def _override(text: str) -> tuple[tuple[str, ...], Any]:
    """Return key and value of "key=value"; the value is TOML, or a bare word for a string."""
    name, equals, value = text.partition("=")
    if not equals:
        raise UnknownKeyError("is not key=value")
    key = read_key(name.strip())
    try:
        parsed = tomllib.loads(f"value = {value.strip()}\n")
    except ValueError:
        if re.fullmatch(r"[^\s\"'\[\]{}#=,]+", value.strip()):
            return key, value.strip()
        raise UnknownKeyError("its value is neither TOML nor a bare word") from None
    if list(parsed) != ["value"]:
        raise UnknownKeyError("is more than one key=value")
    return key, json.loads(json.dumps(parsed["value"], default=str))

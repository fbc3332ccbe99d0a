"""A study: base settings, a design that varies them, and how many lives each case is.

A study file is a settings file with more in it; docs/studies.md describes it.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import tomli_w
from pydantic import AfterValidator, Field, ValidationError, field_validator, model_validator
from pydantic_core import PydanticSerializationError

from animat import arguments
from animat.arguments import sequence
from animat.life.life import TraceChoice
from animat.life.setting import LifeError
from animat.mistakes import mistakes, written
from animat.settings import (
    Settings,
    SettingsError,
    parse_toml,
    validated,
    values_within,
)
from animat.study.design.design import Design, cases
from animat.study.design.factors import each_once
from animat.study.design.keys import Key
from animat.study.design.overrides import led_by, override
from animat.study.design.refusals import VARIES, design_mistakes, varied_keys
from animat.study.design.settings import CaseSettings, Teacher
from animat.study.design.shipped import LONGEST_NAME, is_name
from animat.study.design.telling import told

__all__ = ["Record", "Study", "Teacher", "read_study"]

MOST_LIVES = 10**9
"""Lives a case may have; so the index of every life is a whole number of 63 bits."""


def _named_like_a_directory(name: str) -> str:
    if not is_name(name):
        raise ValueError(
            f"must be up to {LONGEST_NAME} letters, digits, blanks and . _ -, the first and the"
            " last a letter or digit: results go to a directory of this name"
        )
    return name


class Record(Settings):
    """The traces that are written: `what` of each of the first `lives` lives of every case.

    `what` is "all", "every:N" or "last:N" steps.
    """

    what: str
    lives: Annotated[int, Field(ge=1)] = 1

    @field_validator("what")
    @classmethod
    def _known(cls, what: str) -> str:
        try:
            TraceChoice.parse(what)
        except LifeError as error:
            raise ValueError(str(error).partition("; ")[2]) from None
        return what


class Study(CaseSettings):
    """A study, as its file has it."""

    name: Annotated[str, AfterValidator(_named_like_a_directory)]
    seed: Annotated[int, Field(ge=0, lt=1 << 63)] = 0
    lives: Annotated[int, Field(ge=1, le=MOST_LIVES)] = 100
    paired: bool = True
    measures: Annotated[
        list[Literal["likelihoods", "learning_curve"]], AfterValidator(each_once)
    ] = []
    record: Record | None = None
    design: Design = Design()

    @model_validator(mode="after")
    def _possible(self) -> Study:
        problems = []
        if self.record is not None and self.record.lives > self.lives:
            problems.append(f"record.lives = {self.record.lives} exceeds lives = {self.lives}")
        if self.mind.networks is not None:
            problems.append("mind.networks: a study has no networks; say in [teacher] who learns")
        try:
            self.mind.model_dump_json()
        except PydanticSerializationError:
            problems.append("mind has a function of your own: give it as FILE.py:NAME in a study")
        if problems:
            raise ValueError("\n".join(problems))
        return self

    def varied(self) -> dict[str, Any]:
        """Return the settings that cases may differ in, those that are given, as TOML has them."""
        return self.model_dump(
            mode="json",
            include=set(CaseSettings.model_fields),
            exclude_unset=True,
            exclude_none=True,
        )

    def to_toml(self) -> str:
        """Return a file that reads back as this study, with the defaults of all settings in it."""
        data = self.model_dump(mode="json", exclude_none=True, exclude={"design"})
        # What a world leaves out it may have from the world that its layout names.
        data["world"] = self.world.model_dump(mode="json", exclude_unset=True)
        if self.teacher is not None:
            data["teacher"]["world"] = self.teacher.world.model_dump(
                mode="json", exclude_unset=True
            )
        return tomli_w.dumps({"name": self.name} | data) + self.design.to_toml()


def read_study(path: Path | str, overrides: Sequence[str] = ()) -> Study:
    """Return the study of a file, changed by `overrides`, each "key=value".

    The value is TOML, or a bare word, which is taken for a string. Raises SettingsError, with a
    line for every mistake in the file, in the overrides and in the design.
    """
    path = arguments.path("path", path)
    overrides = sequence("overrides", overrides, str)
    return study_of(parse_toml(path), str(path), overrides)


def study_of(data: dict[str, Any], where: str, overrides: Sequence[str] = ()) -> Study:
    """Return the study that TOML says, as `read_study` does; `where` leads the lines of errors."""
    unshown = [written(key) for key, _ in values_within(data) if not str(key[-1]).isprintable()]
    if unshown:
        raise SettingsError(*(f"{where}: key {key}: cannot be printed" for key in told(unshown)))
    overridden, problems = override(data, Study, overrides, _spell_out)
    design = _design_of(data)
    problems += [
        f"--set {written(key)}: the design varies it; change the design"
        for key in overridden
        if any(_overlap(key, varied) for varied in varied_keys(design))
    ]
    try:
        study = validated(data, Study)
        cases(study)
    except ValidationError as error:
        base = {root: data[root] for root in VARIES if isinstance(data.get(root), dict)}
        found = [line for one in design_mistakes(design, base) for line in one.lines()]
        lines = told([*mistakes(error, Study), *found])
    except SettingsError as error:
        lines = list(error.problems)
    else:
        if not problems:
            return study
        lines = []
    raise SettingsError(
        *problems, *(f"{led_by(line, [('--set', overridden)], where)}: {line}" for line in lines)
    )


def _spell_out(data: dict[str, Any]) -> None:
    """Write the world of the teacher as a table, where it is given by its name."""
    teacher = data.get("teacher")
    if isinstance(teacher, dict) and isinstance(teacher.get("world"), str):
        teacher["world"] = {"layout": teacher["world"]}


def _design_of(data: dict[str, Any]) -> Design:
    """Return the design of a study, of one with mistakes what of it is written like a design."""
    parts = data.get("design")
    parts = dict(parts) if isinstance(parts, dict) else {}
    if isinstance(grid := parts.get("grid"), dict):
        parts["grid"] = {name: each for name, each in grid.items() if _suits("grid", {name: each})}
    return validated({name: each for name, each in parts.items() if _suits(name, each)}, Design)


def _suits(name: str, part: Any) -> bool:
    """Tell whether a part of a design is written like one."""
    try:
        validated({name: part}, Design)
    except ValidationError:
        return False
    return True


def _overlap(one: Key, other: Key) -> bool:
    shorter = min(len(one), len(other))
    return one[:shorter] == other[:shorter]

"""A study: base settings, a design that varies them, and how many lives each case is.

A study file is a settings file with more in it; docs/studies.md describes it.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

import tomli_w
from pydantic import AfterValidator, Field, field_validator, model_validator
from pydantic_core import PydanticSerializationError

from animat.files.settings import (
    Settings,
)
from animat.life.life import TraceChoice
from animat.life.lives import MOST_LIVES
from animat.life.scenario import LifeError
from animat.study.file.builtin import LONGEST_NAME, is_name
from animat.study.file.design import Design
from animat.study.file.factors import each_once
from animat.study.file.settings import CaseSettings


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

"""The settings of each case, section by section.

Cases differ in few settings, so most sections are shared by many cases: each is validated once.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

from pydantic import ValidationError

from animat.files.settings import SettingsError, validated
from animat.files.validation_errors import mistakes
from animat.study.file.axes import Axis, Combination
from animat.study.file.keys import put
from animat.study.file.settings import CaseSettings, LifeSettings, Teacher

MADE_OF = {
    "mind": ("mind",),
    "robot": ("robot",),
    "steps": ("steps",),
    "world": ("world", "worlds"),
    "teacher": ("teacher", "worlds"),
}
"""What each section of a case depends on."""

NO_TEACHER = (
    "the agent AF needs networks that a robot has learnt: add a section [teacher],"
    " or take another agent"
)


class Resolved(NamedTuple):
    """The settings of a case, or what is wrong with them, a line for each mistake."""

    settings: LifeSettings
    steps: int
    teacher: Teacher | None
    problems: tuple[str, ...]


class _Section(NamedTuple):
    value: Any
    problems: tuple[str, ...]


def resolver(base: dict[str, Any], axes: Sequence[Axis]) -> Callable[[Combination], Resolved]:
    """Return what makes the settings of a combination out of `base`, as TOML has them."""
    touching = {
        root: [
            number
            for number, axis in enumerate(axes)
            if any(key[0] == root for option in axis for key in option.changes)
        ]
        for root in CaseSettings.model_fields
    }
    axes_of = {
        name: sorted({number for root in roots for number in touching[root]})
        for name, roots in MADE_OF.items()
    }

    @cache
    def section(name: str, numbers: Combination) -> _Section:
        data = copy.deepcopy({root: base[root] for root in MADE_OF[name] if root in base})
        for axis, number in zip(axes_of[name], numbers, strict=True):
            for key, value in axes[axis][number].changes.items():
                if key[0] in MADE_OF[name]:
                    put(data, CaseSettings, key, value)
        return _validated_section(name, data)

    def resolve(combination: Combination) -> Resolved:
        mind, robot, steps, world, teacher = (
            section(name, tuple(combination[axis] for axis in axes_of[name])) for name in MADE_OF
        )
        problems = mind.problems + robot.problems + steps.problems + world.problems
        is_taught = not mind.problems and mind.value.agent == "AF"
        if is_taught:
            problems += teacher.problems
            if not teacher.problems and teacher.value is None:
                problems += (NO_TEACHER,)
        if problems:
            return Resolved(LifeSettings(), 1, None, problems)
        settings = LifeSettings(world=world.value, robot=robot.value, mind=mind.value)
        return Resolved(settings, steps.value, teacher.value if is_taught else None, ())

    return resolve


def _validated_section(name: str, data: dict[str, Any]) -> _Section:
    try:
        settings = validated(data, CaseSettings)
    except ValidationError as error:
        return _Section(None, tuple(mistakes(error, CaseSettings)))
    try:
        if name == "world":
            return _Section(settings.chosen(settings.world), ())
        if name == "teacher" and settings.teacher is not None:
            world = settings.chosen(settings.teacher.world)
            return _Section(settings.teacher.model_copy(update={"world": world}), ())
    except SettingsError as error:
        where = "world" if name == "world" else "teacher.world"
        return _Section(None, tuple(f"key {where}.layout: {line}" for line in error.problems))
    return _Section(getattr(settings, name), ())

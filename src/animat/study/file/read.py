"""Reading a study file, and everything that can be wrong with it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from animat.files import arguments
from animat.files.arguments import sequence
from animat.files.settings import SettingsError, parse_toml, validated, values_within
from animat.files.validation_errors import mistakes, written
from animat.study.file.cases import cases
from animat.study.file.check import VARIES, design_mistakes, varied_keys
from animat.study.file.design import Design
from animat.study.file.keys import Key
from animat.study.file.messages import told
from animat.study.file.overrides import led_by, override
from animat.study.file.study import Study


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

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

import json
import re
import tomllib
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from animat.world.arena import Arena
from animat.world.layout import MINIMUM_GAP, Layout, Placement
from animat.world.objects import TABLE_1, ObjectType
from animat.world.problems import WorldError, explained, nearest_name


class WorldFile(BaseModel):
    """What a world's file may say."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: Annotated[str, Field(min_length=1)]
    resolution: Annotated[float, Field(strict=True, ge=0.1, le=50)] = 2.0
    minimum_gap: Annotated[float, Field(strict=True, ge=0, allow_inf_nan=False)] = MINIMUM_GAP
    arena: Arena = Field(default_factory=Arena)
    types: tuple[ObjectType, ...] = TABLE_1
    objects: tuple[Placement, ...]
    spares: tuple[Placement, ...] = ()


def read_world(path: Path) -> tuple[str, Layout, float]:
    """Return name, layout and resolution (mm) of a world's file.

    Raises:
        WorldError: a file that is missing or no TOML, or a line for every mistake in it.
    """
    data = _read_toml(path)
    try:
        content = WorldFile.model_validate(data)
    except ValidationError as error:
        found = explained(error, WorldFile) + _unknown_types(data)
        raise WorldError(f"{path}: {line}" for line in found) from None
    try:
        layout = Layout(
            placements=content.objects,
            types=content.types,
            spares=content.spares,
            arena=content.arena,
            minimum_gap=content.minimum_gap,
        )
    except WorldError as error:
        raise type(error)(f"{path}: {line}" for line in error.problems) from None
    return content.name, layout, content.resolution


def write_world(path: Path, name: str, layout: Layout, resolution: float) -> None:
    """Write a world's file, whole or not at all.

    Raises:
        WorldError: the file cannot be written.
    """
    lines = [
        f"name = {_value(name)}",
        f"resolution = {_value(resolution)}",
        f"minimum_gap = {_value(layout.minimum_gap)}",
    ]
    lines += _table("[arena]", layout.arena)
    for header, entries in (
        ("[[types]]", layout.types),
        ("[[objects]]", layout.placements),
        ("[[spares]]", layout.spares),
    ):
        if entries:
            for entry in entries:
                lines += _table(header, entry)
        elif header == "[[objects]]":
            lines.insert(3, "objects = []")
    partial = path.with_name(path.name + ".partial")
    try:
        partial.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
        partial.replace(path)
    except OSError as error:
        with suppress(OSError):
            partial.unlink()
        raise WorldError([f"{path}: cannot be written: {error.strerror}"]) from None


def _read_toml(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise WorldError([f"{path}: there is no such file"]) from None
    except OSError as error:
        raise WorldError([f"{path}: cannot be read: {error.strerror}"]) from None
    except UnicodeDecodeError:
        raise WorldError([f"{path}: this is no UTF-8 text; a world is a TOML file"]) from None
    except tomllib.TOMLDecodeError as error:
        raise WorldError([f"{path}: this is no TOML: {error}"]) from None


def _unknown_types(data: dict[str, Any]) -> list[str]:
    """Return a line for every site of unknown type in a file that has other mistakes as well."""
    defined = [entry.get("name") for _, entry in _tables(data, "types")]
    known = [name for name in defined if isinstance(name, str)] or [t.name for t in TABLE_1]
    return [
        f"{key}[{number}].type = {entry['type']!r}: unknown type"
        f"{nearest_name(entry['type'], known)}; known: {', '.join(known)}"
        for key in ("objects", "spares")
        for number, entry in _tables(data, key)
        if isinstance(entry.get("type"), str) and entry["type"] not in known
    ]


def _tables(data: dict[str, Any], key: str) -> list[tuple[int, dict[str, Any]]]:
    value = data.get(key)
    entries = value if isinstance(value, list) else []
    return [(i, entry) for i, entry in enumerate(entries) if isinstance(entry, dict)]


def _table(header: str, entry: BaseModel) -> list[str]:
    pairs = [f"{key} = {_value(value)}" for key, value in entry if value is not None]
    return ["", header, *pairs]


def _value(value: Any) -> str:
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, tuple):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    if isinstance(value, int):
        return str(value)
    return repr(float(value))


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _value(name)

"""Settings that come from a user: typed, frozen, and refused with every mistake at once.

A mistake is one line: where, which key, its value, what is allowed, and the nearest known name.
The same lines come from a TOML file (`read_toml`) and from Python (`explain`).
"""

from __future__ import annotations

import json
import stat
import tomllib
from collections.abc import Callable, Iterator
from datetime import date, time
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from animat.errors import SettingsError
from animat.files.arguments import DEEPEST, as_python
from animat.files.validation_errors import mistakes, nearest, written

__all__ = [
    "Settings",
    "SettingsError",
    "explain",
    "nearest",
    "parse_text",
    "parse_toml",
    "read_toml",
    "validated",
    "values_within",
]

LARGEST_FILE = 1_000_000
"""Bytes; a settings file is written by hand, so a larger one is some other file."""

Key = tuple[str | int, ...]

Model = TypeVar("Model", bound=BaseModel)


class Settings(BaseModel):
    """A group of settings: frozen, no unknown keys, no coercion (1 is not true), all finite.

    Numbers of NumPy's count as Python's own. A validator that finds several mistakes raises
    ValueError with a line for each.

    Raises:
        SettingsError: with a line for each mistake.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    def __init__(self, /, **settings: Any) -> None:
        """Check the settings. Raises SettingsError."""
        try:
            super().__init__(**as_python(settings))
        except ValidationError as error:
            raise SettingsError(*mistakes(error, type(self))) from None

    # Inner settings go on to be checked by pydantic itself, which then knows where they stand.
    __init__.__pydantic_base_init__ = True  # pyright: ignore[reportFunctionMemberAccess]

    if not TYPE_CHECKING:

        @classmethod
        def model_validate(cls, obj: Any, **options: Any) -> Any:
            """Check settings. Raises SettingsError."""
            read = super().model_validate
            return _explained(cls, lambda: read(obj, **options))

        @classmethod
        def model_validate_json(cls, json_data: Any, **options: Any) -> Any:
            """Check settings in JSON. Raises SettingsError."""
            read = super().model_validate_json
            return _explained(cls, lambda: read(json_data, **options))

        def __setattr__(self, name: str, value: Any) -> None:
            """Refuse to change settings, which are shared. Raises SettingsError."""
            kind = type(self).__name__
            raise SettingsError(f"{kind}.{name}: settings are frozen; make a new {kind}")


def _explained(model: type[BaseModel], check: Callable[[], Any]) -> Any:
    try:
        return check()
    except ValidationError as error:
        raise SettingsError(*mistakes(error, model)) from None


def explain(error: ValidationError, model: type[BaseModel], where: str) -> SettingsError:
    """Return what pydantic found wrong with settings of `model`, each line led by `where`."""
    return SettingsError(*(f"{where}: {line}" for line in mistakes(error, model)))


def read_toml(path: Path | str, model: type[Model], largest: int = LARGEST_FILE) -> Model:
    """Return the settings in a TOML file of at most `largest` bytes.

    Raises:
        SettingsError: the file cannot be read, is empty, is no TOML, or has mistakes.
    """
    try:
        return validated(parse_toml(path, largest), model)
    except ValidationError as error:
        raise explain(error, model, str(path)) from None


def parse_toml(path: Path | str, largest: int = LARGEST_FILE) -> dict[str, Any]:
    """Return what a TOML file of at most `largest` bytes says, of whatever it is.

    Raises:
        SettingsError: the file cannot be read, is empty or is no TOML, or has a date.
    """
    data = parse_text(_text(Path(path), largest), str(path))
    if not data:
        raise SettingsError(f"{path}: is empty: it sets nothing")
    return data


def parse_text(text: str, where: str) -> dict[str, Any]:
    """Return what TOML says. Raises SettingsError, its lines led by `where`."""
    data = _parsed(text, where)
    if _is_deeper_than(data, DEEPEST):
        raise SettingsError(f"{where}: is nested too deeply: more than {DEEPEST} levels")
    dates = [
        f"{where}: key {written(key)} = {value}: is a date or a time; put text in quotes"
        for key, value in values_within(data)
        if isinstance(value, date | time)
    ]
    if dates:
        raise SettingsError(*dates)
    return data


def values_within(value: Any, key: Key = ()) -> Iterator[tuple[Key, Any]]:
    """Yield what is in a table or a list, also in inner ones, each with its key."""
    if isinstance(value, dict | list):
        for part, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield (*key, part), inner
            yield from values_within(inner, (*key, part))


def validated(data: dict[str, Any], model: type[Model]) -> Model:
    """Return what TOML says as settings of `model`. Raises pydantic's ValidationError."""
    # By way of JSON because there a list may become a tuple and a string a path, even strictly.
    return model.__pydantic_validator__.validate_json(json.dumps(data))


def opened(path: Path, what: str) -> IO[bytes]:
    """Return a regular file that is there to be read; `what` it should be is told of any other.

    A pipe, a socket or a device may never end, and opening one may wait for ever. Raises
    SettingsError if it cannot be opened.
    """
    try:
        mode = path.stat().st_mode
        file = path.open("rb") if stat.S_ISREG(mode) else None
    except FileNotFoundError:
        raise SettingsError(f"{path}: no such file") from None
    except OSError as error:
        raise SettingsError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise SettingsError(f"{str(path)!r}: is no path: {error}") from None
    if file is None:
        kind = "directory" if stat.S_ISDIR(mode) else "special file"
        raise SettingsError(f"{path}: is a {kind}, not a {what}")
    return file


def _text(path: Path, largest: int) -> str:
    with opened(path, "settings file") as file:
        try:
            content = file.read(largest + 1)
        except OSError as error:
            raise SettingsError(f"{path}: cannot be read: {error.strerror}") from None
    if len(content) > largest:
        raise SettingsError(
            f"{path}: is too large for a settings file: more than {largest / 1e6:g} MB"
        )
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise SettingsError(f"{path}: is not UTF-8 text (line {line})") from None


def _parsed(text: str, path: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise SettingsError(f"{path}: is nested too deeply: more than {DEEPEST} levels") from None
    except tomllib.TOMLDecodeError as error:
        last = text.rstrip().count("\n") + 1
        what = str(error).replace("(at end of document)", f"(at end of document, line {last})")
        raise SettingsError(f"{path}: is not TOML: {what}") from None
    except ValueError:
        raise SettingsError(f"{path}: has a whole number of too many digits") from None


def _is_deeper_than(data: dict[str, Any], levels: int) -> bool:
    """Look level by level: recursion would itself fail on what is too deep."""
    level: list[Any] = [data]
    for _ in range(levels):
        level = [
            inner
            for value in level
            for inner in (value.values() if isinstance(value, dict) else value)
            if isinstance(inner, dict | list)
        ]
    return bool(level)

"""Settings changed for one call, each as "key=value" (`--set`)."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from pydantic import BaseModel

from animat.files.settings import SettingsError, parse_text
from animat.files.validation_errors import plain, written
from animat.study.file.keys import Key, UnknownKeyError, put, read_key


def override(
    data: dict[str, Any],
    model: type[BaseModel],
    overrides: Sequence[str],
    tidy: Callable[[dict[str, Any]], None] = lambda _: None,
) -> tuple[list[Key], list[str]]:
    """Change what a file of `model` says; return the keys changed, and what could not be.

    A value is TOML, or a bare word, which is taken for a string. `tidy` brings the data into a form
    that keys can go into, before the first change and after each.
    """
    tidy(data)
    changed: list[Key] = []
    problems: list[str] = []
    for text in overrides:
        try:
            key, value = _key_and_value(text)
            put(data, model, key, value)
            tidy(data)
            changed.append(key)
        except UnknownKeyError as error:
            problems.append(f"--set {plain(text)}: {error}")
    return changed, problems


def led_by(line: str, leads: Iterable[tuple[str, Sequence[Key]]], otherwise: str) -> str:
    """Return where a mistake was made: in whose keys, or `otherwise`."""
    for where, keys in leads:
        for key in keys:
            if re.match(re.escape(f"key {written(key)}") + r"(?![\w-])", line):
                return where
    return otherwise


def _key_and_value(text: str) -> tuple[Key, Any]:
    """Return key and value of "key=value". Raises UnknownKeyError for what is not so."""
    name, equals, value = (part.strip() for part in text.partition("="))
    if not equals:
        raise UnknownKeyError("is not written key=value")
    key = read_key(name)
    try:
        given = parse_text(f"value = {value}\n", "")
    except SettingsError:
        given = {}
    if list(given) == ["value"]:
        return key, given["value"]
    if re.fullmatch(r"[^\s\"'\[\]{}#=,]+", value) and value.isprintable():
        return key, value
    raise UnknownKeyError("its value is neither TOML nor a bare word")

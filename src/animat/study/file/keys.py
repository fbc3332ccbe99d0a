"""Dotted keys: the name of a setting as a design or a shell gives it.

`mind.variables.nutrition.rate` is the key of one setting. A part that is no bare word stands in
quotes, as in TOML: `mind.variables."my own".rate`.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import Any, get_args, get_origin

from pydantic import BaseModel

from animat.files.settings import SettingsError
from animat.files.validation_errors import allowed_types, inside, is_model, nearest, plain, written
from animat.mind.mind import PAPER_BEHAVIOURS, PAPER_DRIVES
from animat.mind.physiology import PHYSIOLOGIES

Key = tuple[str, ...]

CHANGED: dict[Key, dict[str, Any]] = {
    ("mind", "variables"): {n: {} for n in PHYSIOLOGIES["excess"]},
    ("mind", "drives"): {n: each.model_dump(mode="json") for n, each in PAPER_DRIVES.items()},
    ("mind", "behaviours"): {
        n: each.model_dump(mode="json", exclude_none=True) for n, each in PAPER_BEHAVIOURS.items()
    },
}
"""Tables in which a key may go into what is not written down: the paper has it, as here."""

_PART = r"""[A-Za-z0-9_-]+|"[^"\\\x00-\x1f]*"|'[^'\x00-\x1f]*'"""


class UnknownKeyError(SettingsError):
    """A key that no setting has."""


@lru_cache(maxsize=4096)
def read_key(text: str) -> Key:
    """Return the parts of a dotted key. Raises UnknownKeyError for what is written like none."""
    if not re.fullmatch(rf"({_PART})(\.({_PART}))*", text):
        raise UnknownKeyError(f"{plain(text)} is no key; write it as mind.learning.cycles")
    return tuple(part.strip("\"'") for part in re.findall(_PART, text))


def put(data: dict[str, Any], model: type[BaseModel], key: Key, value: Any) -> None:
    """Set a key in what is to become settings of `model`, and leave all beside it as it was.

    Raises UnknownKeyError for a key that no setting has, with the nearest that one has.
    """
    node = data
    tables = _tables(model, key)
    for depth, (part, table) in enumerate(zip(key, tables, strict=True)):
        if table is None or not isinstance(node, dict):
            raise UnknownKeyError(f"{written(key[:depth])} is no table, so it has no keys")
        if part not in (known := _known(table, node, key, depth)):
            close = nearest(written(key), known_keys(data, model))
            raise UnknownKeyError(
                f"unknown key{close if 'did you mean' in close else nearest(part, known)}"
            )
        if depth == len(key) - 1:
            node[part] = value
            return
        if part not in node:
            node[part] = copy.deepcopy(_default(table, part, key[:depth]))
        node = node[part]


@lru_cache(maxsize=4096)
def _tables(model: type[BaseModel], key: Key) -> tuple[Any, ...]:
    """Return what each part of a key stands in, as the model has it; None for no table."""
    here: Any = model
    tables = []
    for part in key:
        tables.append(table_of(here))
        here = inside(tables[-1], part)
    return tuple(tables)


def known_keys(data: dict[str, Any], model: type[BaseModel]) -> list[str]:
    """Return the keys of all settings, also of what is in tables written in `data`."""
    return [written(key) for key in _keys(model, data, ())]


def annotation_of(model: type[BaseModel], key: Key) -> Any:
    """Return what a setting may be, as the model has it; None where no setting has the key."""
    return inside(_tables(model, key)[-1], key[-1]) if key else model


def table_of(annotation: Any) -> Any:
    """Return that option of an annotation which has keys, a model or a dict; None for none."""
    for option in allowed_types(annotation):
        if is_model(option) or get_origin(option) is dict:
            return option
    return None


def _known(table: Any, node: dict[str, Any], key: Key, depth: int) -> list[str]:
    """Return what part `depth` of a key may be, where `table` is what it stands in."""
    if is_model(table):
        return fields(table)
    if not _holds_tables(table):
        return [key[depth]]
    entries = _entries(node, key[:depth])
    # A whole table may be new, but a part of one that is not there would be a misspelling.
    may_be_new = depth == len(key) - 1 or key[:depth] == ("mind", "variables")
    return [*entries, key[depth]] if may_be_new else entries


@cache
def fields(model: type[BaseModel]) -> list[str]:
    """Return the settings of a model that can be written down."""
    return [name for name, field in model.model_fields.items() if not field.exclude]


def _holds_tables(table: Any) -> bool:
    return table_of(get_args(table)[1]) is not None


def _entries(node: dict[str, Any], key: Key) -> list[str]:
    return list(dict.fromkeys([*node, *CHANGED.get(key, ())]))


def _default(table: Any, part: str, key: Key) -> dict[str, Any]:
    """Return the table that is in force under a part of the table `key` where none is written."""
    if not is_model(table):
        return CHANGED.get(key, {}).get(part, {})
    default = table.model_fields[part].default
    if not default or not isinstance(default, dict):
        return {}
    return CHANGED.get((*key, part), default)


def _keys(annotation: Any, node: Any, key: Key) -> Iterator[Key]:
    table = table_of(annotation)
    node = node if isinstance(node, dict) else {}
    if table is None:
        yield key
    elif is_model(table):
        for name in fields(table):
            below = node.get(name, _default(table, name, key))
            yield from _keys(table.model_fields[name].annotation, below, (*key, name))
    elif _holds_tables(table):
        for name in _entries(node, key):
            below = node.get(name, _default(table, name, key))
            yield from _keys(get_args(table)[1], below, (*key, name))
    else:
        yield from ((*key, name) for name in node)
        yield key

"""Dotted keys: the name of a setting as a design, a shell or a message gives it.

`mind.variables.nutrition.rate` is the key of one setting. A part that is no bare word stands in
quotes, as in TOML: `mind.variables."my own".rate`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from animat.mind.physiology import PHYSIOLOGIES
from animat.mistakes import allowed_types, inside, is_model, nearest, plain, written

Key = tuple[str, ...]

_PART = r"""[A-Za-z0-9_-]+|"[^"\\\x00-\x1f]*"|'[^'\x00-\x1f]*'"""

VARIABLES: Key = ("mind", "variables")
"""The one table in which a key may name what is not written down: it is in the physiology."""


class UnknownKeyError(ValueError):
    """A key that is none."""


def read_key(text: str) -> Key:
    """Return the parts of a dotted key. Raises UnknownKeyError."""
    if not re.fullmatch(rf"({_PART})(\.({_PART}))*", text):
        raise UnknownKeyError(f"{plain(text)} is no key; write it as mind.learning.cycles")
    return tuple(part[1:-1] if part[0] in "\"'" else part for part in re.findall(_PART, text))


def put(data: dict[str, Any], model: type[BaseModel], key: Key, value: Any) -> None:
    """Set a key in what is to become settings of `model`, leaving all beside it as it was.

    Raises UnknownKeyError for a key that no setting has, with the nearest that one has.
    """
    here: Any = model
    node: Any = data
    for depth, part in enumerate(key):
        below = _entered(data, model, here, node, key, depth)
        if depth == len(key) - 1:
            node[part] = value
            return
        if part not in node:
            node[part] = _default(here, part)
        node, here = node[part], below
        if not isinstance(node, dict):
            raise UnknownKeyError(f"{written(key[: depth + 1])} is no table, so it has no keys")


def annotation_of(model: type[BaseModel], key: Key) -> Any:
    """Return what a setting may be, as the model has it; None where no setting has the key."""
    here: Any = model
    for part in key:
        here = inside(_table(here), part)
    return here


def known_keys(data: dict[str, Any], model: type[BaseModel]) -> list[str]:
    """Return the keys of all settings, those of the tables that are written in `data` as well."""
    return [written(key) for key in _keys(model, data, ())]


def _entered(
    data: dict[str, Any], model: type[BaseModel], here: Any, node: dict[str, Any], key: Key, d: int
) -> Any:
    """Return what stands under part `d` of a key. Raises UnknownKeyError where nothing can."""
    table = _table(here)
    known: list[str] = []
    if is_model(table):
        known = list(table.model_fields)
    elif _holds_tables(table):
        known = _entries(node, key[:d])
        if d == len(key) - 1 or key[:d] == VARIABLES:
            known.append(key[d])
    elif table is not None:
        known = [key[d]]
    if key[d] not in known:
        close = nearest(written(key), known_keys(data, model))
        if "did you mean" not in close:
            close = nearest(key[d], known)
        raise UnknownKeyError(f"unknown key{close}")
    return inside(table, key[d])


def _table(annotation: Any) -> Any:
    """Return the branch of an annotation that holds keys, None if it has none."""
    for option in allowed_types(annotation):
        if is_model(option) or getattr(option, "__origin__", None) is dict:
            return option
    return None


def _holds_tables(table: Any) -> bool:
    return table is not None and not is_model(table) and is_model(_table(table.__args__[1]))


def _entries(node: dict[str, Any], key: Key) -> list[str]:
    return list(dict.fromkeys([*node, *(PHYSIOLOGIES["excess"] if key == VARIABLES else ())]))


def _default(holder: Any, part: str) -> dict[str, Any]:
    """Return the table that is in force where none is written."""
    table = _table(holder)
    if not is_model(table):
        return {}
    default = table.model_fields[part].get_default(call_default_factory=True)
    if not isinstance(default, dict):
        return {}
    return {
        name: each.model_dump(mode="json", exclude_none=True)
        if isinstance(each, BaseModel)
        else each
        for name, each in default.items()
    }


def _keys(annotation: Any, node: Any, key: Key) -> Iterator[Key]:
    table = _table(annotation)
    node = node if isinstance(node, dict) else {}
    if is_model(table):
        for name in table.model_fields:
            below = node.get(name, _default(table, name))
            yield from _keys(table.model_fields[name].annotation, below, (*key, name))
    elif _holds_tables(table):
        for name in _entries(node, key):
            yield from _keys(table.__args__[1], node.get(name), (*key, name))
    elif table is not None:
        yield key
        yield from ((*key, name) for name in node)
    else:
        yield key

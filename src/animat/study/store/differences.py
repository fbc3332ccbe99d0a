"""In what two studies differ, key by key."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from animat.files.validation_errors import plain, written

NOTHING = "nothing"


def differences(there: Mapping[str, Any], here: Mapping[str, Any]) -> list[str]:
    """Return a line for every key that has not the same value in both, such as
    `steps = 1000 there and 300000 here`."""
    old, new = dict(_flat(there)), dict(_flat(here))
    return [
        f"{written(key)} = {_shown(old, key)} there and {_shown(new, key)} here"
        for key in dict.fromkeys([*old, *new])
        if key not in old or key not in new or old[key] != new[key]
    ]


def _flat(table: Mapping[str, Any], above: tuple[str, ...] = ()) -> list[tuple[Any, Any]]:
    """Return the keys of all that is no table, each with its value."""
    found = []
    for name, value in table.items():
        key = (*above, name)
        found += _flat(value, key) if isinstance(value, Mapping) and value else [(key, value)]
    return found


def _shown(values: Mapping[Any, Any], key: Any) -> str:
    return plain(values[key]) if key in values else NOTHING

"""Arguments from Python: taken as plain Python values, or refused in one line.

A whole number is what `operator.index` takes, NumPy's included; a real number is that, or what
Python counts among the real numbers. Booleans, Python's and NumPy's, are neither.
"""

from __future__ import annotations

import math
import numbers
import operator
import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from animat.errors import Error, SettingsError
from animat.files.validation_errors import brief

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Kind = TypeVar("Kind")

MOST_64 = (1 << 64) - 1
"""The largest seed."""

MOST_63 = (1 << 63) - 1
"""The largest index of a life: tables hold it in 64 bits, one of them for the sign."""

MOST_THREADS = 4_096

LONGEST_NAME = 255
"""Bytes of the name of a file."""

DEEPEST = 32
"""Tables and lists inside one another; no settings come near it."""


def number(value: Any) -> bool | int | float | None:
    """Return a number or a boolean as one of Python's own, None for anything else."""
    if isinstance(value, bool) or type(value) in {int, float}:
        return value
    if type(value).__module__ == "numpy" and type(value).__name__ in {"bool", "bool_"}:
        return bool(value)
    with suppress(Exception):  # whatever an object of the user's may raise
        return operator.index(value)
    if isinstance(value, numbers.Real):
        with suppress(Exception):
            return float(value)
    return None


def as_python(value: Any, depth: int = DEEPEST) -> Any:
    """Return numbers and texts, also those in tables and lists, as Python's own."""
    kind = type(value)
    if kind is dict and depth:
        return {as_python(k, 0): as_python(v, depth - 1) for k, v in value.items()}
    if kind in {list, tuple} and depth:
        return kind(as_python(each, depth - 1) for each in value)
    if isinstance(value, str):
        return value if kind is str else str.__str__(value)
    found = number(value)
    return value if found is None else found


def whole(
    name: str,
    value: Any,
    low: int = 0,
    high: int | None = None,
    error: type[Error] = SettingsError,
) -> int:
    """Return an argument as an int from `low` to `high`. Raises `error`."""
    found = number(value)
    if (
        isinstance(found, bool)
        or not isinstance(found, int)
        or not (low <= found <= (found if high is None else high))
    ):
        to = "" if high is None else f" to {_bound(high)}"
        raise error(f"{name} = {brief(value)}; allowed are whole numbers from {_bound(low)}{to}")
    return found


def real(
    name: str,
    value: Any,
    low: float = -math.inf,
    high: float = math.inf,
    error: type[Error] = SettingsError,
) -> float:
    """Return an argument as a finite float from `low` to `high`. Raises `error`."""
    found = number(value)
    if found is not None and not isinstance(found, bool):
        with suppress(OverflowError):
            found = float(found)
            if math.isfinite(found) and low <= found <= high:
                return found
    least = "" if low == -math.inf else f" from {low:g}"
    most = "" if high == math.inf else f" to {high:g}"
    raise error(f"{name} = {brief(value)}; allowed are finite numbers{least}{most}")


def instance(name: str, value: Any, kind: type[Kind], error: type[Error] = SettingsError) -> Kind:
    """Return an argument that is of a kind. Raises `error`."""
    if isinstance(value, kind):
        return value
    raise error(f"{name} {_is(value)}; give one of type {kind.__name__}")


def sequence(
    name: str, value: Any, kind: type[Kind], error: type[Error] = SettingsError
) -> tuple[Kind, ...]:
    """Return an argument that is a list or tuple of a kind. Raises `error`."""
    if isinstance(value, str) or not isinstance(value, Sequence):
        raise error(f"{name} {_is(value)}; give a list, its entries of type {kind.__name__}")
    return tuple(instance(f"{name}[{n}]", each, kind, error) for n, each in enumerate(value))


def reals(name: str, value: Any, error: type[Error] = SettingsError) -> NDArray[np.float64]:
    """Return a copy of an argument that holds finite real numbers, as an array. Raises `error`."""
    import numpy as np

    with suppress(Exception):  # what NumPy raises of ragged lists, and objects of the user's
        if np.asarray(value).dtype.kind in "iuf":
            copy = np.array(value, np.float64, order="C")
            if np.isfinite(copy).all():
                return copy
    raise error(f"{name} {_is(value)}; give an array of finite numbers")


def together(error: type[Error], *checks: Callable[[], Any]) -> list[Any]:
    """Return what checks return. Raises `error` with all that any of them has found."""
    values, problems = [], []
    for check in checks:
        try:
            values.append(check())
        except Error as found:
            problems += found.problems
    if problems:
        raise error(*problems)
    return values


def boolean(name: str, value: Any, error: type[Error] = SettingsError) -> bool:
    """Return an argument as a bool. Raises `error`."""
    found = number(value)
    if isinstance(found, bool):
        return found
    raise error(f"{name} = {brief(value)}; allowed are True and False")


def callback(name: str, value: Any, error: type[Error] = SettingsError) -> Any:
    """Return an argument that can be called, or None. Raises `error`."""
    if value is None or callable(value):
        return value
    raise error(f"{name} {_is(value)}; give a function")


def path(name: str, value: Any) -> Path:
    """Return an argument as a path. Raises SettingsError for what is none."""
    if not isinstance(value, str | Path):
        raise SettingsError(f"{name} {_is(value)}; give a path")
    with suppress(ValueError):
        parts = os.fsencode(value).split(b"/")
        if not any(b"\0" in part or len(part) > LONGEST_NAME for part in parts):
            return Path(value)
    raise SettingsError(f"{name} = {brief(str(value))}; it cannot be a path")


def file(name: str, value: Any) -> Path:
    """Return an argument as the path of a file to be written. Raises SettingsError."""
    found = path(name, value)
    if not found.name:
        raise SettingsError(f"{name} = {brief(str(value))}; give the name of a file")
    return found


def _is(value: Any) -> str:
    return "is None" if value is None else f"is of type {type(value).__name__}"


def _bound(limit: int) -> str:
    """Return a limit as a reader knows it."""
    for less, told in ((0, ""), (1, " - 1")):
        power = limit + less
        if power > 1 << 40 and power & (power - 1) == 0:
            return f"2^{power.bit_length() - 1}{told}"
    return f"{limit:,}"

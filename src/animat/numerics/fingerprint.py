"""The fingerprint of a function: equal fingerprints, equal results, in any process on any machine.

The identity by which machine code is kept (`compiled.py`) is stricter than that: it differs between
versions of Python and of this package, and a helper compiled by Numba's own decorator has another
one in every process.
"""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable, Iterator
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

import numpy as np
from numba.core.dispatcher import Dispatcher

from animat.numerics.compiled import PLAIN
from animat.settings import SettingsError

OURS = Path(__file__).parents[1]
"""Functions of this package go by their names: the version of the engine stands for the rest."""


def fingerprint(function: Callable[..., Any]) -> str:
    """Return the SHA-256, in hexadecimal, of what a function computes by.

    It covers the source file of the function and of every function it calls, and the plain values
    and arrays they take from around them. Raises SettingsError for a function that takes something
    else from a function around it.
    """
    total = hashlib.sha256()
    for part in _parts(function, set()):
        total.update(len(part).to_bytes(8, "little") + part)
    return total.hexdigest()


def _parts(function: Any, seen: set[Any]) -> Iterator[bytes]:
    function = getattr(function, "py_func", function)
    source = Path(inspect.getsourcefile(function) or "").absolute()
    if function in seen:
        return
    seen.add(function)
    yield function.__qualname__.encode()
    if source.is_relative_to(OURS):
        yield function.__module__.encode()
        return
    yield source.read_bytes().replace(b"\r\n", b"\n") if source.is_file() else b""
    for name, value in sorted(_taken(function), key=lambda taken: taken[0]):
        if isinstance(value, Dispatcher) or inspect.isfunction(value):
            yield name.encode()
            yield from _parts(value, seen)
        elif isinstance(value, np.ndarray | np.generic):
            yield f"{name} {value.dtype.str} {value.shape}".encode()
            yield np.ascontiguousarray(value).tobytes()
        elif isinstance(value, (*PLAIN, tuple)):
            yield f"{name} {value!r}".encode()
        elif name in function.__code__.co_freevars:
            raise SettingsError(
                f"{function.__name__} takes more from the function around it than numbers, texts,"
                " arrays and functions, so that nobody can tell whether it has changed"
            )


def _taken(function: Any) -> Iterator[tuple[str, Any]]:
    """Yield what a function takes from around it, and from the modules it names."""
    cells = zip(function.__code__.co_freevars, function.__closure__ or (), strict=True)
    for name, cell in cells:
        yield name, cell.cell_contents
    names = list(dict.fromkeys(_names(function.__code__)))
    for name in names:
        value = function.__globals__.get(name)
        if isinstance(value, ModuleType):
            for inner in names:
                if hasattr(value, inner):
                    yield f"{name}.{inner}", getattr(value, inner)
        elif name in function.__globals__:
            yield name, value


def _names(code: CodeType) -> Iterator[str]:
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)

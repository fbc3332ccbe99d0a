"""What a function takes from around it: globals and enclosed values, and attributes of modules.

Functions, classes and modules of Python, NumPy, Numba and this package go by their names.
"""

from __future__ import annotations

import builtins
import dis
import os
import sys
from collections.abc import Iterator
from enum import Enum, EnumMeta
from functools import lru_cache
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any, NamedTuple

import numba
import numpy as np
from numba.core.dispatcher import Dispatcher
from numba.np.ufunc.dufunc import DUFunc

MISSING: Any = object()

STANDARD = os.path.dirname(os.__file__) + os.sep  # noqa: PTH120
PACKAGES = ("site-packages", "dist-packages")
LIBRARIES = tuple(
    str(folder) + os.sep
    for folder in (
        Path(__file__).parents[1],
        *(Path(str(one.__file__)).parent for one in (np, numba)),
    )
)

GLOBAL = {"LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS"}
ENCLOSING = {"LOAD_DEREF", "LOAD_CLASSDEREF", "LOAD_FROM_DICT_OR_DEREF"}
ATTRIBUTE = {"LOAD_ATTR", "LOAD_METHOD"}

PLAIN = (bool, int, float, complex, str, bytes, type(None), tuple, CodeType)
WALKED = (*PLAIN, np.ndarray, np.generic, np.dtype, list, dict, set, frozenset, range, slice)
WALKED = (*WALKED, Enum, EnumMeta)
"""The values that have an identity of their own, beside functions and what libraries name."""


class Taken(NamedTuple):
    """A value that a function takes from around it: by which names it gets there, and from where.

    `rest` are the attributes that it takes of the value where that is a module of a library.
    """

    path: tuple[str, ...]
    enclosing: bool
    value: Any
    rest: tuple[str, ...] = ()


def python_function(value: Any) -> FunctionType | None:
    """Return the Python function behind a value; None if there is none."""
    if isinstance(value, Dispatcher):
        value = value.py_func
    elif isinstance(value, DUFunc):
        value = getattr(value, "_dispatcher").py_func  # noqa: B009
    return value if isinstance(value, FunctionType) else None


def in_library(file: str) -> bool:
    """Tell whether a file belongs to Python, NumPy, Numba or this package."""
    if file.startswith(LIBRARIES):
        return True
    standard = file.startswith((STANDARD, "<frozen "))
    return standard and not any(name in file for name in PACKAGES)


def library_name(value: Any) -> str | None:
    """Return the name by which a library has a module, a function or a class; None if none does."""
    if isinstance(value, ModuleType):
        return value.__name__ if is_library(value) else None
    if isinstance(value, np.ufunc) and not isinstance(value, DUFunc):
        name = value.__name__
        return f"numpy.{name}" if getattr(np, name, None) is value else None
    module, name = getattr(value, "__module__", None), getattr(value, "__qualname__", None)
    found: Any = sys.modules.get(module) if isinstance(module, str) else None
    if found is None or not isinstance(name, str) or not is_library(found):
        return None
    for part in name.split("."):
        found = getattr(found, part, None)
    same = getattr(found, "py_func", found) is getattr(value, "py_func", value)
    return f"{module}.{name}" if same else None


def taken(function: FunctionType) -> Iterator[Taken]:
    """Yield what a function takes from around it, in an order that is the same in every process.

    A module that is not only asked for attributes (it may be handed on under another name) is asked
    for every name in the function.
    """
    code = function.__code__
    cells = dict(zip(code.co_freevars, function.__closure__ or (), strict=True))
    references, names = _references(code)
    for enclosing, name, chain in references:
        if enclosing:
            value = _contents(cells.get(name))
        else:
            value = function.__globals__.get(name, getattr(builtins, name, MISSING))
        if value is not MISSING:
            yield from _along(Taken((name,), enclosing, value), chain, names, ())


def _along(
    start: Taken, chain: tuple[str, ...], names: tuple[str, ...], inside: tuple[ModuleType, ...]
) -> Iterator[Taken]:
    value = start.value
    is_module = isinstance(value, ModuleType) and not is_library(value)
    if is_module and not chain:
        yield start
        for name in names if value not in inside else ():
            found = _attribute(value, name)
            if found is not MISSING:
                further = start._replace(path=(*start.path, name), value=found)
                yield from _along(further, (), names, (*inside, value))
    elif chain and (is_module or not _has_identity(value)):
        found = _attribute(value, chain[0])
        if found is not MISSING:
            further = start._replace(path=(*start.path, chain[0]), value=found)
            yield from _along(further, chain[1:], names, inside)
        else:
            yield start
    else:
        yield start._replace(rest=chain)


@lru_cache(maxsize=4096)
def _references(
    code: CodeType,
) -> tuple[list[tuple[bool, str, tuple[str, ...]]], tuple[str, ...]]:
    """Return the names that code takes from around it, with the attributes it asks of them.

    And all names and texts in it.
    """
    references: set[tuple[bool, str, tuple[str, ...]]] = set()
    names: set[str] = set()
    codes = [code]
    for each in codes:
        codes += [constant for constant in each.co_consts if isinstance(constant, CodeType)]
        names.update(each.co_names, (one for one in each.co_consts if isinstance(one, str)))
        steps = list(dis.get_instructions(each))
        for n, step in enumerate(steps):
            if step.opname in GLOBAL or step.opname in ENCLOSING:
                end = n + 1
                while steps[end].opname in ATTRIBUTE:
                    end += 1
                chain = tuple(str(after.argval) for after in steps[n + 1 : end])
                references.add((step.opname in ENCLOSING, str(step.argval), chain))
    return sorted(references), tuple(sorted(names))


def _has_identity(value: Any) -> bool:
    return (
        isinstance(value, WALKED)
        or python_function(value) is not None
        or library_name(value) is not None
    )


def is_library(module: ModuleType) -> bool:
    """Tell whether a module belongs to Python, NumPy, Numba or this package."""
    file = getattr(module, "__file__", None)
    if file is None:
        return module.__name__ in sys.builtin_module_names
    return in_library(file)


def _attribute(value: Any, name: str) -> Any:
    try:
        return getattr(value, name, MISSING)
    except Exception:  # whatever a property of the user's raises
        return MISSING


def _contents(cell: Any) -> Any:
    try:
        return MISSING if cell is None else cell.cell_contents
    except ValueError:  # not yet filled
        return MISSING

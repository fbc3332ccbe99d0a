"""A function compiled once more, with every index checked: its own and those of what it calls."""

from __future__ import annotations

from collections.abc import Iterator
from types import CellType, CodeType, FunctionType, ModuleType
from typing import Any

import numba
from numba.core.dispatcher import Dispatcher

from animat.numerics.inlined import InlinedDispatcher, inlined


class SelfCallError(ValueError):
    """A function calls itself, directly or through others."""


def checked(function: Any, twins: dict[Any, Any]) -> Any:
    """Return the twin of a compiled function that raises IndexError instead of leaving an array.

    `twins` takes in the twins of all functions it calls, by the function. The function itself, and
    what was compiled of it, stays as it is. Raises SelfCallError.
    """
    if not isinstance(function, Dispatcher):
        return function
    source: Any = function.py_func
    if source in twins:
        if twins[source] is None:
            raise SelfCallError(source.__name__)
        return twins[source]
    twins[source] = None
    names = set(_names(source.__code__))
    around = dict(source.__globals__)
    around.update({n: _with_twins(around[n], names, twins) for n in names & around.keys()})
    cells = tuple(
        CellType(_with_twins(cell.cell_contents, names, twins)) for cell in source.__closure__ or ()
    )
    copy = FunctionType(source.__code__, around, source.__name__, source.__defaults__, cells)
    copy.__kwdefaults__ = source.__kwdefaults__
    copy.__qualname__, copy.__module__ = source.__qualname__, source.__module__
    options: dict[str, Any] = {**function.targetoptions, "boundscheck": True}
    if isinstance(function, InlinedDispatcher):
        twin: Any = inlined(copy, **options)
    else:
        options.pop("nopython", None)
        twin = numba.njit(**options)(copy)
    original: Any = function
    twin._set_uuid(f"checked {original._uuid}")
    twins[source] = twin
    return twin


def _with_twins(
    value: Any, names: set[str], twins: dict[Any, Any], within: tuple[ModuleType, ...] = ()
) -> Any:
    """Return the twin of what a function takes from around it, where it has one."""
    if isinstance(value, Dispatcher):
        return checked(value, twins)
    if not isinstance(value, ModuleType) or value in within:
        return value
    changed = {}
    for name in names & vars(value).keys():
        inner = vars(value)[name]
        if (twin := _with_twins(inner, names, twins, (*within, value))) is not inner:
            changed[name] = twin
    if not changed:
        return value
    copy = ModuleType(value.__name__)
    vars(copy).update({**vars(value), **changed})
    return copy


def _names(code: CodeType) -> Iterator[str]:
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)

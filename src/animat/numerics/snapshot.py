"""A custom function, compiled together with everything it computes by as that is now.

Numba reads globals once, when it compiles, and a compiled helper keeps its machine code. So a
function is copied before it is compiled, and with it the compiled functions that it calls, the
arrays and the modules that it names: what is rebound, reloaded or changed in place later is not
seen by the copy, and the next copy, of another identity, is compiled anew. Functions of equal
identity and the same files have one copy.
"""

from __future__ import annotations

from types import CellType, FunctionType, ModuleType
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numba.core import config, utils
from numba.core.dispatcher import Dispatcher
from numba.core.registry import cpu_target
from numba.np.ufunc.dufunc import DUFunc

from animat.errors import SettingsError
from animat.numerics.compiled import compiled
from animat.numerics.identity import STEP_OPTIONS, Identity, identity
from animat.numerics.taken import in_library, library_name, python_function, taken

_SNAPSHOTS: dict[Identity, Any] = {}
_IDENTITIES: WeakKeyDictionary[Any, Identity] = WeakKeyDictionary()


def snapshot(function: Any) -> Any:
    """Return a custom function compiled for a step, as it and all it computes by are now.

    A function that cannot be identified is compiled anew each time. With `NUMBA_DISABLE_JIT=1` it
    is returned as it is.
    """
    plain = python_function(function)
    if plain is None or getattr(config, "DISABLE_JIT", False):
        return plain or function
    if isinstance(function, Dispatcher) and library_name(function) is not None:
        return function
    found = identity(plain)
    made = _SNAPSHOTS.get(found) if found.unknown is None else None
    if made is None:
        made = _Copies().compiled(plain, None)
        _IDENTITIES[made] = found
        if found.unknown is None:
            made._set_uuid(f"{plain.__qualname__}:{found.text}")
            _SNAPSHOTS[found] = made
    return made


def lasting_identity(function: Any) -> str:
    """Return the identity of a custom function, equal in every process.

    Raises SettingsError where it computes by something that cannot be identified.
    """
    found = _identity_of(function)
    if found.unknown is not None:
        raise SettingsError(
            f"{function.__name__} depends on {found.unknown}: whether that changes cannot be told;"
            " use numbers, text, tuples, NumPy arrays and functions"
        )
    return found.text


def cache_key(function: Any) -> str | None:
    """Return what machine code of a compiled function is kept under; None if it is not kept."""
    found = _IDENTITIES.get(function)
    if found is not None:
        return None if found.unknown else function._uuid
    return function._uuid if function in STEP_OPTIONS else None


def share_identity(twin: Any, function: Any) -> None:
    """Give a function compiled otherwise from a snapshot the identity of that snapshot."""
    _IDENTITIES[twin] = _identity_of(function)


def source_files(function: Any) -> set[str]:
    """Return the source files of a custom function and of all functions it calls.

    Without those of installed packages.
    """
    files = _identity_of(function).files
    return {file for file in files if not (in_library(file) or "-packages" in file)}


def _identity_of(function: Any) -> Identity:
    return _IDENTITIES.get(function) or identity(function)


class _Copies:
    """Copies of functions, modules and arrays; what is met twice is copied once."""

    def __init__(self) -> None:
        self.functions: dict[int, Any] = {}
        self.modules: dict[int, ModuleType] = {}

    def compiled(self, function: FunctionType, like: Any) -> Any:
        """Return a compiled copy of a function, with the options of `like`, or of a step."""
        if id(function) in self.functions:
            return self.functions[id(function)]
        code = function.__code__
        around: dict[str, Any] = {"__name__": utils._dynamic_modname}
        cells = {name: CellType() for name in code.co_freevars}
        copy = FunctionType(code, around, function.__name__, None, tuple(cells.values()))
        copy.__qualname__ = function.__qualname__
        copy.__defaults__ = self.value(function.__defaults__)
        kwdefaults = function.__kwdefaults__ or {}
        copy.__kwdefaults__ = {name: self.value(one) for name, one in kwdefaults.items()}
        made = self.functions[id(function)] = _compiled_like(like, copy)
        there = dict(zip(code.co_freevars, function.__closure__ or (), strict=True))
        for found in taken(function):
            name = found.path[0]
            if found.enclosing:
                whole = there[name].cell_contents
                cells[name].cell_contents = self._along(whole, found.path[1:])
            elif name in function.__globals__:
                around[name] = self._along(function.__globals__[name], found.path[1:])
        if like is not None and not getattr(like, "_can_compile", True):
            for signature in like.overloads:
                made.compile(signature)
            made.disable_compile()
        return made

    def value(self, value: Any) -> Any:
        """Return a copy of a value, itself where nothing can change it."""
        function = python_function(value)
        if function is not None and library_name(value) is None:
            is_compiled = not isinstance(value, FunctionType) or _is_known_to_numba(value)
            return self.compiled(function, value) if is_compiled else value
        if isinstance(value, np.memmap):
            return np.array(value)
        if isinstance(value, np.ndarray):
            return value.copy(order="K")
        if isinstance(value, np.void):
            return value.copy()
        if isinstance(value, tuple):
            copies = [self.value(one) for one in value]
            if any(one is not copy for one, copy in zip(value, copies, strict=True)):
                return type(value)(*copies) if hasattr(value, "_fields") else type(value)(copies)
        return value

    def _along(self, value: Any, path: tuple[str, ...]) -> Any:
        """Return a copy of a value; of a module, one that has what is found along a path."""
        if not isinstance(value, ModuleType) or library_name(value) is not None:
            return self.value(value)
        if id(value) not in self.modules:
            # Under this name nobody tries to import it again.
            self.modules[id(value)] = ModuleType(f"a copy of {value.__name__}")
        module = self.modules[id(value)]
        if path:
            setattr(module, path[0], self._along(getattr(value, path[0]), path[1:]))
        return module


def _compiled_like(like: Any, function: FunctionType) -> Any:
    if like is None or isinstance(like, FunctionType) or like in STEP_OPTIONS:
        return compiled(function)
    if isinstance(like, DUFunc):
        return DUFunc(function, like.identity, targetoptions=like.targetoptions)
    return type(like)(
        function,
        locals=like.locals,
        targetoptions=like.targetoptions,
        pipeline_class=like._compiler.pipeline_class,
    )


def _is_known_to_numba(function: FunctionType) -> bool:
    """Tell whether a plain function can be called by compiled ones (`register_jitable`)."""
    context: Any = cpu_target.typing_context
    context.refresh()
    return context._lookup_global(function) is not None

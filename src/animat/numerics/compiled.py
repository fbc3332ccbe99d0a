"""How the functions of a step are compiled, and how their machine code is kept on disk.

Two decorators. `compiled` is for every function that runs inside a step. `kernel` is for the few
functions that Python calls: they hold the loop over steps, and their machine code is cached.

The cache must never serve stale code, and must serve a mind whose functions are the user's own.
Numba looks only at the file of the cached function and at the identity of the functions handed to
it, and that identity is random in every process. So every function compiled here gets an identity
made of its name and its source, and a cached kernel is stamped with the source of every layer that
compiles anything.

Bits: no fast maths and no contraction to fused multiply-add, so that a result does not depend on
the processor; NumPy's error model, so that no step can raise. No run-time for memory, so that
nothing in a step can allocate: a function that tries does not compile. Everything is inlined into
its kernel: to hand a world's arrays from function to function by value costs more than the step.
"""

from __future__ import annotations

import hashlib
import inspect
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

import numba
import numpy as np
from numba.core import utils
from numba.core.caching import FunctionCache
from numba.core.dispatcher import Dispatcher
from numba.core.event import Event, Listener, install_listener

Function = TypeVar("Function", bound=Callable[..., Any])

PLAIN = (bool, int, float, str, type(None))

COMPILING_LAYERS = ("numerics", "world", "robot", "mind", "life")
"""The packages that hold compiled functions; a change of another one compiles nothing anew."""

NO_PLACE = "no directory for compiled code can be written; set NUMBA_CACHE_DIR to one that can"

OPTIONS = {"nogil": True, "error_model": "numpy", "fastmath": False, "_nrt": False}

# A function of a user's file belongs to no module that can be imported, so Numba counts it to a
# module that stands in. Cached code asks for that by its name, under which nothing is found.
sys.modules.setdefault(utils._dynamic_modname, utils._dynamic_module)


def compiled(function: Function) -> Function:
    """Compile a function of a step; with `NUMBA_DISABLE_JIT=1` it stays plain Python."""
    return _identified(numba.njit(forceinline=True, **OPTIONS)(function), function)


def kernel(function: Function) -> Function:
    """Compile a function that Python calls, and keep its machine code on disk.

    Raises SettingsError where there is no place to keep it.
    """
    try:
        dispatcher: Any = numba.njit(cache=True, **OPTIONS)(function)
    except RuntimeError:  # numba found none of its places writable
        from animat.settings import SettingsError

        raise SettingsError(NO_PLACE) from None
    if dispatcher is not function:
        kept = dispatcher._cache._cache_file
        kept._source_stamp = engine_stamp()
        kept._load_index = _or(dict, kept._load_index)
        kept._load_data = _or(lambda: None, kept._load_data)
        kept.save = _or(lambda: None, kept.save)  # on a full disk, the next start compiles again
    return _identified(dispatcher, function)


def _or(otherwise: Callable[[], Any], load: Callable[..., Any]) -> Callable[..., Any]:
    """Let what is kept count as missing where it cannot be read, so that it is compiled anew.

    It may be torn; and it names the users' functions it was compiled with, and their modules. One
    that was renamed or deleted since, or could be imported only there, must not stop a kernel.
    """

    def load_or_not(*names: str) -> Any:
        try:
            return load(*names)
        except Exception:  # unpickling raises whatever the user's file does
            return otherwise()

    return load_or_not


@cache
def engine_stamp() -> str:
    """Return the SHA-256 of every source file of the layers that compile, in hexadecimal."""
    root = Path(__file__).parents[1]
    digest = hashlib.sha256()
    for layer in COMPILING_LAYERS:
        for path in sorted((root / layer).rglob("*.py")):
            digest.update(str(path.relative_to(root)).encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()


def _identified(dispatcher: Any, function: Callable[..., Any]) -> Any:
    """Give a compiled function an identity that a later process finds again."""
    if dispatcher is not function:
        identity = _identity(function)
        if identity is not None:
            dispatcher._set_uuid(identity)
    return dispatcher


def _identity(function: Callable[..., Any]) -> str | None:
    """Return a text that is equal only for functions that compute the same, or None.

    It covers the whole source file, for what the function calls there, the compiled functions that
    the file imports, and the plain values the function takes from around it. None if it takes
    something else from an enclosing function.
    """
    digest = hashlib.sha256(function.__code__.co_code)
    source = Path(inspect.getsourcefile(function) or "")
    digest.update(source.read_bytes() if source.is_file() else repr(function.__code__).encode())
    for cell in function.__closure__ or ():
        if not isinstance(cell.cell_contents, PLAIN):
            return None
        digest.update(repr(cell.cell_contents).encode())
    for name, value in _taken(function):
        if isinstance(value, Dispatcher):
            digest.update(f"{name}={getattr(value, '_uuid')}".encode())  # noqa: B009
        elif isinstance(value, (*PLAIN, tuple, np.generic)):
            digest.update(f"{name}={value!r}".encode())
    return f"{function.__module__}.{function.__qualname__}:{digest.hexdigest()}"


def _taken(function: Callable[..., Any]) -> Iterator[tuple[str, Any]]:
    """Yield what a function may take from its module and from the modules that one imports."""
    names = function.__code__.co_names
    # A copy, because another thread may be importing.
    for name, value in dict(function.__globals__).items():
        if name in names or isinstance(value, Dispatcher):
            yield name, value
        if name in names and isinstance(value, ModuleType):
            for inner in names:
                yield f"{name}.{inner}", getattr(value, inner, None)


class _Once(Listener):
    """Call a function when the first kernel is compiled; what is not a kernel is small."""

    def __init__(self, tell: Callable[[], None]) -> None:
        self.tell: Callable[[], None] | None = tell

    def on_start(self, event: Event) -> None:
        compiled_now: Any = event.data
        if self.tell and isinstance(compiled_now["dispatcher"]._cache, FunctionCache):
            tell, self.tell = self.tell, None
            tell()

    def on_end(self, event: Event) -> None:
        pass


@contextmanager
def announcing(tell: Callable[[], None]) -> Iterator[None]:
    """Call `tell` once if a kernel is compiled meanwhile, rather than read from disk."""
    with install_listener("numba:compile", _Once(tell)):
        yield

"""How the functions of a step are compiled, and how their machine code is kept on disk.

Two decorators. `compiled` is for every function that runs inside a step. `kernel` is for the few
functions that Python calls: they hold the loop over steps, and their machine code is cached.

The cache must never serve stale code, and must serve a mind whose functions are the user's own.
Numba looks only at the file of the cached function and at the identity of the functions handed to
it, and that identity is random in every process. So every function compiled here goes by its name,
a custom one by what it computes by (`identity.py`, `snapshot.py`), and a cached kernel is stamped
with the source of every layer that compiles anything.

Bits: no fast maths and no contraction to fused multiply-add, so that a result does not depend on
the processor; NumPy's error model, so that no step can raise. No run-time for memory, so that
nothing in a step can allocate: a function that tries does not compile. Everything is inlined into
its kernel: to hand a world's arrays from function to function by value costs more than the step.
"""

from __future__ import annotations

import gc
import hashlib
import logging
import os
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba.core import config, utils
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile
from numba.core.event import Event, Listener, register

from animat.errors import SettingsError
from animat.numerics.identity import STEP_OPTIONS
from animat.numerics.inlined import inlined

Function = TypeVar("Function", bound=Callable[..., Any])

ROOT = Path(__file__).parents[1]

COMPILING_LAYERS = ("numerics", "world", "robot", "mind", "life")
"""The packages that hold compiled functions; a change of another one compiles nothing anew."""

NO_PLACE = "no directory for compiled code can be written; set NUMBA_CACHE_DIR to one that can"

OPTIONS = {"nogil": True, "error_model": "numpy", "fastmath": False, "_nrt": False}

# A function of a user's file belongs to no module that can be imported, so Numba counts it to a
# module that stands in. Cached code asks for that by its name, under which nothing is found.
sys.modules.setdefault(utils._dynamic_modname, utils._dynamic_module)


def compiled(function: Function) -> Function:
    """Compile a function of a step; with `NUMBA_DISABLE_JIT=1` it stays plain Python."""
    uncompiled = getattr(config, "DISABLE_JIT", False)
    return _identified(function if uncompiled else inlined(function, **OPTIONS), function)


def kernel(function: Function) -> Function:
    """Compile a function that Python calls, and keep its machine code on disk.

    Raises SettingsError where there is no place to keep it.
    """
    try:
        dispatcher: Any = numba.njit(cache=True, **OPTIONS)(function)
    except RuntimeError:  # numba found none of its places writable
        raise SettingsError(NO_PLACE) from None
    if dispatcher is not function:
        _stamped(dispatcher._cache._cache_file)
    return _identified(dispatcher, function)


def kept(function: Callable[..., Any]) -> Any:
    """Return the file that keeps what is compiled of a function, with `load` and `save` by keys.

    Raises SettingsError where there is no place to keep it.
    """
    try:
        where = CompileResultCacheImpl(function)
        where.locator.ensure_cache_path()
    except (RuntimeError, OSError):
        raise SettingsError(NO_PLACE) from None
    path = where.locator.get_cache_path()
    return _stamped(IndexDataCacheFile(path, where.filename_base, engine_stamp()))


def _stamped(kept: Any) -> Any:
    """Let what is kept be of this engine alone, and what cannot be read or written be no error."""
    kept._source_stamp = engine_stamp()
    kept._load_index = _or(dict, kept._load_index)
    kept._load_data = _or(lambda: None, kept._load_data)
    kept.save = _or(lambda: None, kept.save)  # on a full disk, the next start compiles again
    return kept


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
    digest = hashlib.sha256()
    for layer in COMPILING_LAYERS:
        for path in sorted((ROOT / layer).rglob("*.py")):
            digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()


def _identified(dispatcher: Any, function: Callable[..., Any]) -> Any:
    """Give a compiled function of ours an identity that a later process finds again.

    Its name: the stamp of the kernels stands for the rest. A custom function has its identity from
    `snapshot.py`.
    """
    STEP_OPTIONS.add(dispatcher)
    ours = function.__code__.co_filename.startswith(str(ROOT) + os.sep)
    if dispatcher is not function and ours and not function.__closure__:
        dispatcher._set_uuid(f"{function.__module__}.{function.__qualname__}")
    return dispatcher


@cache
def announce() -> None:
    """Tell once in a process that the simulator is compiled, rather than read from disk.

    A warning of the logger "animat" is seen on the error output of a script, a notebook and the
    command line, and `logging.getLogger("animat").setLevel("ERROR")` silences it.
    """
    logging.getLogger("animat").warning("compiling the simulator, once, some 10 s ...")


class _Compiling(Listener):
    """Announce a kernel that Numba compiles, and let no garbage be collected until the end.

    There is next to none, and to look for it takes a tenth of the time.
    """

    depth = 0
    collects = False

    def on_start(self, event: Event) -> None:
        dispatcher: Any = event.data["dispatcher"]  # pyright: ignore[reportOptionalSubscript]
        ours = dispatcher.py_func.__module__.startswith("animat.")
        if ours and isinstance(dispatcher._cache, FunctionCache):
            announce()
        if self.depth == 0:
            self.collects = gc.isenabled()
            gc.disable()
        self.depth += 1

    def on_end(self, event: Event) -> None:
        self.depth -= 1
        if self.depth == 0 and self.collects:
            gc.enable()


register("numba:compile", _Compiling())

"""How the functions of a step are compiled, and how their machine code is kept on disk.

Two decorators. `compiled` is for every function that runs inside a step. `kernel` is for the few
functions that Python calls: they hold the loop over steps, and their machine code is cached.

The cache must never serve stale code, and must serve a mind whose functions are the user's own.
Numba looks only at the file of the cached function and at the identity of the functions handed to
it, and that identity is random in every process. So every function compiled here gets an identity
made of its name and its source, and a cached kernel is stamped with the source of the whole
package.

Bits: no fast maths and no contraction to fused multiply-add, so that a result does not depend on
the processor; NumPy's error model, so that no step can raise.
"""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba

Function = TypeVar("Function", bound=Callable[..., Any])

OPTIONS = {"nogil": True, "error_model": "numpy", "fastmath": False}


def compiled(function: Function) -> Function:
    """Compile a function of a step; with `NUMBA_DISABLE_JIT=1` it stays plain Python."""
    return _identified(numba.njit(**OPTIONS)(function), function)


def kernel(function: Function) -> Function:
    """Compile a function that Python calls, and keep its machine code on disk."""
    dispatcher = numba.njit(cache=True, **OPTIONS)(function)
    if dispatcher is not function:
        dispatcher._cache._cache_file._source_stamp = package_stamp()
    return _identified(dispatcher, function)


@cache
def package_stamp() -> str:
    """Return the SHA-256 of every source file of the package, in hexadecimal."""
    root = Path(__file__).parents[1]
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(str(path.relative_to(root)).encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()


def _identified(dispatcher: Any, function: Callable[..., Any]) -> Any:
    """Give a compiled function an identity that a later process finds again."""
    if dispatcher is not function:
        source = inspect.getsource(function).encode()
        digest = hashlib.sha256(source).hexdigest()
        dispatcher._set_uuid(f"{function.__module__}.{function.__qualname__}:{digest}")
    return dispatcher

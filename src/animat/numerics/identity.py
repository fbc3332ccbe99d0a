"""The identity of a function: a hash over everything it computes by.

One walk serves the cache of machine code, the identity of lives and the copies of a study's files.
It covers the code of the function and of every function it calls, their defaults and closures, and
the globals they name, along attributes to their end (`package.module.TABLE`). It reads values, not
source files: an array changed in place and a constant imported from elsewhere count, a comment and
the place of a file do not. Bytecode differs between minor versions of Python, and so do identities.

Functions of Python, NumPy, Numba and this package go by their names: the versions of those, and
the number of the engine, stand for the rest.
"""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterable
from enum import Enum, EnumMeta
from types import CodeType, FunctionType, ModuleType
from typing import Any, NamedTuple
from weakref import WeakSet

import numpy as np
from numba.core import types
from numba.core.dispatcher import Dispatcher
from numba.np.ufunc.dufunc import DUFunc

from animat.numerics.taken import PLAIN, is_library, library_name, python_function, taken

OPTIONS = {"fastmath": False, "error_model": "python", "parallel": False, "boundscheck": None}
"""The options of a compiled function that numbers depend on, as Numba has them unless told."""

STEP_OPTIONS: WeakSet[Any] = WeakSet()
"""The functions of `compiled`, which have options of their own, also where nothing is compiled."""


class Identity(NamedTuple):
    """The identity of a function.

    `text` is a SHA-256 in hexadecimal; `unknown` the first thing that the function computes by and
    that cannot be hashed, None if all can; `files` the source files of the functions walked.
    """

    text: str
    unknown: str | None
    files: frozenset[str]


def identity(function: Any) -> Identity:
    """Return the identity of a Python function, or of one that Numba compiles."""
    walk = _Walk()
    walk.value(python_function(function) or function, getattr(function, "__name__", "it"))
    walk.finish()
    return Identity(walk.digest.hexdigest(), walk.unknown, frozenset(walk.files))


class _Walk:
    """A walk from one function over all it computes by."""

    def __init__(self) -> None:
        self.digest = hashlib.sha256()
        self.unknown: str | None = None
        self.files: set[str] = set()
        self.numbers: dict[int, int] = {}
        self.waiting: list[tuple[FunctionType, str]] = []
        self.inside: set[int] = set()

    def finish(self) -> None:
        """Walk the functions that were met; each has the number in which it was."""
        for function, where in self.waiting:
            self._body(function, where)

    def value(self, value: Any, where: str) -> None:
        """Take a value into the hash; `where` is how it is called if it cannot be."""
        kind = type(value)
        if kind not in PLAIN:
            if (name := library_name(value)) is not None:
                return self._write(f"library {name}")
            if (function := python_function(value)) is not None:
                return self._function(value, function, where)
        self._write(kind.__name__)
        if kind in (int, bool):
            self._write(hex(value))
        elif kind in (float, complex):
            self._write(struct.pack("<2d", value.real, value.imag))
        elif kind in (str, bytes):
            self._write(value)
        elif value is None or value is ...:
            pass
        elif isinstance(value, np.ndarray | np.generic):
            self._array(np.asarray(value), kind, where)
        elif isinstance(value, np.dtype | types.Number | types.Boolean):
            self._write(repr(value))
        elif isinstance(value, CodeType):
            self._code(value, where)
        elif id(value) in self.inside or len(self.inside) > 100:
            self._unknown(value, where)
        else:
            self.inside.add(id(value))
            self._composed(value, where)
            self.inside.discard(id(value))
        return None

    def _composed(self, value: Any, where: str) -> None:
        if isinstance(value, Enum):
            self._each((value.name, value.value), where)
        elif isinstance(value, EnumMeta):
            self._each(list(value.__members__.items()), where)
        elif isinstance(value, range | slice):
            self._each((value.start, value.stop, value.step), where)
        elif isinstance(value, tuple | list):
            self._each((getattr(value, "_fields", None), *value), where)
        elif isinstance(value, dict):
            self._each(list(value.items()), where)
        elif isinstance(value, set | frozenset):
            self._each(sorted(self._apart(one, where) for one in value), where)
        elif isinstance(value, type) and issubclass(value, tuple) and hasattr(value, "_fields"):
            self._each(getattr(value, "_fields"), where)  # noqa: B009
        elif not (isinstance(value, type) and issubclass(value, Exception)):
            self._unknown(value, where)

    def _each(self, values: Any, where: str) -> None:
        self._write(str(len(values)))
        for value in values:
            self.value(value, where)

    def _apart(self, value: Any, where: str) -> str:
        """Return the hash of a value of a set, by which those are put in order."""
        walk = _Walk()
        walk.inside = self.inside
        walk.value(value, where)
        walk.finish()
        self.unknown = self.unknown or walk.unknown
        self.files |= walk.files
        return walk.digest.hexdigest()

    def _array(self, array: np.ndarray, kind: type, where: str) -> None:
        if array.dtype.hasobject or issubclass(kind, np.ma.MaskedArray | np.matrix):
            return self._unknown(array, where)
        self._write(f"{array.dtype!r} {array.shape} {array.flags.fnc}")
        if array.dtype.names is None:
            return self._write(np.ascontiguousarray(array).tobytes())
        for name in array.dtype.names:  # not what lies between fields
            self._array(array[name], np.ndarray, where)
        return None

    def _function(self, value: Any, function: FunctionType, where: str) -> None:
        if id(function) not in self.numbers:
            self.numbers[id(function)] = len(self.numbers)
            self.waiting.append((function, where))
        self._write(f"function {self.numbers[id(function)]}")
        if isinstance(value, DUFunc):
            self._write(f"element by element {value.identity}")
            value = getattr(value, "_dispatcher")  # noqa: B009
        for line in _options(value):
            self._write(line)

    def _body(self, function: FunctionType, where: str) -> None:
        self.files.add(function.__code__.co_filename)
        self._write(function.__qualname__)
        self._code(function.__code__, where)
        self.value(function.__defaults__, f"a default of {function.__name__}")
        self.value(function.__kwdefaults__, f"a default of {function.__name__}")
        for found in taken(function):
            self._write(f"{found.enclosing} {found.path} {found.rest}")
            if not isinstance(found.value, ModuleType) or is_library(found.value):
                self.value(found.value, ".".join(found.path))

    def _code(self, code: CodeType, where: str) -> None:
        shape = (code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount)
        # The flags that say what a call is and gives, not those of __future__.
        self._write(f"{shape} {code.co_flags & 0x2FF}")
        self._write(code.co_code)
        self._write(getattr(code, "co_exceptiontable", b""))
        for names in (code.co_names, code.co_varnames, code.co_cellvars, code.co_freevars):
            self._write(repr(names))
        self._each(code.co_consts, where)

    def _unknown(self, value: Any, where: str) -> None:
        self.unknown = self.unknown or f"{where}, which is of type {type(value).__name__}"

    def _write(self, part: str | bytes) -> None:
        content = part.encode("utf-8", "surrogatepass") if isinstance(part, str) else part
        self.digest.update(len(content).to_bytes(8, "little") + content)


def _options(value: Any) -> Iterable[str]:
    """Yield the options of a compiled function in which it differs from others."""
    if value in STEP_OPTIONS:
        yield "compiled as a step is"
    elif isinstance(value, Dispatcher):
        for name, usual in OPTIONS.items():
            option: Any = value.targetoptions.get(name, usual)
            if option != usual:
                yield f"{name} {sorted(option) if isinstance(option, set) else option}"
        if value.locals:
            yield f"locals {sorted((name, str(kind)) for name, kind in value.locals.items())}"
        if not getattr(value, "_can_compile"):  # noqa: B009
            yield f"for {value.nopython_signatures}"

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

import builtins
import dis
import hashlib
import os
import struct
import sys
from collections.abc import Iterable, Iterator
from enum import Enum, EnumMeta
from functools import lru_cache
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any, NamedTuple
from weakref import WeakSet

import numba
import numpy as np
from numba.core import types
from numba.core.dispatcher import Dispatcher
from numba.np.ufunc.dufunc import DUFunc

MISSING: Any = object()

STANDARD = os.path.dirname(os.__file__) + os.sep  # noqa: PTH120
PACKAGES = ("site-packages", "dist-packages")
LIBRARIES = tuple(
    str(folder) + os.sep
    for folder in (Path(__file__).parents[1], *(Path(one.__file__).parent for one in (np, numba)))
)

GLOBAL = {"LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS"}
ENCLOSING = {"LOAD_DEREF", "LOAD_CLASSDEREF", "LOAD_FROM_DICT_OR_DEREF"}
ATTRIBUTE = {"LOAD_ATTR", "LOAD_METHOD"}

OPTIONS = {"fastmath": False, "error_model": "python", "parallel": False, "boundscheck": None}
"""The options of a compiled function that numbers depend on, as Numba has them unless told."""

STEP_OPTIONS: WeakSet[Any] = WeakSet()
"""The functions of `compiled`, which have options of their own, also where nothing is compiled."""

PLAIN = (bool, int, float, complex, str, bytes, type(None), tuple, CodeType)
WALKED = (*PLAIN, np.ndarray, np.generic, np.dtype, list, dict, set, frozenset, range, slice)
WALKED = (*WALKED, Enum, EnumMeta)
"""The values that have an identity of their own, beside functions and what libraries name."""


class Identity(NamedTuple):
    """The identity of a function.

    `text` is a SHA-256 in hexadecimal; `unknown` the first thing that the function computes by and
    that cannot be hashed, None if all can; `files` the source files of the functions walked.
    """

    text: str
    unknown: str | None
    files: frozenset[str]


class Taken(NamedTuple):
    """A value that a function takes from around it: by which names it gets there, and from where.

    `rest` are the attributes that it takes of the value where that is a module of a library.
    """

    path: tuple[str, ...]
    enclosing: bool
    value: Any
    rest: tuple[str, ...] = ()


def identity(function: Any) -> Identity:
    """Return the identity of a Python function, or of one that Numba compiles."""
    walk = _Walk()
    walk.value(python_function(function) or function, getattr(function, "__name__", "it"))
    walk.finish()
    return Identity(walk.digest.hexdigest(), walk.unknown, frozenset(walk.files))


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
        return value.__name__ if _is_library(value) else None
    if isinstance(value, np.ufunc) and not isinstance(value, DUFunc):
        name = value.__name__
        return f"numpy.{name}" if getattr(np, name, None) is value else None
    module, name = getattr(value, "__module__", None), getattr(value, "__qualname__", None)
    found: Any = sys.modules.get(module) if isinstance(module, str) else None
    if found is None or not isinstance(name, str) or not _is_library(found):
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
    is_module = isinstance(value, ModuleType) and not _is_library(value)
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
            if not isinstance(found.value, ModuleType) or _is_library(found.value):
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


def _has_identity(value: Any) -> bool:
    return (
        isinstance(value, WALKED)
        or python_function(value) is not None
        or library_name(value) is not None
    )


def _is_library(module: ModuleType) -> bool:
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

"""The functions a mind is made of, and how a user's own takes the place of one of ours.

Each built-in function is known to the step by a code; a user's own travels beside it in
`Functions`, which the compiler sees through, so that it is compiled together with the rest. The
fields that are not the user's hold a function that is never called.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

from numba import types
from numba.core.dispatcher import Dispatcher

from animat.files.settings import SettingsError
from animat.mind.loading import load
from animat.numerics.checked import SelfCallError, checked
from animat.numerics.compiled import compiled
from animat.numerics.slots import Role, slot
from animat.numerics.snapshot import share_identity, snapshot

SIGNATURES = {
    "law": "law(value, low, high, rate, factor) -> value",
    "drives": "drives(values, changes, set_points, senses, a, b, out) -> None",
    "selector": "select(drives, likelihoods, serves, u, memory) -> behaviour",
    "estimator": "estimate(features, weights, hidden) -> likelihood",
    "learner": "learn(features, weights, hidden, target, rate, cycles, biases) -> None",
    "wander": "wander(readings, aheads, sides, memory, u_a, u_b, speed, turn) -> (left, right)",
}
"""What each replaceable function looks like; the module that holds the built-in ones says more."""

REAL, WHOLE = types.float64, types.int64
REALS, WHOLES = types.Array(REAL, 1, "C"), types.Array(WHOLE, 1, "C")
TABLE = types.Array(REAL, 2, "C")
GIVEN, GIVEN_WHOLES, GIVEN_TABLE = (
    types.Array(one.dtype, one.ndim, one.layout, readonly=True) for one in (REALS, WHOLES, TABLE)
)

ARGUMENTS = {
    "law": (REAL,) * 5,
    "drives": (GIVEN, GIVEN, GIVEN, GIVEN, GIVEN_TABLE, GIVEN_TABLE, REALS),
    "selector": (GIVEN, GIVEN, GIVEN_WHOLES, REAL, REALS),
    "estimator": (GIVEN, GIVEN, REALS),
    "learner": (GIVEN, REALS, REALS, REAL, REAL, WHOLE, types.boolean),
    "wander": (GIVEN_WHOLES, GIVEN, GIVEN, REALS, REAL, REAL, WHOLE, WHOLE),
}
"""What each replaceable function is given. Only `out`, `weights`, `hidden` and `memory` can be
written to; the other arrays are shared by lives on several threads."""

RESULTS = {
    "law": REAL,
    "drives": types.none,
    "selector": WHOLE,
    "estimator": REAL,
    "learner": types.none,
    "wander": types.UniTuple(REAL, 2),
}
"""What a step takes from each replaceable function."""

ROLES = {name: Role(given, RESULTS[name]) for name, given in ARGUMENTS.items()}

ALLOCATION = ("NRT required", "Only accept returning of array")
"""What the compiler says of a function that needs memory of its own."""


_TWINS: WeakKeyDictionary[Any, Any] = WeakKeyDictionary()


class FunctionError(SettingsError):
    """A user's function cannot be found, has the wrong signature or does not compile."""


class Functions(NamedTuple):
    """The user's own functions, compiled; for each built-in one, `unused_*`."""

    law: Any
    drives: Any
    selector: Any
    estimator: Any
    learner: Any
    wander: Any


@compiled
def unused_law(value, low, high, rate, factor):
    """Stand in for a law that is built in."""
    return math.nan


@compiled
def unused_drives(values, changes, set_points, senses, a, b, out):
    """Stand in for a drive function that is built in."""


@compiled
def unused_selector(drives, likelihoods, serves, u, memory):
    """Stand in for a selector that is built in."""
    return -1


@compiled
def unused_estimator(features, weights, hidden):
    """Stand in for an estimator that is built in."""
    return 0.0


@compiled
def unused_learner(features, weights, hidden, target, rate, cycles, biases):
    """Stand in for a learner that is built in."""


@compiled
def unused_wander(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    """Stand in for a wander controller that is built in."""
    return 0.0, 0.0


BUILT_IN = Functions(
    unused_law, unused_drives, unused_selector, unused_estimator, unused_learner, unused_wander
)

SLOTS = Functions(**{name: slot(name, role) for name, role in ROLES.items()})
"""What a kernel calls where a custom function is to be: what is linked into it."""


def resolve(role: str, function: str | Callable[..., Any], *, check: bool = False) -> Any:
    """Return the compiled form of a custom function for a role of `SIGNATURES`.

    `function` is a Python function, or a text "FILE.py:NAME". What it computes by counts as it is
    now, not as it was when a mind was made; see `snapshot`. It is compiled alone first, because the
    compiler says far less clearly what is wrong with it in the midst of a step. With `check`, every
    index it uses is checked whenever it is called. Raises FunctionError.
    """
    own: Any = _load(role, function) if isinstance(function, str) else function
    _check_signature(role, own.py_func if isinstance(own, Dispatcher) else own)
    dispatcher = snapshot(own)
    if isinstance(dispatcher, Dispatcher):
        twin = _check_compiles(role, dispatcher)
        return twin if check else dispatcher
    return dispatcher


def checked_twin(function: Any) -> Any:
    """Return a resolved function with every index checked."""
    return _TWINS.get(function, function)


def _load(role: str, address: str) -> Callable[..., Any]:
    file, _, name = address.rpartition(":")
    path = Path(file)
    if not file or not path.is_file():
        where = "" if path.is_absolute() else f" in {Path.cwd()}"
        raise FunctionError(
            f'{role} = "{address}": no such built-in and no such file{where};'
            f" give FILE.py:NAME of a function {SIGNATURES[role]}"
        )
    if path.suffix != ".py":
        raise FunctionError(f'{role} = "{address}": {path} is not a Python file')
    try:
        module = load(path)
    except (Exception, SystemExit) as error:
        raise FunctionError(f"{role}: {path} does not run: {_one_line(error)}") from error
    found = getattr(module, name, None)
    if not callable(found):
        raise FunctionError(f'{role}: {path} has no function "{name}"; wanted {SIGNATURES[role]}')
    return found


def _check_signature(role: str, function: Callable[..., Any]) -> None:
    signature = SIGNATURES[role]
    wanted = signature[signature.index("(") + 1 : signature.index(")")].split(", ")
    if not inspect.isfunction(function):
        name = getattr(function, "__name__", repr(function))
        raise FunctionError(f"{role}: {name} is not a Python function; wanted {signature}")
    given = inspect.signature(function)
    one_by_one = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    if len(given.parameters) != len(wanted) or any(
        parameter.kind not in one_by_one for parameter in given.parameters.values()
    ):
        raise FunctionError(
            f"{role}: {function.__name__}{given} has other arguments; wanted {signature}"
        )


def _check_compiles(role: str, dispatcher: Any) -> Any:
    """Return the twin of a custom function that checks every index, compiled for its role."""
    known = _TWINS.get(dispatcher)
    if known is not None and ARGUMENTS[role] in known.overloads:
        return known
    name = dispatcher.__name__
    twins: dict[Any, Any] = {}
    try:
        twin: Any = checked(dispatcher, twins)
        twin.compile(ARGUMENTS[role])
    except Exception as error:
        why = f"does not compile: {_why(error)}"
        if "readonly" in str(error) and _compiles_if_all_may_be_written(role, dispatcher):
            why = f"changes what it is given{_line(error)}; {_may_write(role)}"
        raise FunctionError(f"{role}: {name} {why}; wanted {SIGNATURES[role]}") from error
    result = twin.overloads[ARGUMENTS[role]].signature.return_type
    if not _suits(role, result):
        raise FunctionError(f"{role}: {name} returns {result}; wanted {SIGNATURES[role]}")
    if any(_uses_iterator(each) for each in twins.values()):
        raise FunctionError(
            f"{role}: {name} uses flat or nditer, which could change what it is given; use indices"
        )
    _TWINS[dispatcher] = _TWINS[twin] = twin
    share_identity(twin, dispatcher)
    return twin


def _compiles_if_all_may_be_written(role: str, dispatcher: Any) -> bool:
    writable = tuple(
        each.copy(readonly=False) if isinstance(each, types.Array) else each
        for each in ARGUMENTS[role]
    )
    try:
        checked(dispatcher, {}).compile(writable)
    except Exception:
        return False
    return True


def _uses_iterator(dispatcher: Any) -> bool:
    """Tell whether a compiled function walks an array by what ignores that it is read only."""
    walks = (types.NumpyFlatType, types.NumpyNdIterType)
    return any(
        isinstance(each, walks)
        for overload in dispatcher.overloads.values()
        for each in overload.type_annotation.typemap.values()
    )


def _may_write(role: str) -> str:
    """Return what a function of a role may write to, in words."""
    signature = SIGNATURES[role]
    names = signature[signature.index("(") + 1 : signature.index(")")].split(", ")
    writable = [
        name
        for name, each in zip(names, ARGUMENTS[role], strict=True)
        if isinstance(each, types.Array) and each.mutable
    ]
    return f"it may write to {' and '.join(writable) or 'nothing'}"


def _line(error: Exception) -> str:
    """Return the line of the source that the compiler names last, in words."""
    lines = re.findall(r'File "[^"]*", line (\d+)', str(error))
    return f" in line {lines[-1]}" if lines else ""


def _suits(role: str, result: types.Type) -> bool:
    """Tell whether a role can do with a function that returns a value of this type."""
    if role in {"drives", "learner"}:
        return isinstance(result, types.NoneType)
    if role == "selector":
        return types.unliteral(result) in types.signed_domain
    if role == "wander":
        each = getattr(result, "types", ())
        return len(each) == 2 and all(_is_number(one) for one in each)
    return _is_number(result)


def _is_number(result: types.Type) -> bool:
    return isinstance(result, types.Integer | types.Float)


def _why(error: Exception) -> str:
    """Return what the compiler has against a function, on one line."""
    if isinstance(error, SelfCallError):
        return f"{error} calls itself, for which a step has no room"
    if any(sign in str(error) for sign in ALLOCATION):
        return "it makes a new array, list or other object, for which a step has no room"
    lines = [line.strip() for line in str(error).splitlines()]
    telling = [line for line in lines if line and not line.startswith("Failed in ")]
    return " ".join(telling[:1]) or type(error).__name__


def _one_line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())

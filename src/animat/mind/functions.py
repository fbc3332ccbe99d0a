"""The functions a mind is made of, and how a user's own takes the place of one of ours.

Each built-in function is known to the step by a code; a user's own travels beside it in
`Functions`, which the compiler sees through, so that it is compiled together with the rest. The
fields that are not the user's hold a function that is never called.
"""

from __future__ import annotations

import importlib.util
import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numba

from animat.numerics.compiled import compiled

SIGNATURES = {
    "law": "law(value, low, high, rate, factor) -> value",
    "drives": "drives(values, changes, set_points, senses, a, b, out) -> None",
    "selector": "select(drives, likelihoods, serves, luck) -> behaviour",
    "estimator": "estimate(features, weights, hidden) -> likelihood",
    "learner": "learn(features, weights, hidden, target, rate, cycles, biases) -> None",
    "wander": "wander(readings, aheads, sides, memory, luck_a, luck_b, speed, turn)"
    " -> (left, right)",
}
"""What each replaceable function looks like; the module that holds the built-in ones says more."""


class FunctionError(ValueError):
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
    return value


@compiled
def unused_drives(values, changes, set_points, senses, a, b, out):
    """Stand in for a drive function that is built in."""


@compiled
def unused_selector(drives, likelihoods, serves, luck):
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
def unused_wander(readings, aheads, sides, memory, luck_a, luck_b, speed, turn):
    """Stand in for a wander controller that is built in."""
    return 0.0, 0.0


BUILT_IN = Functions(
    unused_law, unused_drives, unused_selector, unused_estimator, unused_learner, unused_wander
)


def resolve(role: str, function: str | Callable[..., Any]) -> Any:
    """Return the compiled form of a user's function for a role of `SIGNATURES`.

    `function` is a Python function, or a text "FILE.py:NAME". Raises FunctionError.
    """
    if isinstance(function, str):
        function = _load(role, function)
    if isinstance(function, numba.core.dispatcher.Dispatcher):
        function = function.py_func
    _check_signature(role, function)
    return compiled(function)


def _load(role: str, address: str) -> Callable[..., Any]:
    file, _, name = address.rpartition(":")
    path = Path(file)
    if not file or not path.is_file():
        raise FunctionError(
            f'{role} = "{address}": no such built-in and no such file;'
            f" give FILE.py:NAME of a function {SIGNATURES[role]}"
        )
    spec = importlib.util.spec_from_file_location(path.stem, path.resolve())
    if spec is None or spec.loader is None:
        raise FunctionError(f'{role} = "{address}": {path} is not a Python file')
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise FunctionError(f"{role}: {path} does not run: {error}") from error
    found = getattr(module, name, None)
    if not callable(found):
        raise FunctionError(f'{role}: {path} has no function "{name}"; wanted {SIGNATURES[role]}')
    return found


def _check_signature(role: str, function: Callable[..., Any]) -> None:
    signature = SIGNATURES[role]
    wanted = signature[signature.index("(") + 1 : signature.index(")")].split(", ")
    name = getattr(function, "__name__", str(function))
    try:
        given = list(inspect.signature(function).parameters)
    except (TypeError, ValueError) as error:
        raise FunctionError(f"{role}: {name} is not a Python function") from error
    if len(given) != len(wanted):
        raise FunctionError(
            f"{role}: {name}({', '.join(given)}) takes {len(given)} arguments; wanted {signature}"
        )

"""A custom function is tried before a run, with every index checked.

In a step nothing checks an index: a function that leaves an array there ends the process, or
changes another life. So each is called first as often as CALLS with inputs drawn over what a mind,
a world and a robot can hand to it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from animat.mind.affordance import weight_count
from animat.mind.drives import ABSOLUTE, RECTIFIED
from animat.mind.functions import BUILT_IN, SIGNATURES, FunctionError, Functions, checked_twin
from animat.mind.homeostasis import CUSTOM_LAW
from animat.numerics.threads import attempt

CALLS = 1_000
"""How often a function is called with inputs drawn at random."""

FRESH = 250
"""After how many calls memory and weights are as at birth again."""

BRIGHTEST = 1023
"""The largest reading of a sensor."""

PASSED_KEPT = 4_096


class Surroundings(NamedTuple):
    """What functions are called with beside the mind's own.

    `features` [T, F] of the object types, H hidden units, and of N sensors the cosines of their
    directions `aheads` [N] and how far to the left they sit, `sides` [N], mm.
    """

    features: NDArray[np.float64]
    hidden: int
    aheads: NDArray[np.float64]
    sides: NDArray[np.float64]


_passed: set[tuple[Any, ...]] = set()


def try_functions(functions: Functions, mind: np.record, around: Surroundings) -> None:
    """Try the custom functions of a mind with its parameters; each is tried once.

    Raises FunctionError for one that leaves an array, or writes to what it may only read.
    """
    for role, function in functions._asdict().items():
        if function is getattr(BUILT_IN, role):
            continue
        key = (role, function, mind.tobytes(), around.hidden)
        key = (*key, *(each.tobytes() for each in (around.features, around.aheads, around.sides)))
        if key in _passed:
            continue
        _, error = attempt(lambda role=role: _try(role, functions, mind, around))
        if error is not None:
            raise error
        if len(_passed) >= PASSED_KEPT:
            _passed.clear()
        _passed.add(key)


def _try(role: str, functions: Functions, mind: np.record, around: Surroundings) -> None:
    function = checked_twin(getattr(functions, role))
    drawn = _Drawn()
    given = {
        "law": _laws,
        "drives": _drives,
        "selector": _choices,
        "estimator": _estimates,
        "learner": _lessons,
        "wander": _searches,
    }[role](mind, around, drawn, functions)
    for arguments in given:
        try:
            function(*arguments)
        except IndexError as error:
            raise _refused(role, function, arguments, f"leaves an array ({error})") from error
        except ValueError as error:
            if "read-only" in str(error):  # NumPy's, where nothing is compiled
                raise _refused(role, function, arguments, "changes what it is given") from error
        except Exception:
            continue  # to raise is its own affair: the life in which it does fails


def _refused(role: str, function: Any, arguments: tuple[Any, ...], what: str) -> FunctionError:
    signature = SIGNATURES[role]
    names = signature[signature.index("(") + 1 : signature.index(")")].split(", ")
    lengths = ", ".join(
        f"{name} {list(each.shape)}"
        for name, each in zip(names, arguments, strict=True)
        if isinstance(each, np.ndarray)
    )
    given = f", given {lengths}" if lengths else ""
    return FunctionError(f"{role}: {function.__name__} {what}{given}")


class _Drawn:
    """Numbers in [0, 1), the same in every process; one in eight lies at an end."""

    def __init__(self) -> None:
        self._next = 1

    def __call__(self, *shape: int) -> NDArray[np.float64]:
        count = int(np.prod(shape))
        words = np.arange(self._next, self._next + count, dtype=np.uint64)
        self._next += count
        words = words * np.uint64(0x9E3779B97F4A7C15)
        for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
            words = (words ^ (words >> np.uint64(shift))) * np.uint64(factor)
        words ^= words >> np.uint64(31)
        numbers = (words >> np.uint64(11)).astype(np.float64) * 2.0**-53
        ends = words & np.uint64(15)
        numbers[ends == 0] = 0.0
        numbers[ends == 1] = 1.0 - 2.0**-53
        return numbers.reshape(shape)


def _given(values: NDArray[Any]) -> NDArray[Any]:
    """Return a copy that cannot be written to."""
    copy = np.array(values, order="C")
    copy.setflags(write=False)
    return copy


def _laws(mind: np.record, around: Surroundings, drawn: _Drawn, _: Functions) -> Iterator[Any]:
    for v in np.flatnonzero(mind.law == CUSTOM_LAW):
        low, high = float(mind.low[v]), float(mind.high[v])
        for u in drawn(CALLS):
            value = min(low + u * (high - low) * (1.0 + 2.0**-52), high)
            yield value, low, high, float(mind.rate[v]), float(mind.factor[v])


def _needs(mind: np.record, drawn: _Drawn) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return values [CALLS, V] and changes [CALLS, V], as far as acts can carry them."""
    effects = np.concatenate([np.abs(mind.success), np.abs(mind.failure)]).max(axis=0)
    low, high = mind.low - effects, mind.high + effects
    values = low + drawn(CALLS, len(low)) * (high - low)
    return values, (2.0 * drawn(CALLS, len(low)) - 1.0) * np.maximum(effects, mind.rate)


def _drives(mind: np.record, around: Surroundings, drawn: _Drawn, _: Functions) -> Iterator[Any]:
    fixed = [_given(each) for each in (mind.set_point, mind.sense, mind.a, mind.b)]
    out = np.zeros(len(mind.a))
    for values, changes in zip(*_needs(mind, drawn), strict=True):
        yield _given(values), _given(changes), *fixed, out


def _choices(
    mind: np.record, around: Surroundings, drawn: _Drawn, functions: Functions
) -> Iterator[Any]:
    serves = _given(mind.serves)
    own = functions.drives is not BUILT_IN.drives
    raised = checked_twin(functions.drives)
    memory = np.zeros(4)
    likelihoods, numbers = drawn(CALLS, len(serves)), drawn(CALLS)
    fixed = [_given(each) for each in (mind.set_point, mind.sense, mind.a, mind.b)]
    for n, (values, changes) in enumerate(zip(*_needs(mind, drawn), strict=True)):
        drives = _built_in_drives(mind, values, changes)
        if own:
            try:
                raised(_given(values), _given(changes), *fixed, drives)
            except Exception:
                continue
        if n % FRESH == 0:
            memory = np.zeros(4)
        yield _given(drives), _given(likelihoods[n]), serves, float(numbers[n]), memory


def _built_in_drives(
    mind: np.record, values: NDArray[np.float64], changes: NDArray[np.float64]
) -> NDArray[np.float64]:
    errors = mind.sense * (mind.set_point - values)
    if mind.error == RECTIFIED:
        errors = np.maximum(errors, 0.0)
    elif mind.error == ABSOLUTE:
        errors = np.abs(errors)
    return mind.a @ errors + mind.b @ changes


def _networks(
    mind: np.record, around: Surroundings, drawn: _Drawn
) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]]:
    """Yield features [F], weights [W] and room for hidden units [H]."""
    types, inputs = around.features.shape
    width = weight_count(inputs, around.hidden)
    noise = (2.0 * drawn(CALLS, inputs) - 1.0) * float(mind.feature_noise)
    hidden = np.zeros(around.hidden)
    weights = np.zeros(width)
    for n, kind in enumerate(np.minimum((drawn(CALLS) * types).astype(np.int64), types - 1)):
        if n % FRESH == 0:
            weights = drawn(width)
        features = around.features[kind] if types else np.zeros(inputs)
        yield _given(features + noise[n]), weights, hidden


def _estimates(mind: np.record, around: Surroundings, drawn: _Drawn, _: Functions) -> Iterator[Any]:
    for features, weights, hidden in _networks(mind, around, drawn):
        yield features, _given(weights), hidden


def _lessons(mind: np.record, around: Surroundings, drawn: _Drawn, _: Functions) -> Iterator[Any]:
    targets = drawn(CALLS)
    settings = float(mind.learning_rate), int(mind.learning_cycles), bool(mind.biases)
    for n, known in enumerate(_networks(mind, around, drawn)):
        yield *known, float(targets[n] < 0.5), *settings


def _searches(mind: np.record, around: Surroundings, drawn: _Drawn, _: Functions) -> Iterator[Any]:
    fixed = _given(around.aheads), _given(around.sides)
    readings = (drawn(CALLS, len(around.aheads)) * (BRIGHTEST + 1)).astype(np.int64)
    numbers = drawn(CALLS, 2)
    memory = np.zeros(4)
    for n in range(CALLS):
        if n % FRESH == 0:
            memory = np.zeros(4)
        speeds = int(mind.cruise_speed), int(mind.turn_speed)
        yield _given(readings[n]), *fixed, memory, *map(float, numbers[n]), *speeds

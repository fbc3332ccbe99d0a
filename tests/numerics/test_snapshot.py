"""A custom function computes, compiled, by what it would compute by uncompiled at that time."""

from __future__ import annotations

import math
import types
from collections import namedtuple
from typing import Any

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba.extending import overload, register_jitable

from animat.mind.selection import winner_take_all
from animat.numerics.compiled import compiled
from animat.numerics.snapshot import lasting_identity, snapshot

Level = namedtuple("Level", "low high")

KINDS = ("number", "array", "level", "global", "closure", "default", "compiled", "plain")

SOURCE = """
def made(number):
    def closure():
        return number
    def default(x=number):
        return x
    def outer():
        return inner()
    def inner():
        return held
    held = number
    return locals()
"""


def built(kind: str, number: float) -> Any:
    """Return something from which `asked` gets a number."""
    around: dict[str, Any] = {"number": number, "array": np.array([number])}
    exec(SOURCE + "def globally():\n    return number\ndef far():\n    return array[0]\n", around)
    inside = around["made"](number)
    around["far"] = numba.njit(around["far"])
    exec("def further():\n    return far() + 0.0 * array[0]\n", around)
    makers: dict[str, Any] = {
        "number": lambda: number,
        "array": lambda: np.array([1.0, number, 2.0])[1:],
        "level": lambda: Level(number, 0.0),
        "global": lambda: numba.njit(around["globally"]),
        "closure": lambda: numba.njit(inside["closure"]),
        "default": lambda: compiled(inside["default"]),
        "compiled": lambda: compiled(around["further"]),
        "plain": lambda: register_jitable(around["globally"]),
    }
    return makers[kind]()


def asked(kind: str, place: str) -> str:
    after = {"number": "", "array": "[0]", "level": ".low"}.get(kind, "()")
    return f"{place}{after}"


def change(kind: str, holder: Any, name: str, number: float) -> None:
    """Let the same graph hold another number: changed in place where that can be, else rebound."""
    value = getattr(holder, name)
    function = getattr(value, "py_func", value)
    if kind == "array":
        value[0] = number
    elif kind in ("global", "plain"):
        function.__globals__["number"] = number
    elif kind == "closure":
        function.__closure__[0].cell_contents = number
    elif kind == "default":
        function.__defaults__ = (number,)
    elif kind == "compiled":
        function.__globals__["array"][0] = number
    else:
        setattr(holder, name, built(kind, number))


numbers = st.floats(-1e6, 1e6)


@settings(max_examples=settings().max_examples // 6)
@given(
    kinds=st.lists(st.sampled_from(KINDS), min_size=1, max_size=2),
    data=st.data(),
    handed_on=st.booleans(),
)
def test_what_changes_in_a_process_is_computed_by(kinds, data, handed_on):
    """The number asked for is known from how the graph was built, without calling any of it."""
    root = here = types.ModuleType("package")
    holders, parts, held = [], [], []
    for depth, kind in enumerate(kinds):
        held.append(data.draw(numbers))
        setattr(here, f"v{depth}", built(kind, held[-1]))
        place = ".".join(["own" if handed_on else "root", *["sub"] * depth, f"v{depth}"])
        parts.append(f"{depth + 1} * {asked(kind, place)}")
        holders.append(here)
        here.sub = types.ModuleType("package")  # pyright: ignore[reportAttributeAccessIssue]
        here = here.sub
    around: dict[str, Any] = {"root": root}
    exec(f"def law(x):\n    own = root\n    return x + {' + '.join(parts)}\n", around)
    if not handed_on:
        exec(f"def law(x):\n    return x + {' + '.join(parts)}\n", around)
    law = around["law"]

    def expected() -> float:
        total = 1.0
        for depth, number in enumerate(held):
            total += (depth + 1) * number
        return total

    before, first, was = snapshot(law), expected(), lasting_identity(law)
    assert before(1.0) == first
    assert snapshot(law) is before
    depth = data.draw(st.integers(0, len(kinds) - 1))
    old, held[depth] = held[depth], data.draw(numbers.filter(lambda n: n != held[depth]))
    change(kinds[depth], holders[depth], f"v{depth}", held[depth])
    assert lasting_identity(law) != was
    assert snapshot(law)(1.0) == expected()
    assert before(1.0) == first
    change(kinds[depth], holders[depth], f"v{depth}", old)
    assert snapshot(law) is before


RATE = 2.0
TABLE = np.array([1.0, 2.0])
RECORD = np.array([(3.0,)], [("gain", float)])


@numba.vectorize
def each(x):
    return RATE * x


@numba.njit(["float64(float64)"])
def declared(x):
    return RATE * x


@numba.njit
def down(n):
    return RATE if n <= 0 else down(n - 1) + up(n - 1)


@numba.njit
def up(n):
    return RATE * n


def replaced(x):
    return RATE * x


@overload(replaced)
def _replaced(x):
    rate = RATE
    return lambda x: rate * x


TEAM = (up,)


def law_each(x):
    return each(x)


def law_declared(x):
    return declared(x)


def law_recursive(x):
    return down(3)


def law_replaced(x):
    return replaced(x)


def law_of_a_tuple(x):
    return TEAM[0](x)


def law_of_a_record(x):
    return RECORD[0].gain * RATE * x


def law_within(x):
    def inner(y):
        return TABLE[1] * RATE * y / 2.0

    return inner(x)


# Numba calls a tuple of functions experimental, and says so of the user's function.
@pytest.mark.filterwarnings("ignore:First-class function type feature is experimental")
@pytest.mark.parametrize(
    "law",
    [law_each, law_declared, law_recursive, law_replaced, law_of_a_tuple, law_of_a_record,
     law_within],
    ids=lambda law: law.__name__,
)  # fmt: skip
def test_helpers_of_every_kind_are_compiled_by_what_is_now(law, monkeypatch):
    compiled_with = snapshot(law)
    result = compiled_with(1.0)
    monkeypatch.setitem(globals(), "RATE", 4.0)
    again = snapshot(law)
    assert lasting_identity(again) == lasting_identity(law) != lasting_identity(compiled_with)
    assert again(1.0) == 2.0 * result
    assert compiled_with(1.0) == result


def test_what_is_ours_is_taken_as_it_is():
    assert snapshot(winner_take_all) is winner_take_all


def test_options_of_helpers_stay_theirs():
    @numba.njit(error_model="python")
    def divided(x):
        return 1.0 / x

    def law(x):
        return divided(x)

    with pytest.raises(ZeroDivisionError):
        snapshot(law)(0.0)
    assert snapshot(lambda x: 1.0 / x)(0.0) == math.inf


def test_what_cannot_be_identified_is_compiled_anew():
    unknown = numba.njit(lambda x: x)
    thing = object()

    def law(x):
        return unknown(x) if False else unknown(x + 1.0)

    law.__defaults__ = (thing,)
    assert snapshot(law) is not snapshot(law)
    assert snapshot(law)(1.0) == 2.0


def test_uncompiled_a_function_is_itself(monkeypatch):
    monkeypatch.setattr("numba.core.config.DISABLE_JIT", True)
    assert snapshot(law_within) is law_within

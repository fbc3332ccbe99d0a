"""Kernels into which functions are linked: what that leans on of Numba, and what must not go wrong.

That they are kept on disk, and compiled anew where they must be, is tested in test_compiled.py.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numba
import numpy as np
import pytest
from numba import types

from animat.numerics.compiled import OPTIONS, compiled
from animat.numerics.linked import linked
from animat.numerics.slots import Role, any_custom, slot
from animat.numerics.snapshot import snapshot

REALS = types.Array(types.float64, 1, "C")
ROLES = {
    "number": Role((types.float64,), types.float64),
    "pair": Role((types.int64,), types.UniTuple(types.float64, 2)),
    "fill": Role((REALS, types.float64), types.none),
    "other": Role((types.float64,), types.float64),
}


class Functions(NamedTuple):
    number: Any
    pair: Any
    fill: Any
    other: Any


class Counts(NamedTuple):
    pass


@compiled
def no_number(x):
    return 0.0


@compiled
def no_pair(n):
    return 0.0, 0.0


@compiled
def no_fill(out, x):
    pass


IDLE = Functions(no_number, no_pair, no_fill, no_number)
SLOTS = Functions(**{name: slot(name, role) for name, role in ROLES.items()})


@linked((REALS, types.float64, types.int64), (), SLOTS, ROLES, IDLE)
def kernel(out, x, n, functions):
    functions.fill(out, x)
    first, second = functions.pair(n)
    number = functions.number(x) + 1000.0 * functions.other(x)
    return number + 10.0 * first + 100.0 * second + (0.5 if any_custom() else 0.0)


def asked(x=2.0, n=3, **functions: Any) -> tuple[float, list[float]]:
    own = {name: snapshot(function) for name, function in functions.items()}
    out = np.zeros(2)
    return kernel.of(Counts(), IDLE._replace(**own))(out, x, n), out.tolist()


def test_what_a_function_returns_is_made_what_its_role_returns():
    def whole(x):
        return 7

    def mixed(n):
        return n, 0.25

    assert asked() == (0.0, [0.0, 0.0])
    assert asked(number=whole) == (7.5, [0.0, 0.0])
    assert asked(pair=mixed) == (30.0 + 25.0 + 0.5, [0.0, 0.0])


def test_each_kernel_has_its_own_functions_however_many_there_are():
    def plus(x):
        return x + 1.0

    def times(x):
        return x * 5.0

    def fill(out, x):
        out[1] = x

    first = asked(number=plus)
    assert asked(number=times) == (10.5, [0.0, 0.0])
    assert asked(number=times, fill=fill) == (10.5, [0.0, 2.0])
    assert asked(number=plus) == first == (3.5, [0.0, 0.0])


def test_one_function_may_fill_two_slots():
    def half(x):
        return x / 2.0

    assert asked(number=half, other=half) == (1001.5, [0.0, 0.0])


def test_what_a_function_raises_leaves_the_kernel_and_stops_it():
    def raising(x):
        if x > 1.0:
            raise ValueError("too large", 3)
        return x

    def fill(out, x):
        out[0] = x

    assert asked(0.5, number=raising, fill=fill) == (1.0, [0.5, 0.0])
    with pytest.raises(ValueError, match="too large"):
        asked(number=raising, fill=fill)
    assert asked(0.5, number=raising, fill=fill) == (1.0, [0.5, 0.0])


def test_what_cannot_be_told_apart_is_not_kept():
    def plain(x):
        return x - 0.125

    saved = []
    file = kernel._file()
    save = file.save
    file.save = lambda key, data: saved.append(key)
    try:
        asked(number=plain)
        assert len(saved) == 1
        own = numba.njit(**OPTIONS)(lambda x: 2.0 * x)  # nothing of ours: of no lasting name
        assert kernel.of(Counts(), IDLE._replace(number=own))(np.zeros(2), 2.0, 3) == 4.5
        assert len(saved) == 1
    finally:
        file.save = save


def test_outside_a_linked_kernel_a_slot_may_hold_anything():
    @numba.njit(**OPTIONS)
    def alone():
        return any_custom()

    assert alone() is True


def test_without_custom_functions_nothing_is_left_of_asking_for_them():
    asked()
    asked(number=lambda x: x)
    codes = [str(library._get_module_for_linking()) for library, _ in kernel.libraries.values()]
    assert codes
    assert not any("animat_any_custom" in code for code in codes)
    lines = [line for code in codes for line in code.splitlines() if " call " in line]
    assert not any("animat_slot" in line for line in lines)

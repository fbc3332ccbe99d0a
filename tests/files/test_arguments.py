"""Numbers from Python: one conversion, whatever type they come in."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from animat.errors import Error
from animat.files.arguments import real, whole
from animat.mind.mind import Mind
from animat.robot.khepera import Khepera
from animat.world.arena import Arena

WHOLE = [np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64]
REAL = [np.float16, np.float32, np.float64, np.longdouble]
NEITHER = [True, False, np.True_, np.False_, None, "1", b"1", 1j, [1], (1,), {}, np.array([1, 2])]


class Own:
    """A whole number of another library's."""

    def __init__(self, value):
        self.value = value

    def __index__(self):
        return self.value


@settings(deadline=None)
@given(st.integers(-(10**40), 10**40), st.sampled_from([int, Own, *WHOLE]))
def test_a_whole_number_is_itself_in_whatever_type(value, kind):
    if kind in WHOLE:
        value %= int(np.iinfo(kind).max) + 1
    found = whole("n", kind(value), -(10**40))
    assert type(found) is int
    assert found == value


@settings(deadline=None)
@given(st.floats(allow_nan=False, allow_infinity=False, width=16), st.sampled_from(REAL))
def test_a_real_number_is_itself_in_whatever_type(value, kind):
    found = real("x", kind(value))
    assert type(found) is float
    assert found == value


@given(st.integers(-(2**53), 2**53), st.sampled_from([int, Own, Fraction, np.int64]))
def test_a_whole_number_is_a_real_one(value, kind):
    assert real("x", kind(value)) == value


@settings(deadline=None)
@given(st.integers(), st.integers(-5, 2**63), st.integers(0, 2**64))
def test_a_whole_number_is_taken_exactly_between_its_limits(value, low, more):
    if low <= value <= low + more:
        assert whole("n", value, low, low + more) == value
    else:
        with pytest.raises(Error) as caught:
            whole("n", value, low, low + more)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize("value", NEITHER, ids=repr)
def test_what_is_no_number_is_neither(value):
    for convert in (whole, real):
        with pytest.raises(Error, match=r"^n = .*; allowed are .* numbers"):
            convert("n", value)


@pytest.mark.parametrize("value", [1.0, 1.5, np.float32(2), Fraction(2), math.nan])
def test_a_fraction_is_no_whole_number_even_if_it_is_one(value):
    with pytest.raises(Error, match="whole numbers from 0"):
        whole("n", value)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, np.float32("inf"), 10**400])
def test_a_real_number_is_finite(value):
    with pytest.raises(Error, match="finite numbers"):
        real("x", value)


@given(st.integers(1, 10), st.sampled_from([Own, *WHOLE]))
def test_settings_take_the_same_numbers_as_calls(value, kind):
    mind = Mind(cruise_speed=kind(value), variables={"stamina": {"set_point": np.float32(0.5)}})
    assert mind == Mind(cruise_speed=value, variables={"stamina": {"set_point": 0.5}})
    assert type(mind.cruise_speed) is int
    assert type(mind.variables["stamina"].set_point) is float
    assert type(Arena(width=np.float64(500)).width) is float
    assert Khepera(motor_noise=np.False_) == Khepera(motor_noise=False)

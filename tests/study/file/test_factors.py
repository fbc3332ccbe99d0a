"""Factors as a file writes them, and the numbers of a range."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from animat.files.settings import Settings, validated
from animat.files.validation_errors import mistakes
from animat.study.file.factors import Factor, Range, Spread, each_once, identity

SHARES = st.floats(0.0, 1.0, exclude_max=True)


class Holder(Settings):
    grid: dict[str, Factor] = {}
    over: dict[str, Spread] = {}


def test_a_factor_has_values_levels_or_a_range():
    data = {
        "grid": {"a": [1, "x", True, 0.5], "b": {"one": {"k": 1}, "two": {}}},
        "over": {"a": ["x"], "b": {"low": {}, "high": {}}, "c": {"low": 1, "high": 2.5}},
    }
    holder = validated(data, Holder)
    assert holder.model_dump(exclude_unset=True) == data
    assert isinstance(holder.over["c"], Range)
    assert isinstance(holder.over["b"], dict)
    assert [type(value) for value in holder.grid["a"]] == [int, str, bool, float]


REFUSED = {
    "a scalar": ("grid", "BLIND", 'key grid.f = "BLIND": must be a list of values, or a table'),
    "no value": ("grid", [], "key grid.f: must have at least 1 item"),
    "no level": ("grid", {}, "key grid.f: must have at least 1 item"),
    "a list": ("grid", [[1]], "key grid.f[0]: must be a number, a string, true or false"),
    "a table": ("grid", [{"a": 1}], "key grid.f[0]: must be a number, a string, true or false"),
    "nan": ("grid", [math.nan], "key grid.f[0] = nan: must be a finite number"),
    "twice": ("grid", ["a", 1, 1.0], "key grid.f: has 1.0 twice"),
    "a bare key": ("grid", {"agent": ["AF"]}, "put its key in quotes"),
    "a level of one value": ("grid", {"a": 1}, "key grid.f.a = 1: must be a table"),
    "a range in a grid": ("grid", {"low": 1, "high": 2}, "put it under [design.sample.over]"),
    "half a range": ("over", {"low": 1}, "key over.f.high: missing key"),
    "a misspelt range": ("over", {"low": 1, "hgh": 2}, 'did you mean "high"'),
    "a range upside down": ("over", {"low": 2, "high": 1}, "low = 2 must be below high = 1"),
    "a range of nothing": ("over", {"low": 2, "high": 2}, "low = 2 must be below high = 2"),
    "a log from 0": ("over", {"low": 0, "high": 1, "scale": "log"}, "low = 0 must be above 0"),
    "a scale": ("over", {"low": 0, "high": 1, "scale": "lg"}, 'did you mean "log"'),
    "text for a number": ("over", {"low": "0", "high": 1}, 'key over.f.low = "0": must be a'),
    "an endless range": ("over", {"low": 0, "high": math.inf}, "must be a finite number"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_everything_else_is_refused_in_one_line(case):
    place, value, told = REFUSED[case]
    with pytest.raises(ValidationError) as caught:
        validated({place: {"f": value}}, Holder)
    lines = mistakes(caught.value, Holder)
    assert told in " ".join(lines)
    assert len(lines) == (2 if case == "a misspelt range" else 1)


def test_one_is_one_but_not_true():
    assert identity(1) == identity(1.0) != identity(True)
    assert each_once([1, True, "1", 0, False]) == [1, True, "1", 0, False]
    with pytest.raises(ValueError, match="has true twice"):
        each_once([True, 1, True])


@given(
    ends=st.tuples(st.floats(1e-6, 1e6), st.floats(1e-6, 1e6)).filter(lambda e: e[0] < e[1]),
    scale=st.sampled_from(["linear", "log"]),
    shares=st.tuples(SHARES, SHARES).map(sorted),
)
def test_a_range_rises_from_low_to_high(ends, scale, shares):
    low, high = ends
    numbers = [Range(low=low, high=high, scale=scale).at(share, False) for share in shares]
    assert low <= numbers[0] <= numbers[1] <= high
    assert Range(low=low, high=high, scale=scale).at(0.0, False) == pytest.approx(low)


def test_the_middle_is_that_of_the_numbers_or_of_their_logarithms():
    assert Range(low=1.0, high=100.0).at(0.5, False) == 50.5
    assert Range(low=1.0, high=100.0, scale="log").at(0.5, False) == pytest.approx(10.0)


@given(low=st.integers(-50, 50), width=st.integers(1, 20), share=SHARES)
def test_a_whole_range_gives_whole_numbers_both_ends_among_them(low, width, share):
    value = Range(low=low, high=low + width).at(share, True)
    assert isinstance(value, int)
    assert low <= value <= low + width


def test_every_whole_number_is_as_frequent_as_the_others():
    shares = (np.arange(4_000) + 0.5) / 4_000
    even = [Range(low=3, high=6).at(float(share), True) for share in shares]
    assert np.bincount(even).tolist() == [0, 0, 0, 1_000, 1_000, 1_000, 1_000]
    log = [Range(low=1, high=7, scale="log").at(float(share), True) for share in shares]
    expected = 4_000 * np.diff(np.log(np.arange(1, 9))) / math.log(8)
    assert np.allclose(np.bincount(log)[1:], expected, atol=1.0)

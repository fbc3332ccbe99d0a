import itertools

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.statistics.factors import LEVELS_AT_MOST, NOT_SET, factor


def of(values, kind=None):
    return factor(pa.table({"f": pa.array(values, kind)}), "f")


def test_words_come_as_they_first_appear_and_nothing_last():
    got = of(["b", None, "a", "b"])
    assert got.levels == ("b", "a", NOT_SET)
    assert got.codes.tolist() == [0, 2, 1, 0]
    assert not got.ordered


def test_numbers_come_in_their_order():
    got = of([0.5, 0.1, None, 0.1])
    assert got.levels == ("0.1", "0.5", NOT_SET)
    assert got.codes.tolist() == [1, 0, 2, 0]
    assert of([10, 9, 0]).levels == ("0", "9", "10")
    assert got.ordered


def test_numbers_are_said_with_as_many_digits_as_tell_them_apart():
    assert of([0.1 + 0.2, 0.5]).levels == ("0.3", "0.5")
    assert of([0.1, 0.1 + 2**-55]).levels[0] != of([0.1, 0.1 + 2**-55]).levels[1]
    close = of([0.1 + k * 2**-50 for k in range(20)])
    assert len({close.label(k) for k in range(20)}) == 20


def test_truth_is_written_as_in_a_study_file():
    assert of([True, False, None]).levels == ("true", "false", NOT_SET)


def test_a_dictionary_in_chunks_is_read_like_words():
    chunks = [pa.array(["x", "y"]).dictionary_encode(), pa.array(["y", "z"]).dictionary_encode()]
    got = factor(pa.table({"f": pa.chunked_array(chunks)}), "f")
    assert got.levels == ("x", "y", "z")
    assert got.codes.tolist() == [0, 1, 1, 2]


numbers_or_none = st.floats(-1e6, 1e6).map(lambda value: value + 0.0) | st.none()  # no -0.0


@given(st.lists(numbers_or_none, min_size=1, max_size=200))
def test_more_numbers_than_a_few_are_cut_into_quarters(values):
    got = of(values, pa.float64())
    numbers = {v for v in values if v is not None}
    cut = len(numbers) > LEVELS_AT_MOST
    assert (got.values is not None) == cut
    assert len(np.unique(got.exact)) == len(numbers | ({None} & set(values)))
    assert set(got.codes.tolist()) == set(range(len(got.levels)))
    assert len(set(got.levels)) == len(got.levels)
    if got.values is None:
        return
    np.testing.assert_array_equal(got.values, [np.nan if v is None else v for v in values])
    named = [k for k, level in enumerate(got.levels) if level != NOT_SET]
    assert len(named) <= 4
    for lower, upper in itertools.pairwise(named):
        assert got.values[got.codes == lower].max() < got.values[got.codes == upper].min()


def test_quarters_hold_a_quarter_each_and_say_their_ends():
    got = of(np.arange(100) / 100)
    assert np.bincount(got.codes).tolist() == [25, 25, 25, 25]
    assert got.levels[0] == "0 to 0.24"
    assert got.label(7) == "0.07"


def test_a_label_is_the_level_of_a_life():
    assert of(["b", None]).label(1) == NOT_SET


def test_a_missing_column_is_named_with_those_there():
    with pytest.raises(ValueError, match=r"no column 'g'; it has: f"):
        factor(pa.table({"f": [1]}), "g")

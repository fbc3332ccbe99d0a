import numpy as np
import pyarrow as pa
import pytest

from animat.statistics.readings import codes, comparable

READINGS = {"law": ("grow", "fall"), "margin": ("0.05", "0.01"), "gate": ("true", "false")}


def test_values_are_told_by_their_place_whatever_their_type():
    table = pa.table({"law": ["fall", "grow"], "margin": ["0.01", "0.05"], "gate": ["true"] * 2})
    assert codes(table, READINGS).tolist() == [[1, 1, 0], [0, 0, 0]]


def test_a_value_that_a_reading_has_not_is_named():
    table = pa.table({"law": ["fall", "drift"]})
    with pytest.raises(ValueError, match="reading law has values grow, fall, not drift"):
        codes(table, {"law": ("grow", "fall")})


def test_groups_are_compared_only_by_what_occurs_in_all_of_them():
    # What grows has no margin of 0.01: of what falls, that with 0.05 is compared with it.
    margin = np.array([[0], [0], [0], [1], [1]])
    grows = np.array([True, False, False, False, False])
    assert comparable(margin, [grows, ~grows]).tolist() == [True, True, True, False, False]
    assert comparable(margin, [~grows]).tolist() == (~grows).tolist()


def test_where_nothing_is_left_out_nothing_is_dropped():
    rng = np.random.default_rng(1)
    code = rng.integers(0, 2, (200, 6))
    mine = rng.integers(0, 2, 200) == 1
    assert comparable(code, [mine, ~mine]).all()

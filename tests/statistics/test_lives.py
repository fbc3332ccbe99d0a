import numpy as np
import pyarrow as pa
import pytest

from animat.statistics.lives import cell, cells, column, first_lives, restriction

A, B = ("abundant", "BLIND"), ("abundant", "AF")


def test_a_missing_column_is_named_with_those_there(lives_table):
    with pytest.raises(ValueError, match=r"no column 'age'; it has: world, agent"):
        column(lives_table({A: [1, 2]}), "age")


def test_a_cell_holds_its_rows_only(lives_table):
    table = lives_table({A: [1, 2], B: [3]})
    assert cell(table, world="abundant", agent="AF").column("lifespan").to_pylist() == [3]


def test_a_missing_cell_is_named(lives_table):
    with pytest.raises(ValueError, match="no row with world = scarce, agent = AF"):
        cell(lives_table({A: [1]}), world="scarce", agent="AF")


def test_cells_come_in_order_of_appearance_with_all_their_rows(lives_table):
    table = lives_table({B: [5, 6], A: [1, 2]})
    shuffled = table.take(pa.array([0, 2, 1, 3]))
    got = {key: rows.column("lifespan").to_pylist() for key, rows in cells(shuffled)}
    assert list(got.items()) == [(B[::1], [5, 6]), (A, [1, 2])]
    assert [key for key, _ in cells(table, by=("world",))] == [("abundant",)]


def test_the_first_lives_are_those_of_lowest_index_in_every_cell(lives_table):
    table = lives_table({A: [10, 11, 12], B: [20, 21, 22]}).take(pa.array([5, 4, 3, 2, 1, 0]))
    got = first_lives(table, 2)
    assert sorted(got.column("lifespan").to_pylist()) == [10, 11, 20, 21]


def test_lives_are_restricted_at_the_earliest_step_at_which_one_was_let_go(lives_table):
    one = lives_table({A: [5, 100, 100]}, cap=100)
    other = lives_table({B: [50, 80, 90]}, cap=80)
    assert restriction([one]) == 100
    assert restriction([one, other]) == 80


def test_lives_that_all_end_are_not_restricted(lives_table):
    assert restriction([lives_table({A: [5, 6]})]) == np.inf

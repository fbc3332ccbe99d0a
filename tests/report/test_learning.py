import numpy as np
import pyarrow as pa
import pytest

from animat.report.learning import learnt_section

TEACHERS = pa.table(
    {
        "identity": ["a", "a"],
        "robot": [0, 1],
        "likelihood_eat_TS": [0.75, 0.25],
        "likelihood_turn_round_big_one": [1.0, 1.0],
        "likelihood_eat_none": pa.array([None, None], pa.float64()),
    }
)


@pytest.fixture
def curve():
    rows = [
        {"seed": seed, "episode": episode, "network": "eat", "object": "TS",
         "likelihood": float(np.exp(-episode / 9))}
        for seed in range(3) for episode in range(20)
    ]  # fmt: skip
    return pa.Table.from_pylist(rows)


def test_robots_that_taught_are_told_network_by_network():
    (table,) = learnt_section(TEACHERS, {}).tables
    assert table.rows[0][0:2] == ("eat", "TS")
    assert table.rows[0][2].startswith("0.50 (")
    assert table.rows[1] == ("turn_round_big", "one", "1.00")
    assert len(table.rows) == 2
    assert "2 robots" in table.note


def test_a_curve_is_drawn_for_each_case_under_its_name(curve):
    section = learnt_section(None, {"agent = LEARNING": curve})
    (picture,) = section.pictures
    assert "agent = LEARNING" in picture.caption
    assert picture.content.startswith(b"<?xml")


def test_without_anything_learnt_there_is_nothing_to_tell():
    assert learnt_section(TEACHERS.slice(0, 0), {}) is None
    assert learnt_section(None, {}) is None

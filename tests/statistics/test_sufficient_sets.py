from itertools import combinations

import numpy as np
import pyarrow as pa
import pytest

from animat.statistics import sufficient_sets as smallest
from animat.statistics.sufficient_sets import Condition, confirm, sufficient_set

TWO = (Condition("overflow", ("clamp",)), Condition("effect", ("0.2",)))


def test_just_the_two_readings_that_carry_the_effect_are_found(planted, readings):
    found = sufficient_set(planted, readings, "C1")
    assert found is not None
    assert found.conditions == TWO
    assert found.universes == planted.num_rows / 4
    assert found.share.value >= 0.95


def test_one_reading_is_enough_where_it_decides_alone(planted, readings):
    found = sufficient_set(planted, readings, "C7")
    assert found is not None
    assert found.conditions == (Condition("cycles", ("10",)),)


def test_a_claim_that_holds_nowhere_has_no_set(planted, readings):
    assert sufficient_set(planted, readings, "C5") is None


def made_up(holds, readings, copies=8, seed=3):
    """A table of universes in which a claim holds by a rule, and the values drawn at random."""
    rng = np.random.default_rng(seed)
    size = 100 * copies
    columns = {name: rng.choice(values, size).tolist() for name, values in readings.items()}
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    verdicts = ["holds" if holds(row) else "fails" for row in rows]
    return pa.table({**columns, "C1": verdicts})


def test_nothing_need_be_fixed_where_a_claim_holds_nearly_everywhere(readings):
    found = sufficient_set(made_up(lambda row: True, readings), readings, "C1")
    assert found is not None
    assert found.conditions == ()


def test_of_several_values_all_that_do_are_allowed(readings):
    universes = made_up(lambda row: row["physiology"] != "decay", readings)
    found = sufficient_set(universes, readings, "C1")
    assert found is not None
    assert found.conditions == (Condition("physiology", ("excess", "linear")),)


def test_three_readings_together_are_found(readings):
    def holds(row):
        return (row["physiology"], row["gate"], row["cycles"]) == ("linear", "always", "1")

    found = sufficient_set(made_up(holds, readings, copies=16), readings, "C1")
    assert found is not None
    assert {c.reading for c in found.conditions} == {"physiology", "gate", "cycles"}


def test_either_of_two_ways_is_one_that_one_reading_does(readings):
    """Where it holds if one or the other is so, one of them is the smallest set."""

    def holds(row):
        return row["gate"] == "always" or row["cycles"] == "1"

    found = sufficient_set(made_up(holds, readings), readings, "C1")
    assert found is not None
    assert len(found.conditions) == 1


def test_a_set_that_leaves_too_few_universes_is_no_set(readings, monkeypatch):
    universes = made_up(lambda row: row["gate"] == "always", readings)
    monkeypatch.setattr(smallest, "SUPPORT", universes.num_rows)
    assert sufficient_set(universes, readings, "C1") is None


def test_the_best_of_very_many_sets_is_none_where_readings_do_nothing():
    """Of 8,000 sets of four readings some have a share of 95 % by luck alone."""
    readings = {f"reading {number}": ("yes", "no") for number in range(12)}
    rng = np.random.default_rng(5)
    universes = made_up(lambda row: rng.random() < 0.8, readings)
    assert sufficient_set(universes, readings, "C1") is None


def test_no_less_is_found_where_some_sets_of_fewer_readings_may_be_luck():
    """Two readings make it likely; it takes the third, too."""
    readings = {f"reading {number}": ("yes", "no") for number in range(12)}
    rng = np.random.default_rng(6)

    def holds(row):
        number = sum(row[f"reading {place}"] == "yes" for place in (2, 5, 7))
        return rng.random() < (0.5, 0.6, 0.85, 0.99)[number]

    found = sufficient_set(made_up(holds, readings, copies=20), readings, "C1")
    assert found is not None
    assert found.conditions == tuple(Condition(f"reading {n}", ("yes",)) for n in (2, 5, 7))


def test_sets_are_counted_as_they_are():
    of = np.repeat(np.arange(5), [6, 2, 2, 4, 1])
    told = smallest._sets_of_each_size(of)
    for size, count in enumerate(told):
        chosen = combinations(range(len(of)), size)
        assert count == sum(len(set(of[list(one)])) == size for one in chosen)


def test_many_universes_are_searched_by_a_sample_of_them(readings, monkeypatch):
    monkeypatch.setattr(smallest, "MOST_UNIVERSES", 200)
    universes = made_up(lambda row: row["gate"] == "always", readings)
    found = sufficient_set(universes, readings, "C1")
    assert found is not None
    assert found.conditions == (Condition("gate", ("always",)),)
    assert found.universes <= 200


@pytest.mark.parametrize(
    ("good", "bad", "verdict"),
    [(100, 0, "holds"), (96, 4, "undecided"), (80, 20, "fails"), (72, 0, "undecided")],
)
def test_a_set_is_confirmed_by_fresh_universes_that_meet_it(readings, good, bad, verdict):
    found = sufficient_set(made_up(lambda r: r["gate"] == "always", readings), readings, "C1")
    assert found is not None
    rows = good + bad
    fresh = pa.table(
        {
            **{name: [values[0]] * (rows + 50) for name, values in readings.items()},
            "C1": ["holds"] * good + ["fails"] * bad + ["fails"] * 50,
        }
    )
    gate = ["always"] * rows + ["positive"] * 50
    fresh = fresh.set_column(fresh.schema.get_field_index("gate"), "gate", pa.array(gate))
    told = confirm(found, fresh)
    assert (told.universes, told.share.value) == (rows, good / rows)
    assert told.verdict == verdict

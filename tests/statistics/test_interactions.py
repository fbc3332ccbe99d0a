import numpy as np
import pyarrow as pa
import pytest
from scipy import stats

from animat.statistics import interactions
from animat.statistics.interactions import strongest_interactions
from animat.statistics.marginal_effects import Outcome


def found_in(universes, readings):
    rows = strongest_interactions(universes, readings).to_pylist()
    return {(row["reading"], row["other"]) for row in rows}


def test_the_planted_pair_is_the_only_interaction_found(planted, readings):
    rows = strongest_interactions(planted, readings).to_pylist()
    assert rows
    for row in rows:
        assert (row["reading"], row["other"]) == ("overflow", "effect")
    by_outcome = {row["outcome"]: row for row in rows}
    gain = by_outcome["abundant_gain"]
    assert gain["effect_here"] == pytest.approx(1.0, rel=0.05)
    assert gain["effect_against"] == pytest.approx(0.125, rel=0.05)
    assert gain["interaction"] == pytest.approx(8.0, rel=0.05)
    assert gain["low"] < 8.0 < gain["high"]
    assert by_outcome["C1"]["interaction"] == pytest.approx(1.0, abs=0.05)


def test_effects_that_only_add_up_are_no_interaction(make_universes, combinations, readings):
    """Each doubles the gain, so on the scale of factors they do not matter to each other."""

    def gain(one):
        return 2.0 ** ((one["overflow"] == "clamp") + (one["effect"] == "0.2"))

    universes = make_universes(combinations(copies=3), gain)
    rows = strongest_interactions(universes, readings).to_pylist()
    assert "abundant_gain" not in {row["outcome"] for row in rows}


def test_two_that_go_together_where_a_third_has_a_value_are_not_taken_for_it(
    make_universes, combinations, readings
):
    """As in a sample of few points: a failure costs just where two others go together."""
    every = pa.table(combinations(copies=4))
    clamp, positive, costs = (
        np.asarray(every[name]) == value
        for name, value in (("overflow", "clamp"), ("gate", "positive"), ("effect", "0.2"))
    )
    sample = every.filter(pa.array((clamp == positive) == costs)).to_pydict()

    def gain(one):
        return 4.0 if one["effect"] == "0.2" else 1.0

    assert ("overflow", "gate") not in found_in(make_universes(sample, gain), readings)


def test_two_that_go_together_where_two_others_do_are_not_taken_for_them(
    make_universes, combinations, readings
):
    """Whether cycles and gate agree is here whether overflow and effect do, but for a few."""
    every = pa.table(combinations(copies=6))
    clamp, positive, costs, ten = (
        np.asarray(every[name]) == value
        for name, value in (
            ("overflow", "clamp"),
            ("gate", "positive"),
            ("effect", "0.2"),
            ("cycles", "10"),
        )
    )
    few = np.arange(every.num_rows) % 6 == 0
    sample = every.filter(pa.array(((clamp == costs) == (positive == ten)) | few)).to_pydict()

    def gain(one):
        return 6.0 if (one["overflow"] == "clamp") == (one["effect"] == "0.2") else 1.0

    found = found_in(make_universes(sample, gain), readings)
    assert ("overflow", "effect") in found
    assert ("gate", "cycles") not in found


def test_what_readings_add_is_found_where_they_only_add_up():
    rng = np.random.default_rng(5)
    code = rng.integers(0, [2, 3, 4], size=(300, 3))
    adds = [np.array([0.0, 1.0]), np.array([0.0, -2.0, 5.0]), np.array([1.0, 1.0, 0.0, 3.0])]
    each = np.stack([add[had] for add, had in zip(adds, code.T, strict=True)], axis=1)
    own, of_pairs = interactions.effects_of(code, [], 7.0 + each.sum(axis=1))
    assert own == pytest.approx(each - each.mean(axis=0))
    assert not of_pairs.any()


def test_what_a_pair_adds_is_found_beside_what_its_readings_do():
    rng = np.random.default_rng(6)
    code = rng.integers(0, [2, 3, 4], size=(300, 3))
    values = 3.0 * code[:, 0] + 5.0 * ((code[:, 0] == 1) & (code[:, 2] == 2))
    own, of_pairs = interactions.effects_of(code, [(0, 2)], values)
    assert own.sum(axis=1) + of_pairs == pytest.approx(values - values.mean())
    without, _ = interactions.effects_of(code, [], values)
    assert own == pytest.approx(without)


def test_chance_alone_is_not_called_an_interaction(planted, readings):
    rng = np.random.default_rng(1)
    found = 0
    for _ in range(10):
        verdicts = pa.array(rng.choice(["holds", "fails"], planted.num_rows).tolist())
        place = planted.schema.get_field_index("C2")
        told = strongest_interactions(planted.set_column(place, "C2", verdicts), readings)
        found += "C2" in told.column("outcome").to_pylist()
    # At 95 % for all pairs together one in 20 is expected; three in 10 has a chance of 1 %.
    assert found < 3


def test_of_few_universes_chance_is_not_called_an_interaction_either(
    planted, readings, monkeypatch
):
    """Of four groups of a few universes each the means are far apart by chance now and then."""
    monkeypatch.setattr(interactions, "outcomes", lambda universes: [chance(universes)])
    rng = np.random.default_rng(2)

    def chance(universes):
        return Outcome("chance", "difference", rng.normal(size=universes.num_rows))

    found = 0
    for _ in range(60):
        few = planted.take(pa.array(rng.permutation(planted.num_rows)[:30]))
        found += strongest_interactions(few, readings).num_rows > 0
    # One in 20 is expected at most; more than seven in 60 has a chance of 1 %.
    assert found <= 7


def test_an_interval_of_two_of_the_groups_is_welchs():
    """Where two groups do not vary, the interaction is a difference of two means."""
    rng = np.random.default_rng(3)
    one, other = rng.normal(2.0, 1.0, 6), rng.normal(0.0, 3.0, 9)
    parts = [one, other, np.zeros(4), np.zeros(5)]
    welch = stats.ttest_ind(one, other, equal_var=False).confidence_interval(0.95)
    half = interactions._half_width(parts, 0.975, of_shares=False)
    assert half == pytest.approx((welch.high - welch.low) / 2)
    assert interactions._half_width([np.ones(3)] * 4, 0.975, of_shares=False) == 0.0


def test_no_more_than_asked_for_are_told(planted, readings):
    for outcome in range(2):
        table = strongest_interactions(planted, readings, most=outcome)
        assert table.num_rows == outcome * len(set(table.column("outcome").to_pylist()))
    assert "interaction" in table.column_names

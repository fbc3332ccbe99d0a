import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from animat.statistics.claims import CLAIMS, EFFECTS
from animat.statistics.marginal_effects import (
    difference,
    largest_imbalance,
    marginal_effects,
    outcomes,
)


@pytest.fixture(scope="module")
def effects(planted, readings):
    table = marginal_effects(planted, readings)
    return {(r["reading"], r["value"], r["outcome"]): r for r in table.to_pylist()}


def test_every_value_is_compared_with_the_first_in_every_outcome(effects, readings):
    contrasts = [(name, value) for name, values in readings.items() for value in values[1:]]
    assert list(effects) == [(*c, o) for c in contrasts for o in (*CLAIMS, *EFFECTS)]
    assert {row["against"] for row in effects.values()} == {v[0] for v in readings.values()}


def test_the_planted_readings_have_their_effect_and_the_others_none(effects, readings):
    for name, values in readings.items():
        for value in values[1:]:
            row = effects[name, value, "C1"]
            if name in {"overflow", "effect"}:
                assert row["mean_against"] == pytest.approx(0.5, abs=0.03)
                assert row["high"] < -0.3
            else:
                assert row["low"] < 0.0 < row["high"]
    # With clamp half of the universes have a gain of 4 and half of 0.5, which makes a mean of
    # the square root of 2; with lethal all have 0.5.
    row = effects["overflow", "lethal", "abundant_gain"]
    assert row["mean_against"] == pytest.approx(np.sqrt(2.0), rel=0.05)
    assert row["effect"] == pytest.approx(0.5 / np.sqrt(2.0), rel=0.05)
    assert effects["cycles", "1", "C7"]["effect"] == -1.0
    assert effects["cycles", "1", "learning_error"]["effect"] == pytest.approx(0.45, abs=0.03)


def test_a_value_is_compared_only_where_the_first_was_possible(planted, readings):
    """The rule leaves out: what decays has no gate but the first."""
    kept = [
        not (row["physiology"] == "decay" and row["gate"] == "always")
        for row in planted.select(["physiology", "gate"]).to_pylist()
    ]
    table = marginal_effects(planted.filter(kept), readings)
    rows = {(r["reading"], r["value"]): r for r in table.to_pylist() if r["outcome"] == "C1"}
    total = planted.num_rows
    assert rows["gate", "always"]["universes_against"] == total / 3
    assert rows["physiology", "decay"]["universes"] == total / 6
    assert rows["physiology", "decay"]["universes_against"] == total / 6
    assert rows["physiology", "linear"]["universes_against"] == total / 3


@given(st.integers(0, 40), st.integers(0, 40))
def test_a_difference_of_shares_lies_in_its_interval_and_so_does_its_contrary(a, b):
    one, other = (np.repeat([1.0, 0.0], [k, 40 - k]) for k in (a, b))
    forth, back = difference(one, other, "points"), difference(other, one, "points")
    assert forth.value == pytest.approx((a - b) / 40)
    assert -1.0 - 1e-12 <= forth.low <= forth.value <= forth.high <= 1.0 + 1e-12
    assert (forth.low, forth.high) == pytest.approx((-back.high, -back.low))


def test_newcombes_own_example():
    """Newcombe (1998), Table II, method 10: 56/70 against 48/80 is 0.2, 0.0524 to 0.3339."""
    one, other = np.repeat([1.0, 0.0], [56, 14]), np.repeat([1.0, 0.0], [48, 32])
    told = difference(one, other, "points")
    assert told == pytest.approx((0.2, 0.0524, 0.3339), abs=5e-5)


def test_a_difference_of_means_has_welchs_interval():
    rng = np.random.default_rng(1)
    one, other = rng.normal(1.0, 1.0, 30), rng.normal(0.0, 3.0, 50)
    told = difference(one, other, "difference")
    half = (told.high - told.low) / 2
    v = one.var(ddof=1) / 30, other.var(ddof=1) / 50
    degrees = sum(v) ** 2 / (v[0] ** 2 / 29 + v[1] ** 2 / 49)
    assert half == pytest.approx(stats.t.ppf(0.975, degrees) * np.sqrt(sum(v)))
    factor = difference(one, other, "factor")
    assert factor == pytest.approx(np.exp(told))


def test_of_too_few_universes_nothing_is_said():
    assert np.isnan(difference(np.array([1.0]), np.array([1.0, 2.0]), "difference")).all()
    same = difference(np.array([1.0, 1.0]), np.array([3.0, 3.0]), "difference")
    assert same == (-2.0, -2.0, -2.0)


def test_a_ratio_is_told_by_its_logarithm(planted):
    by_name = {outcome.name: outcome for outcome in outcomes(planted)}
    gain = np.asarray(planted.column("abundant_gain"))
    np.testing.assert_allclose(by_name["abundant_gain"].values, np.log(gain))
    assert by_name["learning_error"].scale == "difference"
    assert set(by_name["C1"].values.tolist()) <= {0.0, 1.0}


def test_what_is_shared_out_unevenly_is_told(planted, readings):
    """Every combination is there as often as any other, until some are taken away."""
    assert largest_imbalance(planted, readings).points == 0.0
    rows = planted.select(["gate", "cycles"]).to_pylist()
    both = [row == {"gate": "always", "cycles": "1"} for row in rows]
    some = np.cumsum(both) <= np.sum(both) / 2
    told = largest_imbalance(planted.filter(pa.array(~np.array(both) | some)), readings)
    # A half of those with one value, and a third of those with the other.
    assert told.points == pytest.approx(1 / 2 - 1 / 3)
    assert {told.reading, told.other} == {"gate", "cycles"}


def test_what_a_rule_keeps_apart_is_not_called_uneven(planted, readings):
    rows = planted.select(["physiology", "gate"]).to_pylist()
    kept = [row != {"physiology": "decay", "gate": "always"} for row in rows]
    assert largest_imbalance(planted.filter(pa.array(kept)), readings).points == 0.0

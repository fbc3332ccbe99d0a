import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.statistics.survival import (
    ALIVE,
    causes,
    kaplan_meier,
    logrank,
    mean_lifespan,
    stability,
    success_rate,
    summarise,
)

A, B = ("abundant", "BLIND"), ("abundant", "AF")


def sample(seed, n=80, scale=1000.0, cap=2000):
    drawn = np.random.default_rng(seed).exponential(scale, n).astype(int) + 1
    return np.minimum(drawn, cap)


def spans_table(steps, censored):
    return pa.table({"lifespan": steps, "censored": censored, "seed": [1] * len(steps),
                     "life": list(range(len(steps)))})  # fmt: skip


@given(
    lives=st.lists(st.tuples(st.integers(1, 40), st.booleans()), min_size=2, max_size=60),
)
def test_curve_band_and_median_are_lifelines(lives):
    lifelines = pytest.importorskip("lifelines")
    utils = pytest.importorskip("lifelines.utils")
    steps, censored = (list(values) for values in zip(*lives, strict=True))
    if all(censored):
        censored[0] = False
    ours = kaplan_meier(spans_table(steps, censored))
    theirs = lifelines.KaplanMeierFitter().fit(steps, [not c for c in censored])
    np.testing.assert_allclose(ours.times, theirs.survival_function_.index, atol=0)
    np.testing.assert_allclose(
        ours.survival, theirs.survival_function_.to_numpy()[:, 0], atol=1e-12
    )
    band = theirs.confidence_interval_.to_numpy()
    inner = (ours.survival > 0) & (ours.survival < 1)
    np.testing.assert_allclose(ours.low[inner], band[inner, 0], atol=1e-9)
    np.testing.assert_allclose(ours.high[inner], band[inner, 1], atol=1e-9)
    if np.abs(ours.survival - 0.5).min() > 1e-9:  # theirs falls to either side by rounding
        assert ours.median().value == utils.median_survival_times(theirs)
    assert ours.lives == len(lives)
    assert ours.deaths == len(lives) - sum(censored)


def test_the_band_has_no_gap_where_its_formula_has_none():
    curve = kaplan_meier(spans_table([5, 10, 10, 20], [True, False, False, False]))
    assert np.isfinite(curve.low).all()
    assert np.isfinite(curve.high).all()
    assert (curve.low <= curve.survival).all()
    assert (curve.survival <= curve.high).all()
    assert (curve.low[0], curve.high[0]) == (1.0, 1.0)
    assert curve.low[-1] == 0.0


def test_lives_that_all_end_at_once():
    curve = kaplan_meier(spans_table([10] * 4, [False] * 4))
    assert curve.survival.tolist() == [1.0, 0.0]
    assert curve.low.tolist() == [1.0, 0.0]
    assert curve.high.tolist() == [1.0, 1.0]


def test_the_median_is_the_first_step_that_half_or_fewer_outlive():
    assert kaplan_meier(spans_table([1, 1, 1, 2, 2, 2], [False] * 6)).median().value == 1
    assert kaplan_meier(spans_table([1, 1, 2, 2, 2], [False] * 5)).median().value == 2


def test_the_median_that_nobody_lived_to_see_is_infinite(lives_table):
    table = lives_table({A: [10, 100, 100, 100]}, cap=100)
    assert kaplan_meier(table).median().value == np.inf


def test_a_curve_of_no_lives_is_refused(lives_table):
    with pytest.raises(ValueError, match="at least one life"):
        kaplan_meier(lives_table({A: [1]}).slice(0, 0))


@pytest.mark.parametrize("seed", range(6))
def test_the_logrank_test_is_lifelines(seed):
    statistics = pytest.importorskip("lifelines.statistics")
    one, other = sample(seed), sample(seed + 100, n=50, scale=1300.0)
    ours = logrank(spans_table(one, one >= 2000), spans_table(other, other >= 2000))
    theirs = statistics.logrank_test(one, other, one < 2000, other < 2000)
    assert ours.statistic**2 == pytest.approx(theirs.test_statistic, rel=1e-9)
    assert ours.p == pytest.approx(theirs.p_value, rel=1e-6)


def test_groups_in_which_nobody_dies_do_not_differ(lives_table):
    table = lives_table({A: [100, 100]}, cap=100)
    assert logrank(table, table) == (0.0, 1.0)


def test_deaths_that_can_tell_nothing_apart_do_not_differ(lives_table):
    """The one that dies is the last one watched: nobody else could have died there."""
    one, other = lives_table({A: [50]}, cap=50), lives_table({B: [80]})
    assert logrank(one, other) == (0.0, 1.0)


@pytest.mark.parametrize("seed", range(4))
def test_the_mean_is_lifelines_area_under_the_curve(seed):
    lifelines = pytest.importorskip("lifelines")
    utils = pytest.importorskip("lifelines.utils")
    steps = sample(seed)
    fitted = lifelines.KaplanMeierFitter().fit(steps, steps < 2000)
    area = utils.restricted_mean_survival_time(fitted, t=2000)
    got = mean_lifespan(spans_table(steps, steps >= 2000))
    assert got.value == pytest.approx(area, rel=1e-9)
    assert got.low < got.value < got.high


def test_a_life_let_go_early_restricts_the_mean_for_all():
    table = spans_table([10, 30, 500], [False, True, False])
    assert mean_lifespan(table).value == pytest.approx((10 + 30 + 30) / 3)


def test_causes_are_counted_by_variable_side_and_cause():
    ways = [
        (False, "nutrition", "low", "metabolism"),
        (False, "nutrition", "low", "failure"),
        (False, "nutrition", "low", "failure"),
        (False, "stamina", "high", "metabolism"),
        (True, None, None, None),
        (True, None, None, None),
        (True, None, None, None),
    ]
    columns = ("censored", "death_variable", "death_side", "death_cause")
    table = pa.table({name: list(values) for name, values in zip(columns, zip(*ways, strict=True),
                                                                 strict=True)})  # fmt: skip
    got = causes(table)
    assert [(death.label, death.count) for death in got] == [
        ("nutrition too low, failure", 2),
        ("nutrition too low, metabolism", 1),
        ("stamina too high, metabolism", 1),
        (ALIVE, 3),
    ]
    assert got[0].share.value == pytest.approx(2 / 7)
    assert got[0].share.low < 2 / 7 < got[0].share.high


def test_the_success_rate_weighs_acts_not_lives():
    table = pa.table({"acts": [1, 9, 0], "successes": [0, 9, 0]})
    assert success_rate(table).value == pytest.approx(0.9)


def test_the_success_rate_of_lives_that_hang_together_is_less_sure_than_of_single_acts(
    lives_table,
):
    rng = np.random.default_rng(1)
    chance = rng.beta(1.0, 1.0, 200)
    table = pa.table({"acts": [50] * 200, "successes": rng.binomial(50, chance)})
    got = success_rate(table)
    alone = 2 * 1.96 * np.sqrt(got.value * (1 - got.value) / 10_000)
    assert got.high - got.low > 3 * alone


def test_busy_and_idle_lives_that_succeed_alike_leave_no_doubt():
    acts = np.arange(0, 400, 10)
    got = success_rate(pa.table({"acts": acts, "successes": acts // 2}))
    assert got == pytest.approx((0.5, 0.5, 0.5))


def test_the_success_rate_of_those_who_never_acted_is_unknown():
    assert np.isnan(success_rate(pa.table({"acts": [0, 0], "successes": [0, 0]}))).all()


def test_stability_is_the_mean_of_the_mean_drives(lives_table):
    table = lives_table({A: [5] * 50})
    got = stability(table)
    assert got.value == pytest.approx(np.mean(table.column("mean_drive").to_numpy()))
    assert got.low < got.value < got.high


def test_a_summary_has_every_cell_with_its_own_numbers(lives_table):
    table = lives_table({A: [10, 20, 30, 400], B: [100, 200, 300, 400]}, cap=400)
    blind, af = summarise(table, resamples=199)
    assert (blind.cell, af.cell) == (A, B)
    assert (blind.lives, blind.alive, blind.cap) == (4, 1, 400)
    assert (blind.mean.value, af.mean.value) == (115, 250)
    assert (blind.median.value, af.median.value) == (20, 200)
    assert [death.count for death in blind.deaths] == [3, 1]
    assert blind.success_rate.value != af.success_rate.value
    assert blind.stability.value != af.stability.value


def test_ten_thousand_lives_give_the_interval_of_the_normal_law(lives_table):
    steps = sample(1, 10_000)
    (cell,) = summarise(lives_table({A: steps}, cap=2000))
    half = 1.96 * steps.std(ddof=1) / 100
    assert cell.mean.high - cell.mean.value == pytest.approx(half, rel=0.1)
    assert cell.mean.value - cell.mean.low == pytest.approx(half, rel=0.1)

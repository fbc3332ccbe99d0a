import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lifelines.statistics import multivariate_logrank_test
from scipy import stats

from animat.statistics.significance import hotelling, stratified_logrank


def draw(seed, n=240, groups=3, strata=1, cap=1500.0):
    rng = np.random.default_rng(seed)
    group, stratum = rng.integers(0, groups, n), rng.integers(0, strata, n)
    steps = np.ceil(rng.exponential(500.0 * (1 + 0.3 * group) * (1 + stratum)))
    return np.minimum(steps, cap), steps < cap, group, stratum


@pytest.mark.parametrize("seed", range(5))
def test_of_two_groups_it_is_scipys(seed):
    steps, died, group, stratum = draw(seed, groups=2)
    sides = [stats.CensoredData.right_censored(steps[group == g], ~died[group == g])
             for g in (0, 1)]  # fmt: skip
    theirs = stats.logrank(*sides)
    ours = stratified_logrank(steps, died, group, stratum)
    assert ours.statistic == pytest.approx(theirs.statistic**2, rel=1e-9)
    assert ours.p == pytest.approx(theirs.pvalue, rel=1e-6)
    assert (ours.name, ours.freedom) == ("log-rank", 1)


@pytest.mark.parametrize("groups", [2, 3, 5])
def test_of_many_groups_it_is_lifelines(groups):
    steps, died, group, stratum = draw(groups, groups=groups)
    theirs = multivariate_logrank_test(steps, group, died)
    ours = stratified_logrank(steps, died, group, stratum)
    assert ours.statistic == pytest.approx(theirs.test_statistic, rel=1e-9)
    assert ours.p == pytest.approx(theirs.p_value, rel=1e-9)
    assert ours.freedom == groups - 1


def surplus_and_spread(steps, died, group):
    """Deaths of group 1 beyond what is expected, and their variance, time by time."""
    surplus = spread = 0.0
    for time in np.unique(steps[died]):
        risk, dead = steps >= time, died & (steps == time)
        n, d, ours = risk.sum(), dead.sum(), (risk & (group == 1)).sum()
        surplus += (dead & (group == 1)).sum() - d * ours / n
        if n > 1:
            spread += d * ours / n * (1 - ours / n) * (n - d) / (n - 1)
    return surplus, spread


@pytest.mark.parametrize("seed", range(4))
def test_strata_add_their_surplus_and_their_variance(seed):
    steps, died, group, stratum = draw(seed, groups=2, strata=7)
    parts = [surplus_and_spread(steps[at], died[at], group[at])
             for at in (stratum == s for s in range(7))]  # fmt: skip
    surplus, spread = np.sum(parts, axis=0)
    ours = stratified_logrank(steps, died, group, stratum)
    assert ours.statistic == pytest.approx(surplus**2 / spread, rel=1e-9)
    assert ours.name == "stratified log-rank"


def test_what_another_factor_does_drops_out():
    """The groups lie in the strata unevenly: without strata they would seem to differ."""
    rng = np.random.default_rng(1)
    stratum = np.repeat([0, 1], 400)
    group = (rng.random(800) < np.where(stratum == 0, 0.2, 0.8)).astype(int)
    steps = np.ceil(rng.exponential(np.where(stratum == 0, 200.0, 2000.0)))
    died = np.ones(800, dtype=bool)
    assert stratified_logrank(steps, died, group, stratum).p > 0.05
    assert stratified_logrank(steps, died, group, np.zeros(800)).p < 1e-10


def test_the_order_of_the_lives_does_not_matter():
    arrays = draw(3, strata=4)
    mixed = np.random.default_rng(0).permutation(len(arrays[0]))
    again = stratified_logrank(*(each[mixed] for each in arrays))
    assert again.statistic == pytest.approx(stratified_logrank(*arrays).statistic, rel=1e-9)


def test_where_no_death_can_tell_groups_apart_p_is_1():
    steps, none = np.array([5.0, 9.0, 9.0]), np.zeros(3, dtype=bool)
    group = np.array([0, 1, 1])
    assert stratified_logrank(steps, none, group, np.zeros(3)).p == 1.0
    apart = stratified_logrank(steps, ~none, group, group)
    assert (apart.statistic, apart.freedom, apart.p) == (0.0, 0, 1.0)


def test_groups_that_never_meet_are_not_compared_with_each_other():
    steps, died, group, _ = draw(1, n=400, groups=4)
    ours = stratified_logrank(steps, died, group, group // 2)
    assert ours.freedom == 2


def means_of(measured):
    """Are the means of the columns of `measured` [s, m] all 0?"""
    means = measured.mean(axis=0)
    return hotelling(means, (measured - means) / len(measured))


def measured(seed, units=30, m=3):
    rng = np.random.default_rng(seed)
    return rng.normal(0.3, 1.0, (units, m)) @ rng.normal(0.0, 1.0, (m, m))


@pytest.mark.parametrize("seed", range(3))
def test_of_one_mean_it_is_students_test(seed):
    values = measured(seed, m=1)
    theirs = stats.ttest_1samp(values[:, 0], 0.0)
    got = means_of(values)
    assert got.statistic == pytest.approx(theirs.statistic**2)
    assert got.p == pytest.approx(theirs.pvalue)


@pytest.mark.parametrize("m", [2, 5])
def test_it_is_the_f_test_of_a_regression_of_1_on_the_columns(m):
    values = measured(m, m=m)
    units = len(values)
    left = np.linalg.lstsq(values, np.ones(units), rcond=None)[1][0]
    f = (units - left) / left * (units - m) / m
    got = means_of(values)
    assert got.freedom == m
    assert got.p == pytest.approx(stats.f.sf(f, m, units - m))


@given(st.integers(0, 50), st.integers(1, 4))
def test_it_is_the_same_for_any_contrasts_of_the_same_means(seed, m):
    values = measured(seed, m=m)
    mixed = values @ np.random.default_rng(seed + 1).normal(0.0, 1.0, (m, m))
    assert means_of(mixed).p == pytest.approx(means_of(values).p, rel=1e-4)


def test_what_is_told_twice_counts_once():
    values = measured(0, m=2)
    got = means_of(np.hstack([values, values]))
    assert got.freedom == 2
    assert got.p == pytest.approx(means_of(values).p)


def test_without_more_units_than_means_there_is_no_test():
    assert np.isnan(means_of(measured(0, units=3, m=3)).p)
    assert np.isnan(means_of(measured(0, units=1, m=1)).p)
    assert not np.isnan(means_of(measured(0, units=4, m=3)).p)


def test_what_does_not_vary_is_0_or_has_the_sign_tests_p():
    assert means_of(np.zeros((8, 2)))[2:] == (0, 1.0)
    got = means_of(np.full((8, 2), 0.5))
    assert got.p == stats.binomtest(8, 8).pvalue
    values = measured(0, m=1)
    assert means_of(np.hstack([values, np.zeros_like(values)])).p == pytest.approx(
        means_of(values).p
    )

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from animat.statistics.hotelling import hotelling


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

"""Intervals of many samples at once are those of each alone; scipy is the oracle."""

import warnings

import numpy as np
import pytest
from scipy import stats

from animat.statistics import estimates
from animat.statistics.estimates import rows_of_means


def ratio(numerator, denominator):
    return numerator / denominator


def samples(rows, values, seed=1):
    """Lifespans: whole numbers, whose sums have no rounding that would break ties."""
    rng = np.random.default_rng(seed)
    return [np.ceil(rng.exponential(mean, (rows, values))) for mean in (5_000.0, 1_800.0)]


def one_by_one(both, statistic, resamples, method="BCa"):
    """What scipy says of one sample at a time, [3, R]."""

    def over(*rows, axis=-1):
        return statistic(*(np.mean(row, axis=axis) for row in rows))

    found = []
    for row in zip(*both, strict=True):
        for way in (method, "percentile"):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                low, high = stats.bootstrap(
                    row, over, paired=True, n_resamples=resamples, method=way,
                    rng=np.random.default_rng(0),
                ).confidence_interval  # fmt: skip
            if np.isfinite([low, high]).all():
                break
        value = over(*row)
        still = all(np.ptp(each) == 0 for each in row)
        found.append((value, value, value) if still else (value, low, high))
    return np.array(found).T


@pytest.mark.parametrize("gathered", [True, False])
@pytest.mark.parametrize("values", [5, 60])
def test_every_row_has_the_interval_it_would_have_alone(values, gathered, monkeypatch):
    both = samples(7, values)
    if not gathered:
        monkeypatch.setattr(estimates, "NUMBERS", 299 * values)
    np.testing.assert_allclose(
        rows_of_means(both, ratio, resamples=299),
        one_by_one(both, ratio, resamples=299),
        rtol=1e-12,
    )


def test_so_it_has_where_nothing_varies_and_where_bca_has_no_answer():
    both = samples(4, 30)
    both[0][1], both[1][1] = 600.0, 300.0
    both[0][2, :], both[1][2, :] = 0.0, 1.0
    both[0][2, 0] = 1.0

    def at_least(numerator, denominator):
        return np.maximum(numerator / denominator, 0.05)

    got = rows_of_means(both, at_least, resamples=299)
    assert np.isfinite(got).all()
    np.testing.assert_allclose(got, one_by_one(both, at_least, resamples=299), rtol=1e-12)
    assert got.at(1) == (2.0, 2.0, 2.0)
    assert got.low[2] == 0.05


def test_beyond_the_limit_of_bca_it_is_percentiles_as_well(monkeypatch):
    both = samples(3, 40)
    monkeypatch.setattr(estimates, "BCA_LIMIT", 39)
    got = rows_of_means(both, ratio, resamples=299)
    expected = one_by_one(both, ratio, resamples=299, method="percentile")
    np.testing.assert_allclose(got, expected, rtol=1e-12)


def test_how_many_rows_are_held_at_once_does_not_show(monkeypatch):
    both = samples(9, 20)
    whole = rows_of_means(both, ratio, resamples=199)
    monkeypatch.setattr(estimates, "NUMBERS", 900)
    np.testing.assert_allclose(rows_of_means(both, ratio, resamples=199), whole, rtol=1e-12)


def test_one_life_a_row_has_a_value_and_no_interval():
    got = rows_of_means([np.array([[2.0]]), np.array([[1.0]])], ratio)
    assert got.at(0).value == 2.0
    assert np.isnan(got.at(0)[1:]).all()
    with pytest.raises(ValueError, match="at least one value"):
        rows_of_means([np.empty((2, 0))], lambda mean: mean)


@pytest.mark.parametrize(("values", "least", "most"), [(5, 0.80, 0.89), (100, 0.92, 0.97)])
def test_how_often_an_interval_has_the_truth_in_it(values, least, most):
    """A bootstrap of five values cannot know the tails: docs/multiverse.md says so of C7."""
    drawn = np.random.default_rng(1).normal(0.15, 0.05, (1_000, values))
    told = rows_of_means([drawn], lambda mean: mean, resamples=499)
    assert least < np.mean((told.low <= 0.15) & (told.high >= 0.15)) < most

import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from animat.statistics import estimates
from animat.statistics.estimates import BCA_LIMIT, mean, of_means, rows_of_means, share


@given(total=st.integers(1, 2000), data=st.data())
def test_a_share_has_wilsons_interval(total, data):
    count = data.draw(st.integers(0, total))
    z = stats.norm.ppf(0.975)
    p = count / total
    centre = (p + z * z / (2 * total)) / (1 + z * z / total)
    half = z * np.sqrt(p * (1 - p) / total + z * z / (4 * total * total)) / (1 + z * z / total)
    got = share(count, total)
    assert got.value == p
    np.testing.assert_allclose([got.low, got.high], [centre - half, centre + half], atol=1e-12)


def test_a_share_of_nothing_is_unknown():
    assert np.isnan(share(0, 0)).all()


def test_the_mean_of_a_large_normal_sample_has_the_textbook_interval():
    values = np.random.default_rng(1).normal(10.0, 2.0, 10_000)
    half = stats.norm.ppf(0.975) * values.std(ddof=1) / 100
    got = mean(values)
    assert got.value == values.mean()
    assert got.high - got.low == pytest.approx(2 * half, rel=0.05)
    assert (got.high + got.low) / 2 == pytest.approx(got.value, abs=0.1 * half)


def test_the_interval_covers_the_mean_of_a_skewed_law_about_as_often_as_it_says():
    rng = np.random.default_rng(5)
    covered = 0
    for trial in range(150):
        got = mean(rng.exponential(1.0, 60), seed=trial, resamples=499)
        covered += got.low <= 1.0 <= got.high
    # 95 % of 150 is 142; fewer than 132 would happen once in some 10,000 times.
    assert covered >= 132


def by_percentiles(monkeypatch, values, **settings):
    with monkeypatch.context() as patched:
        patched.setattr(estimates, "BCA_LIMIT", 1)
        return mean(values, **settings)


def test_bca_moves_a_skewed_interval_to_the_long_tail(monkeypatch):
    values = np.random.default_rng(2).exponential(1.0, 40)
    bca, plain = mean(values), by_percentiles(monkeypatch, values)
    assert bca.low > plain.low
    assert bca.high > plain.high


def test_bca_serves_samples_up_to_its_limit_and_percentiles_larger_ones(monkeypatch):
    rng = np.random.default_rng(3)
    small, large = rng.exponential(1.0, BCA_LIMIT), rng.exponential(1.0, BCA_LIMIT + 1)
    assert mean(small, resamples=199) != by_percentiles(monkeypatch, small, resamples=199)
    assert mean(large, resamples=199) == by_percentiles(monkeypatch, large, resamples=199)


def test_the_same_seed_gives_the_same_interval_and_another_seed_another():
    values = np.random.default_rng(4).normal(0.0, 1.0, 200)
    assert mean(values, seed=1, resamples=199) == mean(values, seed=1, resamples=199)
    assert mean(values, seed=1, resamples=199) != mean(values, seed=2, resamples=199)


def test_the_batches_do_not_show_in_the_interval(monkeypatch):
    values = np.random.default_rng(4).normal(0.0, 1.0, 200)
    whole = mean(values, resamples=500)
    monkeypatch.setattr(estimates, "NUMBERS", 3_000)
    cut = mean(values, resamples=500)
    np.testing.assert_allclose(cut, whole, rtol=1e-12)


def test_common_random_numbers_narrow_the_interval_of_a_ratio():
    drawn = np.random.default_rng(6).exponential(1000.0, 300)
    twice = 2 * drawn + np.random.default_rng(7).normal(0.0, 1.0, 300)
    together = of_means([twice, drawn], np.divide)
    apart = of_means([twice, drawn[::-1]], np.divide)
    assert together.value == pytest.approx(2.0, abs=0.01)
    assert apart.value == pytest.approx(together.value)
    assert together.high - together.low < 0.01
    assert apart.high - apart.low > 0.3


def test_what_does_not_vary_has_no_width():
    assert mean(np.full(20, 5.0)) == (5.0, 5.0, 5.0)


def test_one_value_has_no_interval():
    got = of_means([np.array([4.0]), np.array([2.0])], np.divide)
    assert got.value == 2.0
    assert np.isnan([got.low, got.high]).all()


def test_an_empty_sample_is_refused():
    with pytest.raises(ValueError, match="at least one value"):
        mean(np.array([]))


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

import numpy as np
import pytest
from scipy import stats

from animat.statistics.effects import cliffs_delta
from animat.statistics.resampling import Sets


def alone(one, other):
    """Every life a set of its own."""
    count = len(one) + len(other)
    return (one, Sets(np.arange(len(one)), count, ""), other,
            Sets(np.arange(len(one), count), count, ""))  # fmt: skip


@pytest.mark.parametrize("seed", range(4))
def test_it_is_the_rank_biserial_correlation_of_mann_and_whitney(seed):
    rng = np.random.default_rng(seed)
    one, other = np.ceil(rng.exponential(40.0, 50)), np.ceil(rng.exponential(30.0, 70))
    u = stats.mannwhitneyu(one, other).statistic
    assert cliffs_delta(*alone(one, other)).value == pytest.approx(2 * u / (50 * 70) - 1)


def test_turned_round_it_changes_sign():
    rng = np.random.default_rng(0)
    one, other = rng.exponential(2.0, 40), rng.exponential(1.0, 30)
    ours, theirs = cliffs_delta(*alone(one, other)), cliffs_delta(*alone(other, one))
    np.testing.assert_allclose(ours, (-theirs.value, -theirs.high, -theirs.low), atol=1e-12)


@pytest.mark.parametrize("scale", [1.3, 0.2])
def test_its_interval_is_the_bootstraps(scale):
    rng = np.random.default_rng(1)
    one, other = rng.exponential(2.0, 300), rng.exponential(scale, 200)

    def delta(x, y):
        return 2 * stats.mannwhitneyu(x, y).statistic / (len(x) * len(y)) - 1

    drawn = [delta(rng.choice(one, 300), rng.choice(other, 200)) for _ in range(999)]
    ours = cliffs_delta(*alone(one, other))
    np.testing.assert_allclose((ours.low, ours.high), np.quantile(drawn, [0.025, 0.975]), atol=0.02)


def test_lives_of_one_set_count_as_one():
    """Each life thrice, in the set of the first: nothing more is known."""
    rng = np.random.default_rng(2)
    one, other = rng.exponential(2.0, 60), rng.exponential(1.0, 60)
    _, ours, _, theirs = alone(one, other)
    thrice = cliffs_delta(
        np.tile(one, 3), Sets(np.tile(ours.codes, 3), 120, ""),
        np.tile(other, 3), Sets(np.tile(theirs.codes, 3), 120, ""),
    )  # fmt: skip
    np.testing.assert_allclose(thrice, cliffs_delta(*alone(one, other)), atol=1e-12)


def test_shared_luck_narrows_the_interval():
    luck = np.random.default_rng(3).exponential(1.0, 200)
    sets = Sets(np.arange(200), 200, "")
    together = cliffs_delta(1.2 * luck, sets, luck, sets)
    apart = cliffs_delta(*alone(1.2 * luck, luck))
    assert together.value == apart.value
    assert together.high - together.low < 0.2 * (apart.high - apart.low)


def test_what_always_wins_leaves_no_doubt_and_a_single_set_tells_nothing():
    assert cliffs_delta(*alone(np.array([5.0, 6.0]), np.array([1.0, 2.0]))) == (1.0, 1.0, 1.0)
    one = Sets(np.zeros(1, dtype=np.int64), 1, "")
    single = cliffs_delta(np.array([1.0]), one, np.array([1.0]), one)
    assert single.value == 0.0
    assert np.isnan(single[1:]).all()

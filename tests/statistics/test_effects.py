import numpy as np
import pytest
from scipy import stats

from animat.statistics.effects import cliffs_delta, paired_effects, rank_biserial
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


def each(n):
    return Sets(np.arange(n), n, "")


def lives(n=60, effect=1.3, cap=np.inf, seed=0):
    """Lives of two levels, and which of both they are, that share much of their lengths."""
    rng = np.random.default_rng(seed)
    shared = rng.exponential(200.0, n)
    one, other = (np.ceil(k * shared + rng.exponential(60.0, n)) for k in (effect, 1.0))
    return np.minimum(one, cap), np.minimum(other, cap)


def compare(one, other, **given):
    n = len(one)
    pair = np.tile(np.arange(n), 2)
    return paired_effects(
        np.concatenate([one, other]), np.repeat([True, False], n), pair, Sets(pair, n, ""),
        resamples=199, **given,
    )  # fmt: skip


@pytest.mark.parametrize("cap", [np.inf, 150.0])
def test_the_rank_biserial_is_of_wilcoxons_ranks(cap):
    one, other = lives(cap=cap)
    positive, negative = (
        stats.wilcoxon(d, zero_method="pratt", alternative="greater", method="asymptotic").statistic
        for d in (one - other, other - one)
    )
    expected = (positive - negative) / (60 * 61 / 2)
    assert compare(one, other).rank_biserial.value == pytest.approx(expected)


def test_pairs_differ_win_and_tie():
    got = compare(np.array([5.0, 9.0, 4.0, 9.0]), np.array([3.0, 9.0, 6.0, 1.0]))
    assert got.pairs == 4
    assert (got.difference.value, got.outlives.value, got.ties) == (2.0, 0.5, 0.25)


def test_the_difference_has_the_interval_of_the_bootstrap():
    one, other = lives()
    theirs = stats.bootstrap(
        (one - other,), np.mean, n_resamples=3999, rng=np.random.default_rng(3)
    ).confidence_interval
    np.testing.assert_allclose(compare(one, other).difference[1:], theirs, atol=6.0)


def test_turned_round_all_changes_sign():
    one, other = lives(cap=300.0)
    ours, theirs = compare(one, other), compare(other, one)
    for here, there in zip(
        (ours.difference, ours.rank_biserial), (theirs.difference, theirs.rank_biserial),
        strict=True,
    ):  # fmt: skip
        np.testing.assert_allclose(here, (-there.value, -there.high, -there.low), rtol=0.05)
    assert ours.outlives.value + theirs.outlives.value + ours.ties == pytest.approx(1.0)


def test_ties_at_the_cap_make_nobody_sure():
    """Five of 100 pairs differ, all for the first: that is not as if all did."""
    other = np.full(100, 50.0)
    other[:5] = 20.0
    got = compare(np.full(100, 50.0), other)
    assert got.rank_biserial.value < 0.2
    assert got.outlives.high < 0.15
    assert got.ties == 0.95


def test_lives_without_a_partner_are_left_out():
    got = paired_effects(
        np.array([5.0, 3.0, 1e6, 7.0, 8.0]), np.array([True, False, True, True, False]),
        np.array([4, 4, 9, 2, 2]), Sets(np.array([0, 0, 1, 2, 2]), 3, ""), resamples=99,
    )  # fmt: skip
    assert got.pairs == 2
    assert got.difference.value == 0.5
    assert paired_effects(np.ones(2), np.array([True, True]), np.arange(2), each(2)) is None


def test_what_always_wins_has_no_interval_that_is_known():
    got = compare(np.array([5.0, 6.0, 7.0]), np.array([1.0, 2.0, 3.0]))
    assert got.rank_biserial.value == 1.0
    assert np.isnan(got.rank_biserial[1:]).all()
    assert got.outlives.low < 0.5


def test_pairs_of_one_set_count_as_one():
    difference = np.subtract(*lives())
    thrice = rank_biserial(np.tile(difference, 3), Sets(np.tile(np.arange(60), 3), 60, ""))
    np.testing.assert_allclose(thrice, rank_biserial(difference, each(60)), atol=0.02)


def test_intervals_hold_the_truth_about_as_often_as_they_say():
    """Lives censored at the cap; the truth is that of very many pairs."""
    truth = compare(*lives(20_000, cap=300.0))
    wanted = [truth.difference.value, truth.outlives.value, truth.rank_biserial.value]
    held = np.zeros(3)
    for trial in range(120):
        got = compare(*lives(40, cap=300.0, seed=trial + 1))
        held += [
            estimate.low <= value <= estimate.high
            for estimate, value in zip(
                (got.difference, got.outlives, got.rank_biserial), wanted, strict=True
            )
        ]
    # 95 % of 120 is 114; fewer than 104 would happen once in some 10,000 times.
    assert held.min() >= 104

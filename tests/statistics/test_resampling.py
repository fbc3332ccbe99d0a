import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from animat.statistics import resampling
from animat.statistics.estimates import mean
from animat.statistics.resampling import (
    CASES,
    COMBINATIONS,
    LIVES,
    SETS_AT_LEAST,
    Sets,
    codes_of,
    mean_over,
    median_over,
    numbers,
    paired,
    quotient_over,
    ratio_over,
    sets_of,
    share_over,
)


def each(n):
    return Sets(np.arange(n), n, "")


@given(st.lists(st.tuples(st.integers(-2, 2), st.sampled_from("ab")), min_size=1))
def test_codes_tell_rows_apart_in_their_order(rows):
    codes = codes_of(*(np.array(column) for column in zip(*rows, strict=True)))
    ranks = {row: rank for rank, row in enumerate(sorted(set(rows)))}
    assert codes.tolist() == [ranks[row] for row in rows]


def test_lives_of_one_luck_have_one_number_in_all_cases():
    case, life = np.array([0, 0, 1, 1, 2]), np.array([5, 6, 6, 5, 5])
    assert numbers(np.full(5, 7), life, case).tolist() == [0, 1, 1, 0, 0]
    assert numbers(np.array([7, 7, 8, 8, 7]), life, case).tolist() == [0, 1, 3, 2, 0]


def test_lives_of_their_own_u_are_numbered_from_0_in_every_case():
    case, life = np.array([1, 0, 1, 0, 0]), np.array([9, 2, 8, 0, 1])
    assert numbers(np.zeros(5), life, case).tolist() == [1, 2, 0, 0, 1]


def test_a_design_is_paired_if_cases_have_a_seed_and_index_in_common():
    case = np.array([0, 0, 1, 1])
    assert paired(np.full(4, 7), np.array([0, 1, 1, 2]), case)
    assert not paired(np.full(4, 7), np.array([0, 1, 2, 3]), case)
    assert not paired(np.array([7, 7, 8, 8]), np.array([0, 1, 0, 1]), case)
    assert not paired(np.full(4, 7), np.array([0, 0, 1, 1]), case)


@pytest.mark.parametrize("hits", [0, 1, 13, 30])
def test_a_share_of_single_lives_has_wilsons_interval(hits):
    got = share_over(np.arange(30) < hits, each(30))
    theirs = stats.binomtest(hits, 30).proportion_ci(method="wilson")
    np.testing.assert_allclose(got, (hits / 30, theirs.low, theirs.high), atol=1e-12)


def test_a_share_counts_what_is_always_together_once():
    hits = np.arange(30) < 13
    thrice = share_over(np.tile(hits, 3), Sets(np.tile(np.arange(30), 3), 30, ""))
    np.testing.assert_allclose(thrice, share_over(hits, each(30)))
    assert np.isnan(share_over(hits, Sets(np.zeros(30, dtype=np.int64), 1, ""))[1:]).all()


def test_a_life_told_twice_in_a_case_keeps_its_number():
    case, life = np.array([0, 0, 0, 1]), np.array([3, 3, 4, 5])
    assert numbers(np.zeros(4), life, case).tolist() == [0, 0, 1, 0]


def test_seeds_of_64_bits_are_told_apart():
    seed = np.array([2**63 - 1, 2**63 - 2], dtype=np.uint64)
    assert numbers(seed, np.zeros(2), np.zeros(2, dtype=np.int64)).tolist() == [1, 0]


@pytest.mark.parametrize(
    ("lives", "cases", "compared", "what"),
    [
        (SETS_AT_LEAST, 3, True, LIVES),
        (SETS_AT_LEAST, 50, True, LIVES),
        (5, 50, True, COMBINATIONS),
        (5, 4, True, LIVES),
        (1, 4, True, COMBINATIONS),
        (100, 50, False, CASES),
        (100, 3, False, LIVES),
    ],
)
def test_what_is_fixed_is_not_drawn(lives, cases, compared, what):
    number, case = np.tile(np.arange(lives), cases), np.repeat(np.arange(cases), lives)
    assert sets_of(number, case, case if compared else None).what == what


def test_of_lives_alone_the_mean_has_the_bootstrap_interval():
    values = np.random.default_rng(1).exponential(9.0, 80)
    assert mean_over(values, each(80), resamples=299) == mean(values, resamples=299)


def test_lives_told_several_times_make_nobody_surer():
    values = np.random.default_rng(1).exponential(9.0, 40)
    thrice = Sets(np.tile(np.arange(40), 3), 40, "")
    np.testing.assert_allclose(
        mean_over(np.tile(values, 3), thrice, resamples=299),
        mean_over(values, each(40), resamples=299),
    )
    np.testing.assert_allclose(
        median_over(np.tile(values, 3), np.inf, thrice, resamples=299),
        median_over(values, np.inf, each(40), resamples=299),
    )


def test_cases_that_differ_do_not_make_the_luck_uncertain():
    """Two fixed cases, far apart: only what varies within them widens the interval."""
    rng = np.random.default_rng(2)
    near = np.concatenate([rng.normal(100.0, 1.0, 200), rng.normal(900.0, 1.0, 200)])
    got = mean_over(near, Sets(np.tile(np.arange(200), 2), 200, ""), resamples=299)
    assert got.value == pytest.approx(500.0, abs=0.2)
    assert got.high - got.low < 1.0


def test_the_interval_of_many_sets_is_that_of_the_bootstrap(monkeypatch):
    rng = np.random.default_rng(3)
    above, below = rng.exponential(3.0, 1000), rng.exponential(2.0, 1000) + 1
    drawn = ratio_over(above, below, each(1000))
    monkeypatch.setattr(resampling, "BOOTSTRAPPED_AT_MOST", 10)
    normal = ratio_over(above, below, each(1000))
    assert normal != drawn
    np.testing.assert_allclose(normal, drawn, rtol=0.01)


def test_what_is_not_known_is_left_out():
    values = np.array([1.0, np.nan, 3.0])
    assert mean_over(values, each(3), resamples=99).value == 2.0
    assert ratio_over(values, np.array([2.0, 5.0, 2.0]), each(3), resamples=99).value == 1.0
    assert np.isnan(mean_over(np.array([np.nan]), each(1))).all()
    assert np.isnan(ratio_over(np.ones(3), np.zeros(3), each(3))).all()


def test_a_single_set_gives_a_value_without_an_interval():
    one = Sets(np.zeros(4, dtype=np.int64), 1, "")
    values = np.array([1.0, 2.0, 3.0, 10.0])
    for got, value in (
        (mean_over(values, one), 4.0),
        (median_over(values, np.inf, one), 2.0),
        (quotient_over(values, one, values / 2, one), 2.0),
    ):
        assert got.value == value
        assert np.isnan(got[1:]).all()


def test_a_quotient_draws_together_what_is_in_one_set():
    luck = np.random.default_rng(4).exponential(1.0, 100)
    together = quotient_over(2 * luck, each(100), luck, each(100), resamples=199)
    np.testing.assert_allclose(together, 2.0)
    apart = quotient_over(
        2 * luck, Sets(np.arange(100), 200, ""), luck, Sets(np.arange(100, 200), 200, ""),
        resamples=199,
    )  # fmt: skip
    assert apart.value == pytest.approx(2.0)
    assert apart.low < 1.7
    assert apart.high > 2.3


@pytest.mark.parametrize("seed", range(4))
def test_the_median_has_scipys_percentile_interval(seed):
    steps = np.ceil(np.random.default_rng(seed).exponential(100.0, 101))
    theirs = stats.bootstrap(
        (steps,), np.median, method="percentile", n_resamples=4999, rng=np.random.default_rng(0)
    ).confidence_interval
    got = median_over(steps, np.inf, each(101), resamples=4999)
    assert got.value == np.median(steps)
    np.testing.assert_allclose(got[1:], theirs, atol=4.0)


def test_the_median_of_many_sets_has_the_interval_of_the_bootstrap(monkeypatch):
    steps = np.ceil(np.random.default_rng(5).exponential(1000.0, 900))
    drawn = median_over(steps, np.inf, each(900))
    monkeypatch.setattr(resampling, "BOOTSTRAPPED_AT_MOST", 10)
    np.testing.assert_allclose(median_over(steps, np.inf, each(900)), drawn, rtol=0.03)


def test_a_median_beyond_the_cap_is_infinite():
    steps = np.array([10.0, 20.0, 100.0, 100.0, 100.0])
    got = median_over(steps, 100.0, each(5), resamples=199)
    assert got.value == np.inf
    assert got.low < 100.0
    assert got.high == np.inf


def test_the_interval_covers_the_mean_about_as_often_as_it_says():
    """Luck that is shared by three cases, which differ: the mean over them, cases fixed."""
    rng = np.random.default_rng(6)
    scale, covered = np.array([1.0, 2.0, 5.0]), 0
    sets = Sets(np.tile(np.arange(60), 3), 60, "")
    for trial in range(120):
        luck = rng.exponential(1.0, 60)
        steps = (scale[:, None] * (0.5 * luck + 0.5 * rng.exponential(1.0, (3, 60)))).ravel()
        got = mean_over(steps, sets, seed=trial, resamples=299)
        covered += got.low <= scale.mean() <= got.high
    # 95 % of 120 is 114; fewer than 104 would happen once in some 10,000 times.
    assert covered >= 104

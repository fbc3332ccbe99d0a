import numpy as np
import pyarrow as pa
import pytest
from lifelines import KaplanMeierFitter
from lifelines.utils import restricted_mean_survival_time
from scipy import stats

from animat.statistics.estimates import of_means
from animat.statistics.factor_effects import factor_effect
from animat.statistics.lives import cell
from animat.statistics.resampling import CASES, COMBINATIONS, LIVES
from animat.statistics.sample import sample
from animat.statistics.survival import kaplan_meier, logrank

from .designs import crossed, lived

TWO = crossed(agent=["BLIND", "AF"], world=["rich", "poor"])


def ratio_of(one, other):
    """The ratio of mean lifespans of lives that stand in the same order in both tables."""
    spans = [table["lifespan"].to_numpy().astype(float) for table in (one, other)]
    return of_means(spans, np.divide, resamples=199)


def two_by_two(lives=40, effect=1.0, **given):
    scales = {"BLIND": 400.0, "AF": 400.0 * effect}
    worlds = {"rich": 1.0, "poor": 0.3}
    cases = [(one, scales[one["agent"]] * worlds[one["world"]]) for one in TWO]
    return lived(cases, lives, **given)


def of(table, name, factors=("agent", "world"), **given):
    return factor_effect(sample(table, factors), name, resamples=199, **given)


def test_a_level_holds_the_lives_of_all_other_levels():
    table = two_by_two(effect=2.0, cap=600)
    got = of(table, "agent")
    assert [one.label for one in got.levels] == ["BLIND", "AF"]
    for one in got.levels:
        rows = cell(table, agent=one.label)
        steps = rows.column("lifespan").to_numpy()
        ended = ~rows.column("censored").to_numpy()
        fitted = KaplanMeierFitter().fit(steps, ended)
        area = restricted_mean_survival_time(fitted, t=600)
        assert one.summary.lives == 80
        assert one.summary.alive == (~ended).sum()
        assert one.summary.mean.value == pytest.approx(area, rel=1e-9)
        assert one.summary.median.value == kaplan_meier(rows).median().value
        acts = rows.column("acts").to_numpy().sum()
        assert one.summary.success_rate.value == pytest.approx(
            rows.column("successes").to_numpy().sum() / acts
        )
        assert one.summary.stability.value == pytest.approx(
            rows.column("mean_drive").to_numpy().mean()
        )
        assert sum(death.count for death in one.summary.deaths) == 80


def test_means_are_restricted_where_the_first_life_was_let_go_whatever_its_level():
    early = lived([({"agent": "BLIND"}, 900.0)], 20, cap=500)
    late = lived([({"agent": "AF"}, 900.0)], 20, cap=2_000)
    got = of(pa.concat_tables([early, late]), "agent", ["agent"])
    assert [one.summary.cap for one in got.levels] == [500.0, 500.0]
    assert max(one.summary.mean.value for one in got.levels) <= 500.0


def test_of_one_factor_the_comparison_is_that_of_two_groups():
    table = two_by_two(effect=1.5).filter(pa.array([True] * 40 + [False] * 40 + [True] * 40
                                                   + [False] * 40))  # fmt: skip
    blind, af = cell(table, agent="BLIND"), cell(table, agent="AF")
    (got,) = of(table, "agent", ["agent"]).comparisons
    assert (got.level, got.reference, got.where, got.lives) == ("AF", "BLIND", "", 80)
    np.testing.assert_allclose(got.ratio, ratio_of(af, blind), rtol=1e-9)
    assert got.test.p == pytest.approx(logrank(af, blind).p, rel=1e-6)
    theirs = stats.mannwhitneyu(af.column("lifespan"), blind.column("lifespan")).statistic
    assert got.delta.value == pytest.approx(2 * theirs / 1600 - 1)


def test_levels_are_also_compared_in_each_of_a_few_combinations():
    table = two_by_two(effect=1.5)
    got = of(table, "agent")
    assert [one.where for one in got.comparisons] == ["", "world = rich", "world = poor"]
    rich = cell(table, world="rich")
    expected = ratio_of(cell(rich, agent="AF"), cell(rich, agent="BLIND"))
    np.testing.assert_allclose(got.comparisons[1].ratio, expected, rtol=1e-9)
    assert got.matched
    assert got.resampled == LIVES


def test_paired_lives_are_compared_within_their_pairs():
    table = two_by_two(effect=1.5, cap=600)
    (got, *_) = of(table, "agent").comparisons
    frame = table.to_pandas().set_index(["agent", "world", "life"]).lifespan
    difference = frame["AF"] - frame["BLIND"]
    assert got.paired is not None
    assert got.paired.pairs == 80
    assert got.paired.difference.value == pytest.approx(difference.mean())
    assert got.paired.outlives.value == pytest.approx((difference > 0).mean())
    assert got.paired.ties == pytest.approx((difference == 0).mean())
    assert got.paired.ties > 0


def test_lives_of_their_own_random_numbers_are_no_pairs():
    got = of(two_by_two(paired=False), "agent")
    assert got.matched
    assert all(one.paired is None for one in got.comparisons)


def test_a_level_without_partners_is_left_out_of_a_comparison_not_of_its_level():
    """A study that still runs: AF has not yet lived in the poor world, where lives are short."""
    table = two_by_two(effect=1.0, luck_counts=1.0).slice(0, 120)
    got = of(table, "agent")
    blind, af = got.levels
    assert af.summary.mean.value > 1.4 * blind.summary.mean.value
    (over_all,) = got.comparisons
    assert over_all.lives == 80
    assert over_all.ratio.value == pytest.approx(1.0)
    assert over_all.test.p == pytest.approx(1.0)


def test_many_cases_with_few_lives_are_drawn_by_their_combinations():
    cases = crossed(agent=["BLIND", "AF"], place=list("abcdefghijklmnopqrstuvwxyz"))
    table = lived([(one, 300.0) for one in cases], 2)
    got = of(table, "agent", ["agent", "place"])
    assert got.resampled == COMBINATIONS
    assert [one.where for one in got.comparisons] == [""]


def spread(points=64, lives=3, effect=0.0, seed=0):
    """A sample of points: two numbers drawn, and a word."""
    rng = np.random.default_rng(seed)
    cases = []
    for _ in range(points):
        x, y = rng.random(2)
        word = str(rng.choice(["clamp", "lethal"]))
        cases.append(({"x": x, "y": y, "word": word}, 300.0 * np.exp(effect * x + 1.5 * y)))
    return lived(cases, lives, seed=seed, cap=10**6)


def test_a_range_is_tested_by_rank_over_the_cases():
    table = spread(effect=2.0)
    got = of(table, "x", ["x", "y", "word"])
    frame = table.to_pandas().groupby("case").agg({"x": "first", "lifespan": "mean"})
    theirs = stats.spearmanr(frame.x, frame.lifespan)
    assert got.test.name == "Spearman"
    assert got.test.statistic == pytest.approx(theirs.statistic)
    assert got.test.p == pytest.approx(theirs.pvalue)
    assert len(got.levels) == 4
    assert got.resampled == CASES
    assert not got.confounded


def test_words_of_a_sample_are_compared_over_the_cases():
    table = spread()
    got = of(table, "word", ["x", "y", "word"])
    frame = table.to_pandas().groupby("case").agg({"word": "first", "lifespan": "mean"})
    theirs = stats.kruskal(*(group.lifespan for _, group in frame.groupby("word")))
    assert got.test.name == "Kruskal-Wallis"
    assert got.test.p == pytest.approx(theirs.pvalue)
    assert not got.matched


def test_lives_of_one_case_are_not_taken_for_so_many_findings():
    """What another factor does, and chance dealt unevenly, must not be called this one's effect."""
    called = 0
    for seed in range(40):
        table = spread(points=24, lives=20, seed=seed)
        called += of(table, "word", ["x", "y", "word"]).test.p < 0.05
    assert called <= 7  # 5 % of 40 are 2; 8 and more would come once in some 1,000 times


def test_levels_that_differ_in_another_factor_too_are_confounded():
    table = lived([({"a": "x", "b": 1}, 300.0), ({"a": "y", "b": 2}, 300.0)], 30)
    got = of(table, "a", ["a", "b"])
    assert got.confounded
    assert not got.matched


def test_cases_that_share_their_lives_count_once():
    """A margin without effect under one physiology: four cases there are the same lives."""
    base = two_by_two(effect=1.4)
    copies = []
    for margin_ in (0.01, 0.02, 0.05):
        column = pa.array([margin_] * base.num_rows)
        same = base.column("case")
        copies.append(base.append_column("margin", column).append_column("same_as", same))
    table = pa.concat_tables(copies)
    once, thrice = of(base, "agent"), of(table, "agent", ["agent", "world", "margin"])
    assert thrice.test.statistic == pytest.approx(once.test.statistic)
    np.testing.assert_allclose(thrice.levels[0].summary.mean, once.levels[0].summary.mean)
    np.testing.assert_allclose(thrice.comparisons[0].ratio, once.comparisons[0].ratio)
    without_effect = of(table, "margin", ["agent", "world", "margin"])
    assert without_effect.test.p == pytest.approx(1.0)
    assert without_effect.comparisons[0].ratio == (1.0, 1.0, 1.0)


def test_lives_of_one_case_each_are_told_without_more_certainty_than_there_is():
    got = of(two_by_two(lives=1), "agent")
    assert got.levels[0].summary.lives == 2
    assert got.comparisons[0].ratio.value > 0


def test_without_a_death_there_is_nothing_to_tell_apart():
    table = two_by_two(cap=1)
    got = of(table, "agent")
    assert got.test.p == 1.0
    assert got.comparisons[0].ratio == (1.0, 1.0, 1.0)
    assert got.comparisons[0].delta.value == 0.0
    assert got.levels[0].summary.median.value == np.inf


def test_further_columns_have_their_means():
    table = two_by_two()
    table = table.append_column("likelihood", pa.array(np.arange(160.0)))
    got = of(table, "agent", measures=["likelihood"])
    assert [one.measures["likelihood"].value for one in got.levels] == [39.5, 119.5]


def test_no_life_is_nothing_to_report_on():
    with pytest.raises(ValueError, match="no life"):
        sample(two_by_two().slice(0, 0), ["agent"])

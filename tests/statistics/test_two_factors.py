import numpy as np
import pyarrow as pa
import pytest
from lifelines import KaplanMeierFitter
from lifelines.utils import restricted_mean_survival_time
from scipy import stats

from animat.statistics.resampling import COMBINATIONS, LIVES
from animat.statistics.sample import sample
from animat.statistics.two_factors import interactions

from .designs import crossed, lived

EFFECTS = [0.1, 0.4]
TWO = crossed(agent=["BLIND", "AF"], effect=EFFECTS)


def scale(case, boost=1.0):
    """Steps: AF lives three times as long, and `boost` times that at the largest effect."""
    steps = (
        300.0 * (3.0 if case.get("agent") == "AF" else 1.0) / (1.0 + (case.get("effect") or 0.0))
    )
    return steps * (boost if case.get("agent") == "AF" and case.get("effect") == 0.4 else 1.0)


def table(cases=TWO, lives=40, boost=1.0, **given):
    return lived([(case, scale(case, boost)) for case in cases], lives, **given)


def of(lives, names=("agent", "effect"), factors=None, resamples=99):
    return interactions(sample(lives, factors or names), names, resamples=resamples)


def cells(lives, *names):
    return lives.to_pandas().pivot_table(
        index="life", columns=list(names), values="lifespan", sort=False
    )


@pytest.mark.parametrize("paired", [True, False])
def test_of_two_by_two_it_is_students_test_of_the_difference_of_differences(paired):
    lives = table(boost=0.6, paired=paired)
    (got,) = of(lives)
    frame = lives.append_column("place", pa.array(list(range(40)) * 4)).to_pandas()
    wide = frame.pivot_table(index="place", columns=["agent", "effect"], values="lifespan")
    each = (wide["AF"][0.4] - wide["BLIND"][0.4]) - (wide["AF"][0.1] - wide["BLIND"][0.1])
    theirs = stats.ttest_1samp(each, 0.0)
    (contrast,) = got.contrasts
    assert contrast.first == ("AF", "BLIND")
    assert contrast.second == ("0.4", "0.1")
    low, high = theirs.confidence_interval()
    np.testing.assert_allclose(contrast.difference, (each.mean(), low, high))
    assert contrast.difference_p == pytest.approx(theirs.pvalue)
    assert got.differences.p == pytest.approx(theirs.pvalue)
    assert got.resampled == LIVES


def test_censored_lives_count_as_in_restricted_means():
    lives = table(cap=500)
    (got,) = of(lives)
    area = {}
    for (agent, effect), rows in lives.to_pandas().groupby(["agent", "effect"]):
        fitted = KaplanMeierFitter().fit(rows.lifespan, ~rows.censored)
        area[agent, effect] = restricted_mean_survival_time(fitted, t=500)
        place = got.first.levels.index(agent), got.second.levels.index(str(effect))
        assert got.means[place].value == pytest.approx(area[agent, effect])
    (contrast,) = got.contrasts
    assert contrast.difference.value == pytest.approx(
        area["AF", 0.4] - area["BLIND", 0.4] - area["AF", 0.1] + area["BLIND", 0.1]
    )
    assert contrast.ratio.value == pytest.approx(
        area["AF", 0.4] / area["BLIND", 0.4] / (area["AF", 0.1] / area["BLIND", 0.1])
    )


def test_the_ratio_has_about_the_interval_of_the_bootstrap():
    lives = table(boost=0.6, lives=80)
    columns = cells(lives, "agent", "effect").to_numpy().T

    def ratio(blind_low, blind_high, af_low, af_high, axis):
        a, b, c, d = (each.mean(axis) for each in (blind_low, blind_high, af_low, af_high))
        return np.log(d / b / (c / a))

    theirs = stats.bootstrap(
        tuple(columns), ratio, paired=True, vectorized=True, rng=np.random.default_rng(2)
    ).confidence_interval
    got = of(lives)[0].contrasts[0].ratio
    np.testing.assert_allclose(np.log(got[1:]), theirs, atol=0.06)


def test_equal_ratios_of_unequal_lives_interact_on_one_scale_alone():
    cases = crossed(agent=["BLIND", "AF"], effect=[0.0, 9.0])
    (got,) = of(table(cases, lives=200))
    assert got.differences.p < 1e-6
    assert got.ratios.p > 0.01
    assert got.contrasts[0].ratio.low < 1.0 < got.contrasts[0].ratio.high


def test_of_more_levels_there_is_one_test_and_a_contrast_for_each():
    cases = crossed(agent=["BLIND", "AF", "ORACLE"], effect=[0.1, 0.2, 0.4, None])
    (got,) = of(table(cases))
    assert got.differences.freedom == got.ratios.freedom == 6
    assert [one.second[0] for one in got.contrasts] == ["0.2", "0.4", "not set"] * 2
    np.testing.assert_array_equal(got.second.places, [0.1, 0.2, 0.4, np.nan])
    assert got.first.places is None
    turned = of(table(cases), ("effect", "agent"), ["agent", "effect"])[0]
    assert turned.differences.p == pytest.approx(got.differences.p)
    assert turned.contrasts[0].difference.value == pytest.approx(got.contrasts[0].difference.value)


def test_a_grid_of_many_numbers_has_every_one_of_them():
    cases = crossed(agent=["BLIND", "AF"], effect=[k / 10 for k in range(10)])
    (got,) = of(table(cases))
    assert len(got.second.levels) == 10
    assert got.second.places == tuple(k / 10 for k in range(10))
    assert got.differences.freedom == 9


def test_within_blocks_only_complete_ones_count_and_all_alike():
    cases = crossed(world=["poor", "rich"], agent=["BLIND", "AF"], effect=EFFECTS)
    rich = 100.0
    lives = lived(
        [(c, scale(c) * (rich if c["world"] == "rich" else 1.0)) for c in cases], 30, cap=10**6
    )
    (whole,) = of(lives, factors=["world", "agent", "effect"])
    assert (whole.blocks, whole.incomplete) == (2, 0)
    # A study that still runs: the last lives of the last case, and then that case, are missing.
    (some,) = of(lives.slice(0, 225), factors=["world", "agent", "effect"])
    frame = lives.slice(0, 225).to_pandas().groupby(["world", "agent", "effect"]).lifespan.mean()
    expected = frame.groupby(["agent", "effect"]).mean()
    assert some.means[1, 1].value == pytest.approx(expected["AF", 0.4])
    (half,) = of(lives.slice(0, 210), factors=["world", "agent", "effect"])
    assert (half.blocks, half.incomplete) == (1, 1)
    poor = lives.to_pandas().query("world == 'poor'").groupby(["agent", "effect"]).lifespan.mean()
    assert half.means[1, 1].value == pytest.approx(poor["AF", 0.4])


def test_of_a_design_that_leaves_cells_out_the_rest_is_tested():
    cases = [c for c in crossed(agent=["BLIND", "AF", "ORACLE"], effect=[0.1, 0.2, 0.4])
             if (c["agent"], c["effect"]) not in {("BLIND", 0.1), ("ORACLE", 0.4)}]  # fmt: skip
    (got,) = of(table(cases))
    assert len(got.means) == 7
    # The first level with most of its cells is what the others are compared with.
    assert {(one.first, one.second) for one in got.contrasts} == {
        (("BLIND", "AF"), ("0.4", "0.2")),
        (("ORACLE", "AF"), ("0.1", "0.2")),
    }


def test_factors_that_are_not_crossed_are_not_tested():
    rng = np.random.default_rng(0)
    words = rng.choice(["a", "b"], (40, 2)).tolist()
    points = [{"x": x, "word": one, "sign": other}
              for x, (one, other) in zip(rng.random(40).tolist(), words, strict=True)]  # fmt: skip
    assert of(lived([(p, 300.0) for p in points], 5), ("x", "word", "sign")) == ()
    nested = [{"a": "x", "b": 1}, {"a": "x", "b": 2}, {"a": "y", "b": 3}, {"a": "y", "b": 4}]
    assert of(lived([(p, 300.0) for p in nested], 5), ("a", "b")) == ()
    assert of(table(TWO[:3])) == ()
    assert of(table(), ("agent",), ["agent", "effect"]) == ()


def test_few_lives_in_many_blocks_are_drawn_by_their_blocks():
    cases = crossed(place=list(range(25)), agent=["BLIND", "AF"], effect=EFFECTS)
    lives = table(cases, lives=3)
    (got,) = of(lives, factors=["place", "agent", "effect"])
    assert got.resampled == COMBINATIONS
    wide = lives.to_pandas().pivot_table(
        index="place", columns=["agent", "effect"], values="lifespan"
    )
    each = wide["AF"][0.4] - wide["BLIND"][0.4] - wide["AF"][0.1] + wide["BLIND"][0.1]
    assert got.differences.p == pytest.approx(stats.ttest_1samp(each, 0.0).pvalue)


def test_lives_that_cases_share_do_not_interact_and_count_once():
    """A setting without effect on BLIND: its cases there are the same lives."""
    lives = table(boost=0.7)
    blind = lives.slice(0, 40)
    copy = blind.set_column(blind.column_names.index("effect"), "effect", pa.array([0.4] * 40))
    shared = pa.concat_tables([blind, copy, lives.slice(80)])
    same = pa.array([0] * 80 + [2] * 40 + [3] * 40)
    (got,) = of(shared.append_column("same_as", same))
    rows = lives.to_pandas().lifespan.to_numpy().reshape(4, 40)
    theirs = stats.ttest_1samp(rows[3] - rows[2], 0.0)
    assert got.differences.p == pytest.approx(theirs.pvalue)


def test_a_life_to_a_cell_tells_nothing_of_chance():
    (got,) = of(table(lives=1))
    assert np.isnan(got.differences.p)
    (contrast,) = got.contrasts
    assert np.isfinite(contrast.ratio.value)
    assert np.isnan(contrast.ratio[1:]).all()


def test_intervals_hold_the_truth_and_tests_cry_wolf_about_as_often_as_they_say():
    """Two places that do not differ, lives censored at the cap."""
    cases = crossed(agent=["BLIND", "AF"], place=["a", "b"])
    held, called = np.zeros(2), np.zeros(2)
    for trial in range(80):
        lives = lived([(c, scale(c)) for c in cases], 30, cap=700, seed=trial)
        (got,) = of(lives, ("agent", "place"), resamples=9)
        held += [
            got.contrasts[0].difference.low <= 0.0 <= got.contrasts[0].difference.high,
            got.contrasts[0].ratio.low <= 1.0 <= got.contrasts[0].ratio.high,
        ]
        called += [got.differences.p < 0.05, got.ratios.p < 0.05]
    # 95 % of 80 is 76; fewer than 68 would happen once in some 2,000 times.
    assert held.min() >= 68
    np.testing.assert_array_equal(called, 80 - held)

import math

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.statistics.findings import CASES_AT_MOST, find, holm

from .designs import crossed, lived

FACTORS = ("agent", "world")


@pytest.fixture(scope="module")
def table():
    scales = {"BLIND": 300.0, "AF": 600.0}
    cases = crossed(agent=["BLIND", "AF"], world=["rich", "poor"])
    return lived([(one, scales[one["agent"]]) for one in cases], 30)


@pytest.fixture(scope="module")
def found(table):
    return find(table, FACTORS, resamples=99)


def test_every_factor_and_every_case_is_told(found):
    assert [effect.factor.name for effect in found.effects] == list(FACTORS)
    assert [one.summary.cell for one in found.cases] == [
        ("BLIND", "rich"), ("BLIND", "poor"), ("AF", "rich"), ("AF", "poor"),
    ]  # fmt: skip
    assert found.overall.summary.lives == 120
    assert sum(one.summary.lives for one in found.cases) == 120


def test_p_values_are_corrected_over_all_of_their_kind(found):
    tests = [effect.test.p for effect in found.effects]
    np.testing.assert_allclose(found.factors_p, holm(tests))
    levels = [one.test.p for effect in found.effects for one in effect.comparisons]
    np.testing.assert_allclose(found.levels_p, holm(levels))


def test_acts_are_told_by_behaviour(table, found):
    acts, share = found.by_behaviour["eat"]
    assert acts == sum(table.column("acts_eat").to_pylist())
    assert share.value == pytest.approx(sum(table.column("successes_eat").to_pylist()) / acts)


def test_only_the_factors_asked_for_are_told(table):
    found = find(table, FACTORS, by=["world"], resamples=99)
    assert [effect.factor.name for effect in found.effects] == ["world"]
    assert len(found.cases) == 4


def test_a_factor_that_does_not_vary_is_not_told(table):
    blind = table.filter(pa.array([True] * 60 + [False] * 60))
    found = find(blind, FACTORS, resamples=99)
    assert [effect.factor.name for effect in found.effects] == ["world"]
    assert found.cases == ()


def test_one_case_is_told_alone(table):
    found = find(table.slice(0, 30), FACTORS, resamples=99)
    assert found.effects == found.cases == ()
    assert found.overall.summary.mean.low < found.overall.summary.mean.value


def test_many_cases_are_not_told_one_by_one():
    cases = crossed(a=list(range(5)), b=list(range(5)))
    assert len(cases) > CASES_AT_MOST
    found = find(lived([(one, 300.0) for one in cases], 2), ["a", "b"], resamples=99)
    assert found.cases == ()
    assert len(found.effects) == 2


def test_lives_that_all_went_on_have_no_death():
    table = lived([({"agent": "BLIND"}, 300.0), ({"agent": "AF"}, 300.0)], 5, cap=1)
    found = find(table, ["agent"], resamples=99)
    assert found.deaths == 0
    assert math.isinf(found.overall.summary.median.value)


def test_the_same_lives_give_the_same_numbers(table, found):
    again = find(table, FACTORS, resamples=99)
    assert again.overall.summary == found.overall.summary
    assert again.effects[0].comparisons == found.effects[0].comparisons


ps = st.lists(st.floats(0.0, 1.0), min_size=1, max_size=12)


@given(ps, st.floats(0.001, 0.999))
def test_it_rejects_what_holms_procedure_rejects(p, level):
    """The procedure itself: go up from the smallest p, stop at the first above level / left."""
    order = sorted(range(len(p)), key=lambda k: p[k])
    rejected = set()
    for done, k in enumerate(order):
        if p[k] * (len(p) - done) > level:
            break
        rejected.add(k)
    assert set(np.flatnonzero(holm(p) <= level)) == rejected


def test_a_test_that_could_not_be_made_does_not_count():
    np.testing.assert_allclose(holm([0.01, np.nan, 0.04]), [0.02, np.nan, 0.04])
    assert np.isnan(holm([np.nan])).all()
    assert holm([]).size == 0

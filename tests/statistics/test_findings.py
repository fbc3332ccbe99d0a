import math

import numpy as np
import pyarrow as pa
import pytest

from animat.statistics.findings import CASES_AT_MOST, find
from animat.statistics.multiple import holm

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
    assert [margin.factor.name for margin in found.margins] == list(FACTORS)
    assert [one.summary.cell for one in found.cases] == [
        ("BLIND", "rich"), ("BLIND", "poor"), ("AF", "rich"), ("AF", "poor"),
    ]  # fmt: skip
    assert found.overall.summary.lives == 120
    assert sum(one.summary.lives for one in found.cases) == 120


def test_p_values_are_corrected_over_all_of_their_kind(found):
    tests = [margin.test.p for margin in found.margins]
    np.testing.assert_allclose(found.factors_p, holm(tests))
    levels = [one.test.p for margin in found.margins for one in margin.comparisons]
    np.testing.assert_allclose(found.levels_p, holm(levels))


def test_acts_are_told_by_behaviour(table, found):
    acts, share = found.by_behaviour["eat"]
    assert acts == sum(table.column("acts_eat").to_pylist())
    assert share.value == pytest.approx(sum(table.column("successes_eat").to_pylist()) / acts)


def test_only_the_factors_asked_for_are_told(table):
    found = find(table, FACTORS, by=["world"], resamples=99)
    assert [margin.factor.name for margin in found.margins] == ["world"]
    assert len(found.cases) == 4


def test_a_factor_that_does_not_vary_is_not_told(table):
    blind = table.filter(pa.array([True] * 60 + [False] * 60))
    found = find(blind, FACTORS, resamples=99)
    assert [margin.factor.name for margin in found.margins] == ["world"]
    assert found.cases == ()


def test_one_case_is_told_alone(table):
    found = find(table.slice(0, 30), FACTORS, resamples=99)
    assert found.margins == found.cases == ()
    assert found.overall.summary.mean.low < found.overall.summary.mean.value


def test_many_cases_are_not_told_one_by_one():
    cases = crossed(a=list(range(5)), b=list(range(5)))
    assert len(cases) > CASES_AT_MOST
    found = find(lived([(one, 300.0) for one in cases], 2), ["a", "b"], resamples=99)
    assert found.cases == ()
    assert len(found.margins) == 2


def test_lives_that_all_went_on_have_no_death():
    table = lived([({"agent": "BLIND"}, 300.0), ({"agent": "AF"}, 300.0)], 5, cap=1)
    found = find(table, ["agent"], resamples=99)
    assert found.deaths == 0
    assert math.isinf(found.overall.summary.median.value)


def test_the_same_lives_give_the_same_numbers(table, found):
    again = find(table, FACTORS, resamples=99)
    assert again.overall.summary == found.overall.summary
    assert again.margins[0].comparisons == found.margins[0].comparisons

import pytest

from animat.report.comparison_methods import WORDS, statistics_words
from animat.statistics.findings import find

from ..statistics.designs import crossed, lived


def said(cases, lives, factors, **given):
    return " ".join(statistics_words(find(lived(cases, lives, **given), factors), "1.2.3"))


def test_only_what_was_done_is_told():
    cases = [(one, 300.0) for one in crossed(agent=["BLIND", "AF"], world=["rich", "poor"])]
    text = said(cases, 25, ["agent", "world"])
    assert WORDS["stratified log-rank"] in text
    assert "Kruskal" not in text
    assert "Spearman" not in text
    assert "2 tests of factors" in text
    assert "within single combinations by the log-rank test" in text
    assert "6 comparisons" in text
    assert "2 tests of interactions and for the 2 tests of contrasts" in text
    assert "matched-pairs rank-biserial" in text
    assert "Cliff's delta" not in text
    assert "SciPy 1.2.3" in text
    assert "sets of lives" in text
    assert "every life ended" in text.lower()


def test_of_a_single_factor_the_test_has_no_strata():
    text = said([({"agent": name}, 300.0) for name in ("BLIND", "AF")], 25, ["agent"])
    assert "were tested by the log-rank test. Effect" in text


def test_without_pairs_effect_sizes_are_not_told_as_paired():
    cases = [({"agent": name}, 300.0) for name in ("BLIND", "AF")]
    text = said(cases, 25, ["agent"], paired=False)
    assert "Cliff's delta" in text
    assert "within pairs" not in text
    assert "interaction" not in text


def test_a_range_is_told_as_it_was_tested():
    cases = [({"gap": k / 30}, 300.0) for k in range(30)]
    text = said(cases, 3, ["gap"])
    assert WORDS["Spearman"] in text
    assert "cases, each with all its lives" in text


def test_where_nothing_was_compared_no_test_is_told():
    assert "Holm" not in said([({}, 300.0)], 20, [])
    assert "Holm" not in said([({"a": k}, 300.0) for k in (1, 2)], 9, ["a"], cap=1)


@pytest.mark.parametrize("cap", [100, 10**6])
def test_the_restriction_is_told(cap):
    text = said([({}, 300.0)], 20, [], cap=cap)
    assert ("up to 100 steps" in text) == (cap == 100)

import numpy as np
import pytest

from animat.report import interaction_sections as two_factor_sections
from animat.report.interaction_sections import interaction_sections, interactions_in_short
from animat.report.page import p_value
from animat.statistics.findings import find, holm

from ..statistics.designs import crossed, lived


def found_of(cases, scale, lives=25, **given):
    names = list(cases[0])
    return find(lived([(c, scale(c)) for c in cases], lives, **given), names, resamples=99)


@pytest.fixture(scope="module")
def found():
    cases = crossed(agent=["BLIND", "AF"], effect=[0.1, 0.2, 0.4])
    return found_of(cases, lambda c: 900.0 if c == {"agent": "AF", "effect": 0.1} else 200.0)


def test_an_interaction_is_told_in_short_with_its_scales(found):
    (said,) = interactions_in_short(found)
    assert said.startswith("Interactions of two factors: agent by effect, on ")
    assert said.endswith("after correction for 2 tests.")


def test_what_is_not_shown_is_not_said_to_be_absent():
    (said,) = interactions_in_short(found_of(crossed(a=["x", "y"], b=["v", "w"]), lambda _: 300.0))
    assert said == "Interactions of two factors: none shown, after correction for 2 tests."


def test_p_values_are_corrected_over_both_scales(found):
    (one,) = found.interactions
    expected = holm([one.differences.p, one.ratios.p])
    np.testing.assert_allclose(found.interactions_p, [expected])
    each = holm([p for c in one.contrasts for p in (c.difference_p, c.ratio_p)])
    np.testing.assert_allclose(np.ravel(found.contrasts_p), each)
    _, section = interaction_sections(found)
    shown = [p for row in section.tables[1].rows for p in (row[3], row[5])]
    assert shown == [p_value(p) for p in each]
    assert "corrected for the 4 tests" in section.tables[1].note


def test_an_interaction_has_its_means_its_contrasts_and_a_picture(found):
    overview, section = interaction_sections(found)
    assert overview.tables[0].rows[0][0] == section.title == "agent by effect"
    means, contrasts = section.tables
    assert [row[0] for row in means.rows] == ["BLIND", "AF"]
    assert list(means.columns) == ["agent", "0.1", "0.2", "0.4"]
    assert contrasts.rows[0][:2] == ("AF against BLIND", "0.2 against 0.1")
    (picture,) = section.pictures
    assert "95% interval at each level of effect, a line for each level of agent" in picture.caption


def test_of_many_pairs_the_surest_have_parts_and_all_have_a_row(monkeypatch):
    monkeypatch.setattr(two_factor_sections, "SHOWN_AT_MOST", 1)
    cases = crossed(c=["x", "y"], d=["x", "y"], e=["x", "y"])
    found = found_of(cases, lambda c: 900.0 if c["d"] == c["e"] else 200.0)
    overview, section = interaction_sections(found)
    assert [row[0] for row in overview.tables[0].rows] == ["c by d", "c by e", "d by e"]
    assert section.title == "d by e"


def test_pairs_that_are_not_crossed_are_said_to_be_left_out():
    cases = [{"a": a, "b": b, "c": b + "!"} for a in "xy" for b in "vw"]
    found = found_of(cases, lambda _: 300.0)
    assert interaction_sections(found) == []
    cases = [c | {"e": 0} for c in crossed(a=["x", "y"], b=["v", "w"])]
    cases.append({"a": "x", "b": "v", "e": 1})
    overview, *_ = interaction_sections(found_of(cases, lambda _: 300.0))
    assert any("2 of the 3 pairs of factors are not tested" in p for p in overview.paragraphs)


def test_of_too_few_lives_it_is_said_that_there_is_no_test():
    found = found_of(crossed(a=["x", "y"], b=["u", "v", "w"]), lambda _: 300.0, lives=2)
    overview, _ = interaction_sections(found)
    assert overview.tables[0].rows[0][1] == "–"
    assert "A dash" in overview.tables[0].note
    assert interactions_in_short(found) == []


def test_where_nobody_died_nothing_is_compared():
    found = found_of(crossed(a=["x", "y"], b=["v", "w"]), lambda _: 300.0, cap=1)
    assert found.interactions == ()
    assert interaction_sections(found) == []

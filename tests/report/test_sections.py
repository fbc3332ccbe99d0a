import numpy as np
import pyarrow as pa
import pytest

from animat.report.blocks import COLUMNS_AT_MOST
from animat.report.page import p_value, write_page
from animat.report.sections import CONFOUNDED, NOBODY_DIED, in_short, result_sections
from animat.statistics.findings import find

from ..statistics.designs import crossed, lived

pytestmark = pytest.mark.usefixtures("undrawn")


def titles(found):
    return [section.title for section in result_sections(found)]


@pytest.fixture(scope="module")
def found():
    scales = {"BLIND": 200.0, "AF": 600.0}
    cases = crossed(agent=["BLIND", "AF"], world=["rich", "poor"])
    table = lived([(one, scales[one["agent"]]) for one in cases], 25, cap=1_500)
    return find(table, ["agent", "world"], resamples=99)


def test_the_page_has_a_part_for_all_lives_the_cases_the_factors_and_each_factor(found):
    assert titles(found) == [
        "All lives", "The cases", "The factors", "agent", "world",
        "Interactions of two factors", "agent by world",
    ]  # fmt: skip


def test_the_short_of_it_tells_most_of_what_matters_most(found):
    whole, first, second, both = in_short(found)
    assert f"of {found.overall.summary.lives} lives ended" in whole
    assert first.startswith("agent: mean lifespans from")
    assert "stratified log-rank p" in first
    assert second.startswith("world: no difference shown")
    assert both.startswith("Interactions of two factors: none shown")


def test_a_factor_has_its_levels_its_comparisons_and_its_endings(found):
    section = result_sections(found)[3]
    levels, comparisons, endings = section.tables
    assert [row[0] for row in levels.rows] == ["BLIND", "AF"]
    assert levels.rows[0][1] == "50"
    assert comparisons.rows[0][:2] == ("AF against BLIND", "over all")
    assert list(endings.columns) == ["", "BLIND", "AF"]
    assert {row[0] for row in endings.rows} == {
        "nutrition too low, failure", "nutrition too low, metabolism", "alive at the cap",
    }  # fmt: skip
    assert len(section.pictures) == 2
    assert all(each.alternative for each in section.pictures)


@pytest.mark.parametrize(("paired", "size"), [(True, "Rank-biserial"), (False, "Cliff's delta")])
def test_effect_sizes_are_paired_where_the_design_is(paired, size):
    cases = [({"agent": name}, 300.0) for name in ("BLIND", "AF")]
    found = find(lived(cases, 20, paired=paired), ["agent"], resamples=99)
    comparisons = result_sections(found)[1].tables[1]
    assert {"Rank-biserial", "Cliff's delta"} & set(comparisons.columns) == {size}
    assert all(len(row) == len(comparisons.columns) for row in comparisons.rows)
    assert ("seed and index" in comparisons.note) == paired


def test_corrected_p_values_stand_beside_their_own_comparison(found):
    sections = result_sections(found)
    shown = [row[-1] for section in sections[3:5] for row in section.tables[1].rows]
    assert shown == [p_value(p) for p in found.levels_p]


def test_lives_that_all_went_on_are_not_compared_by_their_length():
    table = lived([({"agent": "BLIND"}, 300.0), ({"agent": "AF"}, 300.0)], 5, cap=1)
    found = find(table, ["agent"], resamples=99)
    whole, agent = result_sections(found)
    assert NOBODY_DIED in whole.notices
    assert len(agent.tables) == 1
    assert list(agent.pictures) == list(whole.pictures) == []
    assert len(in_short(found)) == 1


def test_levels_that_live_alike_have_one_number_in_short():
    table = lived([({"agent": "BLIND"}, 1e9), ({"agent": "AF"}, 1e9)], 5, cap=50)
    place = table.column_names.index("censored")
    table = table.set_column(place, "censored", pa.array([False] + [True] * 9))
    said = in_short(find(table, ["agent"], resamples=99))[1]
    assert said.startswith("agent: no difference shown; mean lifespan 50 steps at every level")


def test_a_single_case_has_its_curve_with_all_lives():
    found = find(lived([({}, 300.0)], 20), [], resamples=99)
    (whole,) = result_sections(found)
    assert len(whole.pictures) == 2


def test_a_range_has_a_trend_and_quarters():
    rng = np.random.default_rng(1)
    cases = [({"gap": float(x)}, 200.0 + 900.0 * x) for x in rng.random(30)]
    found = find(lived(cases, 2), ["gap"], resamples=99)
    _, gap = result_sections(found)
    assert len(gap.tables[0].rows) == 4
    assert len(gap.pictures) == 3
    assert "cases" in gap.paragraphs[0]
    assert "Spearman" in in_short(found)[1]


def test_many_levels_are_cut_and_it_is_said():
    cases = [({"place": f"place {k:02}"}, 300.0) for k in range(50)]
    found = find(lived(cases, 2), ["place"], resamples=99)
    place = result_sections(found)[1]
    assert len(place.tables[0].rows) == 40
    assert "first and the last 20 of 50" in place.tables[0].note
    assert place.tables[0].rows[-1][0] == "place 49"
    assert list(place.pictures) == []


def test_of_many_levels_rare_ways_to_die_are_put_together():
    table = lived([({"place": f"place {k}"}, 300.0) for k in range(8)], 8)
    causes = [f"cause {k % 8}" for k in range(64)]
    place = table.column_names.index("death_cause")
    table = table.set_column(place, "death_cause", pa.array(causes))
    endings = result_sections(find(table, ["place"], resamples=99))[1].tables[2]
    assert len(endings.columns) == 1 + COLUMNS_AT_MOST + 1
    assert endings.columns[-1] == "otherwise"
    assert len(endings.rows) == 8
    assert all(row[-1].startswith("25.0%") for row in endings.rows)


def test_likelihoods_have_a_row_for_each_network_and_object():
    table = lived([({"agent": "BLIND"}, 300.0), ({"agent": "AF"}, 300.0)], 5)
    values = pa.array([None] * 5 + [0.25] * 5, pa.float64())
    table = table.append_column("likelihood_eat_TS", values)
    found = find(table, ["agent"], measures=["likelihood_eat_TS"], resamples=99)
    networks = result_sections(found)[1].tables[-1]
    assert list(networks.columns)[1:] == ["BLIND", "AF"]
    assert [tuple(row) for row in networks.rows] == [("eat TS", "–", "0.25")]


def test_what_cannot_be_told_apart_is_said_loudly():
    table = lived([({"a": "x", "b": "y"}, 300.0), ({"a": "z", "b": "w"}, 300.0)], 25)
    found = find(table, ["a", "b"], resamples=99)
    sections = result_sections(found)
    assert all(said.endswith("confounded with other factors.") for said in in_short(found)[1:])
    assert all(CONFOUNDED in section.notices for section in sections if section.title in "ab")


def test_lives_one_to_a_case_make_a_page(tmp_path):
    cases = crossed(agent=["BLIND", "AF"], world=["rich", "poor"])
    found = find(lived([(one, 300.0) for one in cases], 1), ["agent", "world"], resamples=99)
    write_page(
        tmp_path / "page.html", title="t", sections=result_sections(found), lead=in_short(found)
    )
    assert "BLIND" in (tmp_path / "page.html").read_text("utf-8")

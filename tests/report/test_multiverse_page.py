import json
import re

import pyarrow.parquet as pq
import pytest
from pyarrow import csv

from animat.report.multiverse_page import FIGURES, publish
from animat.report.multiverse_tables import sets_table, shares_table
from animat.statistics.claims import CLAIMS
from animat.statistics.estimates import share
from animat.statistics.sufficient_sets import Condition, Confirmation, SufficientSet


@pytest.fixture(scope="module")
def page(lived) -> str:
    return (lived.directory / "report.html").read_text("utf-8")


def test_the_page_has_all_in_it_and_fetches_nothing(page, lived):
    assert page.count("<figure>") == len(FIGURES)
    assert not re.search(r'(src|href)="(?!data:|#)', page)
    for title in ("How often each claim holds", "The smallest sets of readings", "The universes"):
        assert title in page
    assert f"{lived.found.table.num_rows:,} universes" in page
    assert "mind.physiology" in page
    for rule in lived.found.study.design.exclude:
        assert rule.why in page


def test_tables_and_figures_stand_beside_it(lived):
    found, directory = lived.found, lived.directory
    assert pq.read_table(directory / "universes.parquet").equals(found.table)
    assert pq.read_table(directory / "deaths.parquet").num_rows == found.deaths.num_rows
    shares = csv.read_csv(directory / "shares.csv")
    assert shares.column("share").to_pylist() == found.shares.column("share").to_pylist()
    assert csv.read_csv(directory / "marginal_effects.csv").num_rows == found.marginal.num_rows
    for name in FIGURES:
        assert (directory / f"{name}.png").stat().st_size > 1_000
        assert (directory / f"{name}.svg").exists()
    told = json.loads((directory / "findings.json").read_text("utf-8"))
    assert set(told["smallest_sets"]) == set(CLAIMS)


def test_every_share_is_told_with_its_interval(lived):
    table = shares_table(lived.found)
    assert [row[0] for row in table.rows] == list(CLAIMS)
    for row in table.rows:
        for cell in row[2:5]:
            assert re.fullmatch(r"[\d.]+% \([\d.]+%\sto\s[\d.]+%\)", cell)


def rows_under(page, heading):
    """The cells of each row of the table with a column of this name."""
    (table,) = [one for one in re.findall("<table>.*?</table>", page, re.S) if heading in one]
    rows = re.findall("<tr>.*?</tr>", table.partition("<tbody>")[2], re.S)
    return [re.findall("<td>(.*?)</td>", row) for row in rows]


def test_all_points_are_accounted_for(page, lived):
    left_out = sum(int(count) for count, _ in rows_under(page, "Universes left out"))
    assert left_out + lived.found.table.num_rows == lived.found.study.design.sample.points
    assert len(rows_under(page, "Factor of the study")) == 17
    assert len(rows_under(page, "Mean lifespan")) == 4


def test_a_set_is_told_with_what_fresh_universes_say(lived):
    found = SufficientSet(
        "C1",
        (Condition("overflow", ("clamp",)), Condition("physiology", ("excess", "linear"))),
        50,
        share(49, 50),
    )
    confirmed = Confirmation(found, 200, share(199, 200), "holds")
    told = lived.found._replace(
        found={**dict.fromkeys(CLAIMS), "C1": found}, confirmed={"C1": confirmed}
    )
    first, second, *_ = sets_table(told).rows
    assert first[1] == "overflow: clamp; physiology: excess or linear"
    assert first[3].endswith("of 200")
    assert first[4] == "holds"
    assert second[1] == "none"


@pytest.mark.usefixtures("undrawn")
def test_without_scikit_learn_the_page_says_how_to_have_models(lived, tmp_path):
    text = (lived.directory / "report.html").read_text("utf-8")
    assert "ten-fold cross-validation" in text
    publish(lived.found._replace(predicted=None, time_limit=None), tmp_path, "animat", lambda: None)
    text = (tmp_path / "report.html").read_text("utf-8")
    assert "pip install animat[multiverse]" in text
    assert "No universe was simulated up to a later cap." in text
    assert not (tmp_path / "cap.csv").exists()

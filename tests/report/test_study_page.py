"""One page on a results directory."""

import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from animat.files.settings import SettingsError
from animat.report.study_page import NOTHING_YET, bibtex, learnt_section, write_report

from .small import FAILING, ran


class Page(HTMLParser):
    """What a reader finds: text, headings, addresses that would be loaded."""

    def __init__(self, path):
        super().__init__()
        self.source = path.read_text("utf-8")
        self.text, self.loads, self.headings, self.scripts, self.alts = "", [], [], 0, []
        self.inside = ""
        self.feed(self.source)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.inside = tag
        self.loads += [given[name] for name in ("src", "srcset", "data", "href") if name in given]
        self.scripts += tag == "script"
        if tag == "img":
            self.alts.append(given.get("alt"))

    def handle_data(self, data):
        self.text += data
        if self.inside in ("h1", "h2") and data.strip():
            self.headings.append(data.strip())


def silent(*_):
    pass


def reported(results, by=None, out=None):
    path, short = write_report(results, out, by, silent)
    return Page(path), short


@pytest.fixture(scope="module")
def page(results):
    return reported(results)[0]


def test_the_page_has_all_its_parts(page):
    assert page.headings == [
        "Study: four", "What was asked", "How it was run", "All lives", "The cases", "The factors",
        "world.layout", "mind.agent", "Interactions of two factors", "world.layout by mind.agent",
        "What the networks learnt", "Methods and citation", "The readings taken",
        "The study file",
    ]  # fmt: skip


def test_the_page_stands_alone(page):
    assert all(address.startswith(("data:", "#")) for address in page.loads)
    assert page.scripts == 0
    assert len(page.alts) >= 6
    assert all(page.alts)
    style = re.sub(r"data:[^\"']*", "", page.source)
    assert not re.search(r"url\(|@import|fetch\(|https?://", style)


def test_its_numbers_are_those_of_the_tables(results, page):
    lives = results.lives().to_pandas()
    for agent, rows in lives.groupby("mind.agent", observed=True):
        mean = f"{rows.lifespan.mean():,.0f}"
        assert f"{mean} (" in page.text
        assert re.search(rf"{agent}\s+50\s+{int(rows.censored.sum())}\s+{mean} \(", page.text)
    rate = lives.acts.sum() and lives.successes.sum() / lives.acts.sum()
    assert f"{rate:.1%}" in page.text


def test_what_a_paper_needs_is_there(page):
    assert "@misc{cosaguilera2003motivation" in page.text
    assert "@software{animat" in page.text
    assert "stratified by the combinations of the other factors" in page.text
    assert '"mind.agent" = ["BLIND", "AF"]' in page.text


def test_robots_that_taught_are_told(page):
    assert "The 3 robots whose networks AF has" in page.text


def test_the_same_results_make_the_same_page(results, page):
    assert reported(results)[0].source == page.source


@pytest.mark.usefixtures("undrawn")
def test_only_factors_asked_for_are_told(results, tmp_path):
    page, _ = reported(results, by=["mind.agent"], out=tmp_path / "page.html")
    assert "mind.agent" in page.headings
    assert "world.layout" not in page.headings


def test_a_factor_that_is_none_is_refused_with_the_nearest(results):
    with pytest.raises(SettingsError, match=r'--by "mind.agnet": .* did you mean "mind.agent"'):
        write_report(results, None, ["mind.agnet"], silent)


def test_what_is_no_page_of_ours_is_not_replaced(results, tmp_path):
    mine = tmp_path / "mine.html"
    mine.write_text("my own work")
    with pytest.raises(SettingsError, match="is no page of animat"):
        write_report(results, mine, None, silent)
    assert mine.read_text() == "my own work"
    with pytest.raises(SettingsError, match="is a directory"):
        write_report(results, tmp_path, None, silent)


@pytest.mark.usefixtures("undrawn")
def test_lives_that_failed_are_left_out_and_told(tmp_path):
    results = ran(FAILING, tmp_path)
    errors = [one for one in results.lives(["error"])["error"].to_pylist() if one]
    assert 0 < len(errors) < 24
    page, short = reported(results)
    assert f"{len(errors)} lives failed" in short[0]
    assert errors[0] in page.text
    assert f"of {24 - len(errors)} lives ended" in page.text


@pytest.mark.usefixtures("undrawn")
def test_a_study_that_still_runs_is_reported_as_far_as_it_is(copied):
    page, short = reported(copied(without=1))
    assert short[0].startswith("Not finished")
    assert page.text.index("Not finished") < page.text.index("What was asked")
    assert "All lives" in page.headings


@pytest.mark.usefixtures("undrawn")
def test_what_is_finished_meanwhile_is_in_no_number(copied):
    results = copied()
    (last, *_) = sorted((results.directory / "lives").glob("part-*.parquet"))[::-1]
    content = last.read_bytes()
    last.unlink()
    there = results.progress.done
    meanwhile = iter(range(4))

    def tell(*_):
        if next(meanwhile) == 1:
            last.write_bytes(content)

    path, short = write_report(results, None, None, tell)
    assert results.progress.done == 100
    assert short[0].startswith(f"Not finished: {100 - there} of 100 lives")
    assert f"{there} of 100 finished" in Page(path).text


@pytest.mark.usefixtures("undrawn")
def test_a_study_of_which_nothing_is_finished_says_so(copied):
    page, short = reported(copied(without=10**6))
    assert NOTHING_YET in short
    assert "All lives" not in page.headings
    assert "Methods and citation" in page.headings


@pytest.mark.usefixtures("undrawn")
def test_robots_that_cannot_die_and_their_learning_are_reported(tmp_path):
    text = """
name = "learning"
lives = 3
steps = 1_500
measures = ["likelihoods", "learning_curve"]
[mind]
agent = "LEARNING"
[design.grid]
"mind.learning.cycles" = [1, 10]
"""
    page, short = reported(ran(text, tmp_path))
    assert short[0].startswith("0 of 6 lives ended, 6 went on at their cap. Acts")
    assert "What the networks learnt" in page.headings
    assert "mind.learning.cycles = 10" in page.text
    assert "eat TS" in page.text


TEACHERS = pa.table(
    {
        "identity": ["a", "a"],
        "robot": [0, 1],
        "likelihood_eat_TS": [0.75, 0.25],
        "likelihood_turn_round_big_one": [1.0, 1.0],
        "likelihood_eat_none": pa.array([None, None], pa.float64()),
    }
)


@pytest.fixture
def curve():
    rows = [
        {"seed": seed, "episode": episode, "network": "eat", "object": "TS",
         "likelihood": float(np.exp(-episode / 9))}
        for seed in range(3) for episode in range(20)
    ]  # fmt: skip
    return pa.Table.from_pylist(rows)


def test_robots_that_taught_are_told_network_by_network():
    (table,) = learnt_section(TEACHERS, {}).tables
    assert table.rows[0][0:2] == ("eat", "TS")
    assert table.rows[0][2].startswith("0.50 (")
    assert table.rows[1] == ("turn_round_big", "one", "1.00")
    assert len(table.rows) == 2
    assert "2 robots" in table.note


def test_a_curve_is_drawn_for_each_case_under_its_name(curve):
    section = learnt_section(None, {"agent = LEARNING": curve})
    (picture,) = section.pictures
    assert "agent = LEARNING" in picture.caption
    assert picture.content.startswith(b"<?xml")


def test_without_anything_learnt_there_is_nothing_to_tell():
    assert learnt_section(TEACHERS.slice(0, 0), {}) is None
    assert learnt_section(None, {}) is None


CFF = (Path(__file__).parents[2] / "CITATION.cff").read_text("utf-8")


def plain(text):
    """A text without what BibTeX needs, on one line."""
    return " ".join(text.replace(r"{\~n}", "ñ").replace("{", "").replace("}", "").split())


def test_it_says_what_citation_cff_says():
    (version,) = re.findall(r"^version: (.*)$", CFF, re.M)
    cited = plain(bibtex(version))
    (title,) = re.findall(r'^title: "(.*)"$', CFF, re.M)
    (author,) = re.findall(r"^  - name: (.*)$", CFF, re.M)
    (licence,) = re.findall(r"^license: (.*)$", CFF, re.M)
    for value in (title, author, licence, version):
        assert f"= {value}" in cited
    (paper,) = re.findall(r"^    title: >-\n((?:      .*\n)+)", CFF, re.M)
    assert f"title = {plain(paper)}," in cited
    family = re.findall(r"family-names: (.*)", CFF)
    given = re.findall(r"given-names: (.*)", CFF)
    names = " and ".join(f"{f}, {g}" for f, g in zip(family, given, strict=True))
    assert f"author = {names}," in cited
    (year,) = re.findall(r"^    year: (.*)$", CFF, re.M)
    assert f"year = {year}" in cited


def test_braces_are_closed():
    cited = bibtex("1.2.3")
    assert cited.count("{") == cited.count("}")
    assert "version = {1.2.3}" in cited

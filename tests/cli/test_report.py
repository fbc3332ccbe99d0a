"""`animat report` as its users meet it."""

from __future__ import annotations

import pytest

STUDY = """
name = "small"
lives = 3
steps = 300
[design.grid]
"mind.agent" = ["BLIND", "RANDOM"]
"""


@pytest.fixture
def results(animat, tmp_path):
    (tmp_path / "small.toml").write_text(STUDY)
    assert animat("run", "small.toml").code == 0
    return tmp_path / "results" / "small"


def test_a_page_is_written_and_the_short_of_it_printed(animat, results):
    said = animat("report", "results/small")
    assert said.code == 0
    assert "of 6 lives ended" in said.out
    assert said.out.splitlines()[-1] == "open results/small/report.html"
    assert (results / "report.html").read_text("utf-8").startswith("<!DOCTYPE html>")
    assert animat("report", "results/small").code == 0


@pytest.mark.usefixtures("undrawn")
def test_the_page_goes_where_it_is_asked_to(animat, results, tmp_path):
    said = animat("report", "results/small", "--by", "mind.agent", "--out", "page.html")
    assert said.code == 0
    assert (tmp_path / "page.html").is_file()
    assert not (results / "report.html").exists()


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["nowhere"], "nowhere: no such directory"),
        (["results/small", "--by", "mind.gate"], '"mind.gate": is no factor of the design'),
        (["results/small", "--out", "small.toml"], "is no page of animat; give another name"),
        (["results/small", "--out", "none/page.html"], "cannot be written"),
        ([], "Missing argument"),
    ],
)
@pytest.mark.usefixtures("undrawn")
def test_what_cannot_be_reported_is_refused(animat, results, tmp_path, arguments, complaint):
    said = animat("report", *arguments)
    assert said.code == 2
    assert complaint in said.err
    assert (tmp_path / "small.toml").read_text() == STUDY


def test_while_a_study_runs_it_can_be_reported_on(animat, results):
    for part in (results / "lives").glob("part-*.parquet"):
        part.unlink()
    said = animat("report", "results/small")
    assert said.code == 0
    assert said.out.startswith("Not finished: 6 of 6 lives are still to be simulated")

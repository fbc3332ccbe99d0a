"""`animat multiverse` and `animat sensitivity` as their users meet them."""

from __future__ import annotations

import sys

import pytest

from animat.cli import main
from animat.experiments import multiverse as module
from animat.report import multiverse_page as page

SMALL = [
    argument
    for change in ("lives=2", "steps=300", "teacher.robots=2", "teacher.steps=400")
    for argument in ("--set", change)
]


@pytest.fixture
def animat_says(undrawn, monkeypatch, capsys, tmp_path):
    """Run the command line in an empty directory; return its code and what it says."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["animat", *arguments])
        with pytest.raises(SystemExit) as end:
            main()
        return (end.value.code, *capsys.readouterr())

    return run


@pytest.fixture
def briefly(monkeypatch):
    """Stand in for publishing where it is not the point."""

    def publish(found, directory, command, tell):
        (directory / "report.html").write_text(command)

    monkeypatch.setattr(page, "publish", publish)


def test_it_says_what_it_runs_and_what_came_out_and_only_analyses_again(
    animat_says, tmp_path, request
):
    asked = ["multiverse", *SMALL, "--set", "design.sample.points=16", "--quick"]
    code, out, _ = animat_says(*asked)
    assert code == 0
    lines = out.splitlines()
    assert lines[0].startswith("multiverse: 5 universes of 17 readings, 2 lives a cell; results in")
    assert sum(line.startswith("left out") for line in lines) == 3
    assert "C7" in out
    assert (tmp_path / "results/multiverse/report.html").exists()
    parts = sorted((tmp_path / "results/multiverse/universes/lives").glob("part-*"))
    times = [part.stat().st_mtime_ns for part in parts]
    request.getfixturevalue("briefly")
    code, again, _ = animat_says(*asked)
    assert code == 0
    assert again.splitlines()[:-1] == lines[:-1]
    assert [part.stat().st_mtime_ns for part in parts] == times


def test_universes_that_were_lived_by_run_are_not_lived_again(animat_says, briefly, tmp_path):
    asked = [*SMALL, "--set", "design.sample.points=8"]
    assert animat_says("run", "multiverse", *asked, "--out", "mine/universes")[0] == 0
    parts = sorted((tmp_path / "mine/universes").rglob("part-*"))
    times = [part.stat().st_mtime_ns for part in parts]
    code, _, _ = animat_says("multiverse", *asked, "--out", "mine")
    assert code == 0
    assert sorted((tmp_path / "mine/universes").rglob("part-*")) == parts != []
    assert [part.stat().st_mtime_ns for part in parts] == times
    assert (tmp_path / "mine/report.html").exists()


def test_a_directory_of_another_multiverse_is_left_as_it_is(animat_says, briefly, tmp_path):
    asked = ["multiverse", *SMALL, "--set", "design.sample.points=8", "--quick", "--out", "mine"]
    assert animat_says(*asked)[0] == 0
    page = (tmp_path / "mine/report.html").read_bytes()
    code, _, err = animat_says(*asked, "--set", "seed=1")
    assert code == 2
    assert "seed" in err
    assert (tmp_path / "mine/report.html").read_bytes() == page


def test_one_that_is_interrupted_says_how_to_go_on(animat_says, monkeypatch):
    whole = module.run

    def interrupted(plan, directory, workers, tell):
        outcome = whole(plan, directory, workers, tell)
        return outcome._replace(tally=type(outcome.tally)(plan.numbering, plan.shares))

    monkeypatch.setattr(module, "run", interrupted)
    code, _, err = animat_says("multiverse", *SMALL, "--set", "design.sample.points=8", "--quick")
    assert code == 130
    assert "the same command resumes" in err


def test_another_study_is_refused_in_a_line(animat_says):
    code, _, err = animat_says("multiverse", "experiment2")
    assert code == 2
    assert err.startswith("animat: experiment2: is no multiverse")
    code, _, err = animat_says("sensitivity", "experiment2")
    assert code == 2
    assert 'needs a [design.sample] with method = "saltelli"' in err


def test_a_size_in_universes_is_met_nearly(animat_says, briefly, tmp_path):
    code, out, _ = animat_says("multiverse", *SMALL, "--quick", "--universes", "6")
    assert code == 0
    assert out.startswith("multiverse: 5 universes")
    assert (tmp_path / "results/multiverse/universes/manifest.json").exists()


def test_sensitivity_says_what_matters_most(animat_says, tmp_path):
    code, out, _ = animat_says(
        "sensitivity", "--quick", "--set", "steps=400", "--set", "teacher.steps=500",
        "--set", "design.sample.points=2",
    )  # fmt: skip
    assert code == 0
    assert [line.split(":")[0] for line in out.splitlines()[:2]] == ["BLIND", "AF"]
    assert (tmp_path / "results/sensitivity/sensitivity.html").exists()

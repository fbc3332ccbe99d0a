"""The studies that come with animat: they are there, can be run, and are what they say."""

from __future__ import annotations

import tomllib

import pytest

from animat.files.settings import SettingsError
from animat.study.file.builtin import FOLDER, is_name, shipped, study_file, write_starter
from animat.study.file.cases import cases
from animat.study.file.read import read_study
from animat.study.file.settings import Teacher, WorldChoice
from animat.study.file.study import Record
from animat.study.plan.plan import Plan
from animat.study.plan.preflight import check_livable

NAMES = sorted(path.stem for path in FOLDER.glob("*.toml"))


def test_the_experiments_of_the_paper_and_a_starter_are_there():
    assert {"experiment1", "experiment2", "starter"} <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_each_can_be_lived_and_goes_by_its_name(name):
    sampled = "sample" in tomllib.loads(shipped(name).read_text("utf-8")).get("design", {})
    study = read_study(shipped(name), ["design.sample.points=8"] if sampled else [])
    assert study.name == name
    check_livable(Plan(study))


def test_experiment_1_is_that_of_the_paper():
    study = read_study(shipped("experiment1"))
    (case,) = cases(study)
    assert (study.lives, case.steps) == (100, 300_000)
    assert case.settings.mind.agent == "LEARNING"
    assert not case.settings.mind.mortal
    assert case.settings.world == WorldChoice(layout="abundant")
    assert study.measures == ["likelihoods", "learning_curve"]
    assert study.record == Record(what="last:500", lives=100)


def test_experiment_2_is_that_of_the_paper():
    study = read_study(shipped("experiment2"))
    found = cases(study)
    assert [tuple(case.factors.values()) for case in found] == [
        ("abundant", "BLIND"), ("abundant", "AF"), ("scarce", "BLIND"), ("scarce", "AF")
    ]  # fmt: skip
    assert {case.steps for case in found} == {300_000}
    assert {case.first for case in found} == {0}
    learnt = Teacher(robots=100, steps=300_000, world=WorldChoice(layout="abundant"))
    assert [case.teacher for case in found] == [None, learnt, None, learnt]
    assert all(case.settings.mind.mortal for case in found)


def test_a_name_or_a_path_finds_a_study(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine").touch()
    assert str(study_file("mine")) == "mine"
    assert study_file("experiment2") == shipped("experiment2")
    for path in ("mine.toml", "no/such", str(tmp_path / "a.toml")):
        assert str(study_file(path)) == path
    with pytest.raises(SettingsError, match=r'"experment2": no such study.*did you mean "experi'):
        study_file("experment2")
    with pytest.raises(SettingsError, match="known: experiment1"):
        study_file("")


def test_a_starter_is_a_study_called_like_its_file(tmp_path):
    file = tmp_path / "my study.toml"
    write_starter(file, force=False)
    study = read_study(file)
    assert study.name == "my study"
    assert study.model_copy(update={"name": "starter"}) == read_study(shipped("starter"))
    write_starter(tmp_path / "$.toml", force=False)
    assert read_study(tmp_path / "$.toml").name == "starter"


def test_what_a_starter_shows_in_comments_is_right(tmp_path):
    """The sections that are commented out are read, too, when they are let in."""
    text = shipped("starter").read_text("utf-8")
    head, tail = text.split("# [design.grid.meal]", 1)
    lines = ("# [design.grid.meal]" + tail).splitlines()
    code = [line[2:] for line in lines if line.startswith(("# [", '# "', "# method", "# points"))]
    code += [line[2:] for line in lines if line.startswith(("# when", "# why"))]
    file = tmp_path / "all.toml"
    file.write_text(head + "\n".join(code))
    found = cases(read_study(file))
    assert len(found) == 3 * 2 * 16 * 2
    assert {case.factors["meal"] for case in found} == {"small and slow", "as in the paper"}


def test_a_starter_replaces_nothing_without_being_asked(tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("mine")
    with pytest.raises(SettingsError, match="is there already; --force replaces it"):
        write_starter(file, force=False)
    assert file.read_text() == "mine"
    write_starter(file, force=True)
    assert read_study(file).name == "a"
    with pytest.raises(SettingsError, match=r"ends in \.toml"):
        write_starter(tmp_path / "a.txt", force=False)


@pytest.mark.parametrize("name", ["a", "a b", "1.2-x_y", "ä", "a" * 80])
def test_a_name_is_one_of_a_directory(name, tmp_path):
    assert is_name(name)
    (tmp_path / name).mkdir()


@pytest.mark.parametrize("name", ["", ".", "..", "a/b", "a\\b", "-a", "a ", " a", "a.", "a" * 81])
def test_other_names_are_none(name):
    assert not is_name(name)

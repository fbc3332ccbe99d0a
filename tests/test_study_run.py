"""A study run from Python: the same as on the command line, whatever it is given as."""

import numpy as np
import pytest

import animat
from animat.files.settings import SettingsError
from animat.study.execute import run as running
from animat.study.file.read import study_of
from animat.study.store.results import open as open_results
from animat.study_run import _study

STUDY = {
    "name": "small",
    "lives": np.int64(4),
    "steps": 60,
    "mind": {"drives": {"curiosity": None}, "behaviours": {"interact": None}},
    "design": {"grid": {"mind.agent": ("BLIND", "ORACLE")}},
}


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    told = []
    directory = tmp_path_factory.mktemp("study") / "results"
    done = animat.run(STUDY, directory, threads=1, progress=lambda *each: told.append(each))
    return done, told


def test_what_it_gives_are_the_results(done):
    result, told = done
    assert result.failed == 0
    assert result.lives.num_rows == len(result.to_pandas()) == 8
    assert set(result.lives["mind.agent"].to_pylist()) == {"BLIND", "ORACLE"}
    assert list(result.results.study.mind.drives) == ["hunger", "fatigue"]
    assert told[-1] == ("Lives", 8, 8)
    assert [count for _, count, _ in told] == sorted(count for _, count, _ in told)


def test_the_same_call_resumes_and_a_study_may_be_given_in_any_way(done, tmp_path, capsys):
    directory = done[0].directory
    file = tmp_path / "small.toml"
    file.write_text(open_results(directory).text)
    for study in (STUDY, open_results(directory).study, file, str(file)):
        again = animat.run(study, directory, progress=False)
        assert again.lives.equals(done[0].lives)
    assert capsys.readouterr() == ("", "")


def test_the_report_is_where_it_says(done, tmp_path):
    page = done[0].report(tmp_path / "page.html")
    assert page == tmp_path / "page.html"
    assert "small" in page.read_text()


def test_lines_tell_how_far_it_is_where_there_is_no_terminal(done, capsys):
    animat.run(STUDY, str(done[0].directory))
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("Lives: 8 of 8")


def test_an_interrupted_run_says_how_to_resume(done, tmp_path, monkeypatch):
    monkeypatch.setattr(running._Run, "_live_all", lambda self, asked: asked.set())
    with pytest.raises(KeyboardInterrupt, match=r"^0 of 8 lives are in"):
        animat.run(STUDY, tmp_path / "other", progress=False)


WRONG = [
    (3, "study is of type int; allowed are"),
    ("nothing", '"nothing": no such study'),
    ("none.toml", "none.toml: no such file"),
    ({"lives": 3}, "study: key name: missing key"),
    ({"name": "x", "lives": "3"}, 'study: key lives = "3": must be a whole number'),
    (
        {"name": "x", "mind": {"wander": max}},
        "study: key mind.wander: builtin_function_or_method is",
    ),
    ({"name": "x", "seed": object()}, "study: key seed: object is nothing for a study"),
    ({"name": "x", "design": {"grid": {"mind.agnt": ["AF"]}}}, "did you mean"),
]


@pytest.mark.parametrize(("study", "told"), WRONG)
def test_what_is_no_study_is_refused_in_a_line(study, told, tmp_path):
    with pytest.raises(SettingsError) as caught:
        animat.run(study, tmp_path / "results")
    assert told in str(caught.value)
    assert not (tmp_path / "results").exists()


def test_what_it_cannot_be_run_with_is_refused_at_once(tmp_path):
    with pytest.raises(SettingsError) as caught:
        animat.run(STUDY, 3, threads=0, progress="no")  # pyright: ignore[reportArgumentType]
    assert [line.split()[0] for line in caught.value.problems] == ["out", "threads", "progress"]


def test_an_object_in_a_dict_stands_for_its_settings():
    by_object = {"name": "x", "mind": animat.Mind(agent="RANDOM")}
    assert _study(by_object) == study_of({"name": "x", "mind": {"agent": "RANDOM"}}, "x")


def test_a_file_that_has_changed_between_two_runs_counts_as_it_is(tmp_path, monkeypatch):
    """Both run the same text, in one process."""
    monkeypatch.chdir(tmp_path)
    study = {"name": "by_file", "lives": 6, "steps": 400, "world": {"layout": "mine.toml"}}
    found = []
    for number in range(2):
        animat.World.random({"TS": 2, "CL": 1 + number}, seed=number).save("mine.toml")
        run = animat.run(study, tmp_path / f"run{number}", threads=1, progress=False)
        there = animat.live_many(animat.Mind(), animat.World.load("mine.toml"), lives=6, steps=400)
        ended = ("lifespan", "encounters")
        assert all(run.lives[name].to_pylist() == there.table[name].to_pylist() for name in ended)
        found.append(run.lives["encounters"].to_pylist())
    assert found[0] != found[1]

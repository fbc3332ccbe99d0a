"""`animat run`, `status`, `verify` and `export`, as their users meet them."""

from __future__ import annotations

import json
import os
import signal
from contextlib import nullcontext
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from animat import progress
from animat.files import lock
from animat.files.lock import hold
from animat.study.execute.signals import ASKED
from animat.study.store.results import Results
from animat.study.store.status import status

STUDY = """
name = "tiny"
lives = 12
steps = 300
[teacher]
robots = 3
steps = 300
[design.grid]
"mind.agent" = ["BLIND", "AF"]
"mind.gate" = ["positive", "always"]
[[design.exclude]]
when = { "mind.agent" = "AF", "mind.gate" = "always" }
why = "nobody asked for it"
"""


@pytest.fixture
def file(tmp_path) -> Path:
    path = tmp_path / "tiny.toml"
    path.write_text(STUDY)
    return path


def test_a_study_is_lived_told_of_looked_at_and_exported(animat, file, tmp_path):
    said = animat("run", "tiny.toml")
    assert said.code == 0
    first, second, last = said.out.splitlines()
    assert first == "tiny: 3 cases, 36 lives; results in results/tiny"
    assert second == "left out: 1 combinations: nobody asked for it"
    assert last.startswith("36 lives are in results/tiny; ")
    assert "Robots that learn: 3 of 3" in said.err
    assert "Lives: 36 of 36" in said.err
    results = Results(Path("results/tiny"))
    assert results.lives().num_rows == 36
    command = "animat run tiny.toml"
    assert [run["command"] for run in results.manifest["runs"]] == [command]

    said = animat("status", "results/tiny")
    assert said.out.splitlines() == [
        "tiny: 36 of 36 lives, 3 of 3 cases",
        "3 of 3 robots that teach have learnt",
        "finished",
    ]
    said = animat("verify", "results/tiny")
    assert (said.code, said.out) == (
        0,
        "6 of 6 parts are there and unchanged; 6 lives simulated again are the same\n",
    )
    said = animat("export", "results/tiny", "--to", "csv", "--out", "lives.csv")
    assert (said.code, said.out) == (0, "36 lives are in lives.csv\n")
    assert len(Path("lives.csv").read_text().splitlines()) == 37

    part = Path("results/tiny/lives/part-000000.parquet")
    part.write_bytes(part.read_bytes()[:-1])
    said = animat("verify", "results/tiny")
    assert (said.code, said.out) == (1, "")
    assert said.err.splitlines()[-1].startswith(f"animat: {part}: is cut short")
    said = animat("export", "results/tiny", "--to", "csv", "--out", "again.csv")
    assert (said.code, said.out) == (2, "")
    assert said.err.startswith(f"animat: {part}: is cut short")
    assert not Path("again.csv").exists()
    said = animat("status", "results/tiny")
    assert any(line.startswith(f"{part}: is cut short") for line in said.out.splitlines())
    assert animat("run", "tiny.toml").code == 0
    assert animat("verify", "results/tiny").code == 0


def test_every_choice_is_taken(animat, file):
    said = animat(
        *("run", str(file), "--out", "mine", "--set", "lives=2", "--set", "teacher.robots=1"),
        *("--threads", "1"),
    )
    assert said.code == 0
    assert said.out.startswith("tiny: 3 cases, 6 lives; results in mine\n")
    log = [json.loads(line) for line in Path("mine/log.jsonl").read_text().splitlines()]
    assert log[0]["threads"] == 1


def test_a_study_that_comes_with_animat_is_run_by_its_name(animat):
    said = animat(
        *("run", "experiment2", "--set", "lives=2", "--set", "steps=50"),
        *("--set", "teacher.robots=1", "--set", "teacher.steps=50"),
    )
    assert said.code == 0
    assert Path("results/experiment2/manifest.json").is_file()


WRONG = {
    "run none.toml": "none.toml: no such file",
    "run nothing": "no such study",
    "run tiny.toml --set lves=3": 'did you mean "lives"',
    "run tiny.toml --threads 0": "--threads",
    "run tiny.toml --out tiny.toml": "is a file",
    "run tiny.toml --out there": "is no results directory: it holds mine",
    "run tiny.toml --out /proc/none": "/proc/none: cannot be written",
    "status there": "there: is no results directory",
    "verify none": "none: no such directory",
    "export none --to csv --out a.csv": "none: no such directory",
    "export none --to csv": "--out",
    "status": "DIR",
}


@pytest.mark.parametrize("command", WRONG)
def test_what_is_wrong_is_told_in_a_line(animat, file, tmp_path, command):
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "mine").touch()
    said = animat(*command.split())
    assert said.code == 2
    (line,) = said.err.splitlines()
    assert line.startswith("animat: ")
    assert WRONG[command] in line
    assert [path.name for path in (tmp_path / "there").iterdir()] == ["mine"]


def test_another_study_is_refused_with_the_difference(animat, file):
    assert animat("run", "tiny.toml", "--set", "lives=2").code == 0
    said = animat("run", "tiny.toml")
    assert said.code == 2
    assert "results/tiny: lives = 2 there and 12 here" in said.err
    assert animat("run", "tiny.toml", "--out", "another").code == 0


def test_lives_that_fail_stop_no_others_and_end_in_code_1(animat, file, tmp_path, lost):
    (tmp_path / "own.py").write_text(lost)
    said = animat("run", "tiny.toml", "--set", 'mind.wander="own.py:walk"')
    lives = Results(Path("results/tiny")).lives()
    failed = [row for row in lives.to_pylist() if row["error"]]
    assert said.code == 1
    lines = [line for line in said.err.splitlines() if line.startswith("animat: ")]
    assert lines[0] == f"animat: {len(failed)} of 36 lives failed"
    assert lines[1].startswith(f"animat: case {failed[0]['case']}, mind.agent = BLIND, ")
    assert lines[1].endswith(f", life {failed[0]['life']}: {failed[0]['error']}")
    assert 0 < len(failed) < 36
    assert animat("verify", "results/tiny").code == 0
    assert animat("run", "tiny.toml", "--set", 'mind.wander="own.py:walk"').code == 1


def test_the_second_is_told_who_is_at_it(animat, file, monkeypatch):
    monkeypatch.setattr(lock, "PATIENCE", 0.05)
    assert animat("run", "tiny.toml").code == 0
    with hold(Path("results/tiny/lock")):
        said = animat("run", "tiny.toml")
        assert said.code == 1
        (line,) = said.err.splitlines()
        assert line.startswith(f"animat: results/tiny: is held by process {os.getpid()} on ")
        assert animat("status", "results/tiny").out.splitlines()[-1].startswith("run by process ")


@pytest.fixture
def heeded():
    """Let new processes heed SIGINT, though these tests may run where it is ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("heeded")
def test_ctrl_c_finishes_what_is_under_way_and_says_how_to_go_on(animat, file, tmp_path):
    many = ("--set", "lives=800", "--set", "steps=60", "--threads", "1")
    told = []

    def tell(task: str, done: int, total: int, note: str = "") -> None:
        if task == "Lives" and done and not told:
            told.extend(status(Results(tmp_path / "results" / "tiny")))
            signal.raise_signal(signal.SIGINT)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(progress, "telling", lambda: nullcontext(tell))
        said = animat("run", "tiny.toml", *many)
    assert said.code == 130
    assert told[-1].startswith("run by process ")
    parts = list((tmp_path / "results" / "tiny" / "lives").glob("part-*"))
    rows = sum(pq.read_metadata(part).num_rows for part in parts)
    assert 0 < rows < 2_400
    assert said.err.endswith(
        f"{ASKED}animat: {rows:,} of 2,400 lives are in results/tiny; the same command resumes"
        " the run\nanimat: interrupted; nothing is half-written\n"
    )
    assert animat("status", "results/tiny").out.splitlines()[-1] == "not run by anybody"
    assert animat("run", "tiny.toml", *many).code == 0
    assert Results(Path("results/tiny")).progress == (2_400, 2_400)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--jobs", "2"], "--jobs: belongs to --cluster with a batch system"),
        (["--cluster", "tcp://a:1", "--jobs", "2"], "--jobs: only a batch system has jobs"),
        (["--cluster", "tcp://a:1", "--threads", "2"], "--threads: is for this machine"),
        (["--cluster", "a:1"], '--cluster "a:1": must be tcp://HOST:PORT'),
    ],
)
def test_what_does_not_go_with_a_cluster_is_refused(animat, file, options, told):
    said = animat("run", "tiny.toml", *options)
    assert said.code == 2
    assert said.err.startswith(f"animat: {told}")
    assert len(said.err.splitlines()) == 1
    assert not Path("results").exists()

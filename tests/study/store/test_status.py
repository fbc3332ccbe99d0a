"""How a study stands."""

from __future__ import annotations

import json
import shutil

import pytest

from animat.files.lock import hold
from animat.study.store.log import logging_to
from animat.study.store.results import Results
from animat.study.store.status import status


@pytest.fixture
def copied(finished, tmp_path):
    return shutil.copytree(finished, tmp_path / "results")


def test_a_finished_study_is_finished(finished):
    assert status(Results(finished)) == [
        "small: 16 of 16 lives, 2 of 2 cases",
        "3 of 3 robots that teach have learnt",
        "finished",
    ]


def test_one_that_is_not_says_what_is_there(copied):
    (copied / "lives" / "part-000001.parquet").unlink()
    (copied / "teachers" / "part-000000.parquet").unlink()
    assert status(Results(copied)) == [
        "small: 8 of 16 lives, 1 of 2 cases",
        "0 of 3 robots that teach have learnt",
        "not run by anybody",
    ]


def test_one_that_is_run_says_by_whom_and_how_long_still(copied):
    (copied / "lives" / "part-000001.parquet").unlink()
    (copied / "log.jsonl").unlink()
    with hold(copied / "lock"):
        assert "time left not known yet" in status(Results(copied))[-1]
        events = [("part", 9_000_000, 0.5), ("start", 0, 0.0), ("part", 700, 1.0)]
        events += [("part", 1_000, 1.5), ("part", 1_000, 2.0)]
        with (copied / "log.jsonl").open("w") as log:
            for event, steps, seconds in events:
                log.write(json.dumps({"event": event, "steps": steps, "seconds": seconds}) + "\n")
        line = status(Results(copied))[-1]
        # 2,000 steps in the second since the first part; 8 lives of 150 steps are left.
        assert line.startswith("run by process ")
        assert line.endswith("; about 1 s left, 0.0 million steps/s")
    with logging_to(copied / "log.jsonl") as log:
        log("end", why="interrupted")
    assert status(Results(copied))[-1] == "not run by anybody"


def test_one_whose_holder_died_says_so(copied):
    (copied / "lives" / "part-000001.parquet").unlink()
    (copied / "lock").write_text(json.dumps({"pid": 7, "host": "there", "since": "then"}))
    line = status(Results(copied))[-1]
    assert line == "not run by anybody; process 7 on there, since then ended without a word"


def test_failures_are_counted(faults, tmp_path, lost):
    own = tmp_path / "own.py"
    own.write_text(lost)
    faults.go_on(
        faults.plan(
            f'name = "failing"\nlives = 20\nsteps = 200\n[mind]\nwander = "{own}:walk"\n'
            'agent = "AF"\n[teacher]\nrobots = 8\nsteps = 200\n'
        ),
        tmp_path / "out",
    )
    results = Results(tmp_path / "out")
    lines = status(results)
    errors = [row["error"] for row in results.lives().to_pylist() if row["error"]]
    failed, robots = len(errors), 8 - results.teachers()["error"].null_count
    assert 0 < robots < 8
    assert robots < failed < 20
    assert lines[2:] == [f"{failed} lives failed", f"{robots} robots failed to learn", "finished"]
    told = results.failures(3)
    assert [line.partition(": ")[2] for line in told] == errors[:3]
    assert all(line.startswith("case 0, life ") for line in told)
    assert any("whose networks it has, failed" in error for error in errors)


@pytest.mark.parametrize("entry", ["{}", '{"steps": "x", "seconds": null}', '{"steps": 1}'])
def test_a_log_of_somebody_elses_tells_no_speed(copied, entry):
    (copied / "lives" / "part-000001.parquet").unlink()
    (copied / "log.jsonl").write_text(f'{{"event": "part", {entry[1:]}\n'.replace(", }", "}") * 3)
    with hold(copied / "lock"):
        assert "time left not known yet" in status(Results(copied))[-1]

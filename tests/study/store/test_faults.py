"""A study survives anything: the end of its process at any moment, a disk that fails, torn files.

After going on, every file that holds results is the same, byte for byte, as that of a run which
nothing disturbed.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from animat.files import lock, provenance
from animat.study.store import log
from animat.study.store.status import status

pytestmark = pytest.mark.long

KILLED = -9

NIGHTLY = settings.get_current_profile_name() == "nightly"
STEP = 1 if NIGHTLY else 5
"""One in so many writes is tried."""

KILLS = 200 if NIGHTLY else 15


@pytest.fixture(scope="module")
def driven() -> Iterator[Callable[..., dict[str, Any]]]:
    """What a driver tells that breaks off runs in one way; it imports everything once."""
    with subprocess.Popen(
        [sys.executable, str(Path(__file__).parents[1] / "faults.py")],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    ) as driver:
        assert driver.stdin is not None
        assert driver.stdout is not None
        asked, told = driver.stdin, driver.stdout

        def driven(how: str, folder: Path, number: int = 0) -> dict[str, Any]:
            asked.write(json.dumps([how, str(folder), number]) + "\n")
            asked.flush()
            return json.loads(told.readline())

        yield driven


def test_a_run_killed_at_any_write_is_gone_on_with(driven, faults, tmp_path):
    told = driven("killed at writes", tmp_path, STEP)
    assert told["points"] > 60
    assert told["ends"] == [KILLED, faults.UNDISTURBED]
    assert told["different"] == []


def test_a_run_killed_at_any_moment_is_gone_on_with(driven, tmp_path):
    told = driven("killed at any moment", tmp_path, KILLS)
    assert told["kills"] == KILLS
    assert told["complete"] > 0
    assert told["different"] == 0


def test_a_run_that_finds_no_room_at_any_write_says_so_and_is_gone_on_with(
    driven, faults, tmp_path
):
    """Some writes are no loss: what is taken away, and words nobody reads."""
    told = driven("no room at writes", tmp_path, STEP)
    assert told["points"] > 60
    ends = {faults.DONE, faults.FAILED, faults.UNDISTURBED}
    assert {faults.FAILED, faults.UNDISTURBED} <= set(told["ends"]) <= ends
    assert told["different"] == []


def test_a_run_on_a_full_disk_says_so_and_is_gone_on_with(driven, faults, tmp_path):
    told = driven("full disks", tmp_path)
    assert told["ends"]["limit"] == faults.FAILED
    assert set(told["ends"].values()) == {faults.FAILED}
    assert told["different"] == []


def test_a_directory_that_may_only_be_read_is_refused_and_stays_as_it_is(driven, faults, tmp_path):
    told = driven("read only", tmp_path)
    assert told == {
        "ended": faults.WRONG,
        "untouched": True,
        "again": faults.DONE,
        "different": False,
    }


def lengths(size: int) -> list[int]:
    """A length of every kind to which a file may be torn."""
    return [0, 1, 4, 5, 100, size // 2, size - 9, size - 8, size - 4, size - 1]


FILES = ["lives/part-000001", "teachers/part-000000", "curves/lives-000000", "traces/part-000000"]


@pytest.mark.parametrize("file", FILES)
def test_a_torn_file_is_lived_again(file, faults, small, finished, tmp_path):
    directory = tmp_path / "results"
    shutil.copytree(finished, directory)
    path = directory / f"{file}.parquet"
    whole = path.read_bytes()
    for length in lengths(len(whole)):
        path.write_bytes(whole[:length])
        faults.go_on(small, directory)
        assert path.read_bytes() == whole
    path.unlink()
    faults.go_on(small, directory)
    assert faults.told_of(directory) == faults.told_of(finished)
    assert '"event": "torn"' in (directory / "log.jsonl").read_text()


def test_a_clock_that_goes_back_changes_nothing(faults, small, finished, tmp_path, monkeypatch):
    hours = iter(range(10_000, 0, -1))

    class Backwards(datetime):
        @classmethod
        def now(cls, tz: Any = None) -> Any:
            return datetime(2020, 1, 1, tzinfo=UTC) + timedelta(hours=next(hours))

    for module in (lock, log, provenance):
        monkeypatch.setattr(module, "datetime", Backwards)
    monkeypatch.setattr(time, "time", lambda: 1e9 + 3600.0 * next(hours))
    directory = tmp_path / "results"
    faults.go_on(small, directory)
    (directory / "lives" / "part-000000.parquet").unlink()
    assert status(_results(directory))[0] == "small: 8 of 16 lives, 1 of 2 cases"
    faults.go_on(small, directory)
    assert faults.told_of(directory) == faults.told_of(finished)
    assert status(_results(directory))[-1] == "finished"
    assert next(hours) < 10_000 - 10


def _results(directory: Path) -> Any:
    from animat.study.store.results import Results

    return Results(directory)

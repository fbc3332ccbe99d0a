"""Streams that are closed, full or not read any more stop no work."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from animat.cli.streams import Steady


def test_what_is_written_to_a_reader_that_left_is_dropped():
    reading, writing = os.pipe()
    os.close(reading)
    with Steady(writing, "w") as stream:
        assert stream.write(b"nobody reads it") == 15
        assert isinstance(stream.lost, BrokenPipeError)
        assert stream.write(memoryview(b"more")) == 4


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&-", "<&- >&- 2>&-"])
def test_the_work_is_done_with_streams_closed(tmp_path, closed):
    done = subprocess.run(
        ["sh", "-c", f'exec "$0" -m animat new a.toml {closed}', sys.executable],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert Path(tmp_path / "a.toml").read_text().startswith("#")


WRONG = [
    *("life --settings {}", "life --world {}", "life --from {}", "replay {}", "replay {} --verify"),
    *("run {}", "check {}", "multiverse {}", "sensitivity {}", "reproduce --settings {}"),
    *("status {}", "report {}", "verify {}", "export {} --to csv --out a.csv"),
]


@pytest.mark.parametrize("command", WRONG)
def test_what_may_never_end_is_not_read(animat, tmp_path, command):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "pipe.toml").symlink_to("pipe")
    for file in ("./pipe", "pipe.toml", "/dev/zero"):
        said = animat(*command.format(file).split())
        assert (said.code, said.out) == (2, "")
        (line,) = said.err.splitlines()
        assert file.removeprefix("./") in line


@pytest.mark.parametrize("variable", ["NUMBA_OPT", "NUMBA_DEBUG"])
def test_a_variable_that_numba_cannot_read_is_told_of_in_a_line(tmp_path, variable):
    done = subprocess.run(
        [sys.executable, "-m", "animat", "replay", "none"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), variable: "junk"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert done.stderr.startswith(f"animat: Environment variable '{variable}' is defined but")
    assert len(done.stderr.splitlines()) == 1

"""Ctrl-C while compiled code never returns."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

STUCK = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
import numba, numpy as np
import animat.life.batch
from animat.cli import main

@numba.njit(nogil=True)
def forever(numbers):
    while True:
        numbers[0] += 1.0

def advance(*_):
    print("stuck", flush=True)
    forever(np.zeros(1))

class Stuck:
    def of(self, *_):
        return advance

animat.life.kernels.advance = Stuck()
main()
"""

STUDY = 'name = "tiny"\nlives = 2\nsteps = 100\n'


@pytest.mark.parametrize("arguments", [("life",), ("run", "tiny.toml", "--threads", "1")])
def test_the_first_asks_and_the_second_ends_the_process(arguments, tmp_path):
    (tmp_path / "tiny.toml").write_text(STUDY)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    process = subprocess.Popen(
        [sys.executable, "-c", STUCK, *arguments],
        cwd=tmp_path,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stderr is not None
    while "stuck" not in process.stdout.readline():
        assert process.poll() is None
    process.send_signal(signal.SIGINT)
    if "run" in arguments:
        while "once more Ctrl-C stops at once" not in process.stderr.readline():
            assert process.poll() is None
        process.send_signal(signal.SIGINT)
    _, error = process.communicate()
    assert process.returncode == 130
    assert error.splitlines()[-1] == "animat: interrupted; nothing is half-written"
    assert "Traceback" not in error

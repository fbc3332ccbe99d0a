"""The functions of a step give the same bits compiled and as plain Python, without a warning."""

import os
import runpy
import subprocess
import sys
from pathlib import Path

DRIVE = Path(__file__).parent / "drive.py"


def test_compiled_and_plain_python_agree_to_the_bit():
    compiled = runpy.run_path(str(DRIVE))["drive"]()
    plain = subprocess.run(
        [sys.executable, "-W", "error", str(DRIVE)],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert plain.stdout.split() == compiled
    assert len(set(compiled)) > 1000

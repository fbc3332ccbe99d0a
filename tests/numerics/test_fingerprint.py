"""Equal fingerprints stand for functions that compute the same, wherever and whenever taken."""

from __future__ import annotations

import importlib
import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from animat.mind.selection import affordance_times_drive, select, winner_take_all
from animat.numerics.fingerprint import fingerprint

HELPER = """
from numba import njit

STEEPNESS = 3.0

@njit
def doubled(x):
    return 2.0 * x
"""

OWN = """
import math
import numpy as np
from numba import njit
import helper
from animat.numerics.elementary import exponential
from helper import doubled
from data import LEVELS, TABLE

UNUSED = object()

@njit
def inner(x):
    return x + 1.0

def own(x):
    return inner(x) + doubled(x) + TABLE[0] + LEVELS[1] + helper.STEEPNESS * exponential(math.pi)

def made(gain):
    def scaled(x):
        return gain * x
    return scaled

twice, thrice = made(2.0), made(3.0)

def again(n):
    return again(n - 1) if n else 0
"""

DATA = """
import numpy as np

TABLE = np.array([1.0, 2.0])
LEVELS = (1, 2)
"""

FUNCTIONS = ("own", "twice", "thrice", "again")

CHILD = """
import importlib, json, sys
from animat.numerics.fingerprint import fingerprint
sys.path.insert(0, sys.argv[1])
own = importlib.import_module("own")
print(json.dumps([fingerprint(getattr(own, name)) for name in sys.argv[2:]]))
"""


@pytest.fixture
def told(tmp_path, monkeypatch):
    """Write the files of a user, import them anew, and return the fingerprints."""

    def told(
        own: str = OWN, helper: str = HELPER, data: str = DATA, folder: Path = tmp_path
    ) -> list[str]:
        for name, text in {"own": own, "helper": helper, "data": data}.items():
            # As bytes, so that the lines end as the test wants them to.
            (folder / f"{name}.py").write_bytes(text.encode())
            monkeypatch.delitem(sys.modules, name, raising=False)
        monkeypatch.setattr(sys, "path", [str(folder), *sys.path])
        monkeypatch.setattr(sys, "dont_write_bytecode", True)
        importlib.invalidate_caches()
        module: Any = importlib.import_module("own")
        return [fingerprint(getattr(module, name)) for name in FUNCTIONS]

    yield told
    for name in ("own", "helper", "data"):
        sys.modules.pop(name, None)


def test_it_is_the_same_in_every_process_compiled_or_not(told, tmp_path):
    here = told()
    assert len(set(here)) == len(FUNCTIONS)
    for off in ("0", "1"):
        done = subprocess.run(
            [sys.executable, "-c", CHILD, str(tmp_path), *FUNCTIONS],
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "NUMBA_DISABLE_JIT": off},
            capture_output=True,
            text=True,
            check=True,
        )
        assert json.loads(done.stdout) == here


def test_it_does_not_depend_on_where_the_file_is_or_how_its_lines_end(told, tmp_path):
    here = told()
    (tmp_path / "elsewhere").mkdir()
    assert told(folder=tmp_path / "elsewhere") == here
    assert told(OWN.replace("\n", "\r\n"), HELPER.replace("\n", "\r\n")) == here


def test_what_the_function_does_not_name_does_not_count(told):
    here = told()
    assert told(data=DATA + "OTHER = 7\n") == here


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("own", "x + 1.0", "x + 2.0"),
        ("own", "inner(x) + ", ""),
        ("helper", "2.0 * x", "3.0 * x"),
        ("helper", "STEEPNESS = 3.0", "STEEPNESS = 4.0"),
        ("data", "[1.0, 2.0]", "[1.5, 2.0]"),
        ("data", "[1.0, 2.0]", "[1, 2]"),
        ("data", "(1, 2)", "(1, 3)"),
    ],
)
def test_whatever_changes_what_it_computes_counts(told, file, old, new):
    texts = {"own": OWN, "helper": HELPER, "data": DATA}
    here = told()
    assert old in texts[file]
    texts[file] = texts[file].replace(old, new)
    changed = told(**texts)
    assert changed[0] != here[0]
    # Functions that take nothing from the other files change with their own only.
    assert (changed[3] != here[3]) == (file == "own")


def test_our_own_functions_are_left_to_the_version_of_the_engine(monkeypatch):
    here = fingerprint(select)
    monkeypatch.setattr(Path, "read_bytes", lambda self: b"changed")
    assert fingerprint(select) == here


def test_functions_of_the_package_are_told_apart_by_their_names():
    assert fingerprint(winner_take_all) == fingerprint(winner_take_all)
    assert fingerprint(winner_take_all) != fingerprint(affordance_times_drive)

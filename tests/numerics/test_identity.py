"""Equal identities stand for functions that compute the same, wherever and whenever taken."""

from __future__ import annotations

import enum
import importlib
import json
import math
import os
import subprocess
import sys
import types
from collections import namedtuple
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.files.settings import SettingsError
from animat.mind.selection import affordance_times_drive, select, winner_take_all
from animat.numerics import identity as module
from animat.numerics.identity import identity
from animat.numerics.snapshot import lasting_identity, source_files

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
from animat.numerics.compiled import compiled
from animat.numerics.elementary import exponential
from helper import doubled
from data import LEVELS, TABLE

UNUSED = object()

@njit
def inner(x):
    return x + 1.0

@compiled
def small(x):
    return x + 0.5

def own(x):
    return inner(x) + doubled(x) + TABLE[0] + LEVELS[1] + helper.STEEPNESS * exponential(math.pi)

def made(gain):
    def scaled(x):
        return gain * x
    return scaled

twice, thrice = made(2.0), made(3.0)

def again(n):
    return again(n - 1) + small(n) if n else 0
"""

DATA = """
import numpy as np

TABLE = np.array([1.0, 2.0])
LEVELS = (1, 2)
"""

FUNCTIONS = ("own", "twice", "thrice", "again")

CHILD = """
import importlib, json, sys
from animat.numerics.identity import identity
sys.path.insert(0, sys.argv[1])
own = importlib.import_module("own")
print(json.dumps([identity(getattr(own, name)).text for name in sys.argv[2:]]))
"""


@pytest.fixture
def found(tmp_path, monkeypatch):
    """Write the files of a user, import them anew, and return the identities."""

    def found(
        own: str = OWN, helper: str = HELPER, data: str = DATA, folder: Path = tmp_path
    ) -> list[str]:
        for name, text in {"own": own, "helper": helper, "data": data}.items():
            # As bytes, so that the lines end as the test wants them to.
            (folder / f"{name}.py").write_bytes(text.encode())
            monkeypatch.delitem(sys.modules, name, raising=False)
        monkeypatch.setattr(sys, "path", [str(folder), *sys.path])
        monkeypatch.setattr(sys, "dont_write_bytecode", True)
        importlib.invalidate_caches()
        own_module: Any = importlib.import_module("own")
        return [lasting_identity(getattr(own_module, name)) for name in FUNCTIONS]

    yield found
    for name in ("own", "helper", "data"):
        sys.modules.pop(name, None)


def test_it_is_the_same_in_every_process_compiled_or_not(found, tmp_path):
    here = found()
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


def test_it_does_not_depend_on_where_the_file_is_or_how_it_is_laid_out(found, tmp_path):
    here = found()
    (tmp_path / "elsewhere").mkdir()
    assert found(folder=tmp_path / "elsewhere") == here
    assert found("# Ours.\n" + OWN.replace("\n", "\r\n"), HELPER.replace("\n", "\r\n")) == here


def test_what_the_function_does_not_name_does_not_count(found):
    here = found()
    assert found(OWN + "\ndef other():\n    pass\n", data=DATA + "OTHER = 7\n") == here


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("own", "x + 1.0", "x + 2.0"),
        ("own", "inner(x) + ", ""),
        ("helper", "2.0 * x", "3.0 * x"),
        ("helper", "@njit", "@njit(fastmath=True)"),
        ("helper", "STEEPNESS = 3.0", "STEEPNESS = 4.0"),
        ("data", "[1.0, 2.0]", "[1.5, 2.0]"),
        ("data", "[1.0, 2.0]", "[1, 2]"),
        ("data", "(1, 2)", "(1, 3)"),
    ],
)
def test_whatever_changes_what_it_computes_counts(found, file, old, new):
    texts = {"own": OWN, "helper": HELPER, "data": DATA}
    here = found()
    assert old in texts[file]
    texts[file] = texts[file].replace(old, new)
    changed = found(**texts)
    assert changed[0] != here[0]
    assert changed[1:] == here[1:]


def test_our_own_functions_are_left_to_the_version_of_the_engine(monkeypatch):
    here = [identity(each) for each in (select, winner_take_all)]
    monkeypatch.setattr(module._Walk, "_body", lambda *_: None)
    assert [identity(each) for each in (select, winner_take_all)] == here
    assert identity(winner_take_all) != identity(affordance_times_drive)


Point = namedtuple("Point", "x y")
Turned = namedtuple("Turned", "y x")


class Colour(enum.Enum):
    """Two colours."""

    RED = 1
    BLUE = 2


class Shade(enum.IntEnum):
    """The same, as numbers."""

    RED = 1
    BLUE = 2


APART: list[Any] = [
    *(0, 1, -1, 2**70, True, False, 0.0, -0.0, 1.0, math.nan, math.inf, 1j, -1j, "1", b"1", None),
    *(np.float64(1.0), np.float32(1.0), np.int64(1), np.bool_(True), np.datetime64(1, "s")),
    *((), (1,), ((1,),), (1.0,), (1, 2), (2, 1), [1, 2], {1, 2}, frozenset({1, 2})),
    *({1: 2}, {2: 1}, {"a": 1, "b": 2}, {"b": 2, "a": 1}, range(3), slice(3), ...),
    *(Point(1, 2), Turned(1, 2), Point, Turned, Colour.RED, Colour.BLUE, Shade.RED, Colour, Shade),
    *(np.zeros(2), np.zeros(3), np.zeros((2, 1)), np.zeros((1, 2)), np.zeros(2, np.float32)),
    *(np.array([0.0, -0.0]), np.array([math.nan, 0.0]), np.zeros(2, ">f8"), np.zeros(())),
    *(np.zeros(2, [("a", float)]), np.zeros(2, [("b", float)]), np.zeros(1, [("a", float)])[0]),
    *(np.arange(4).reshape(2, 2), np.arange(4).reshape(2, 2).T, np.arange(4)[::2]),
    *(math, np, math.sqrt, math.sin, np.sin, np.cos, np.float64, float, int, len, min, ValueError),
    *(np.dtype("f8"), numba.float64, numba.float32),
]
"""Values that are all different."""


here: Any = None


def takes_here() -> Any:
    return here


def taking(value: Any) -> Any:
    """Return a function that takes `value` from its globals."""
    return types.FunctionType(takes_here.__code__, {"here": value})


def of(value: Any) -> module.Identity:
    return identity(taking(value))


def test_values_that_differ_are_told_apart():
    found = [of(value) for value in APART]
    assert [one.unknown for one in found] == [None] * len(APART)
    assert len({one.text for one in found}) == len(APART)


def test_equal_values_are_not_told_apart_by_where_they_are():
    padded = np.dtype({"names": ["a", "b"], "formats": ["u1", "f8"], "offsets": [0, 8]})
    arrays = [np.frombuffer(bytes([fill]) * 32, np.uint8).copy().view(padded) for fill in (0, 1)]
    for array in arrays:
        array["a"], array["b"] = 3, 4.0
    assert of(arrays[0]) == of(arrays[1])
    assert of(np.arange(8)[::2]) == of(np.arange(0, 8, 2))
    assert of(frozenset({"a", "b", "c"})) == of(frozenset({"c", "b", "a"}))


def looped() -> list[Any]:
    own: list[Any] = []
    own.append(own)
    return own


@pytest.mark.parametrize(
    ("value", "named"),
    [
        (object(), "object"),
        (np.array([object()]), "ndarray"),
        ((1, [object()]), "object"),
        (looped(), "list"),
        (np.ma.array([1.0]), "ndarray"),
        (type("Own", (), {}), "type"),
        (iter([1]), "list_iterator"),
    ],
)
def test_what_cannot_be_identified_is_named(value, named):
    with pytest.raises(SettingsError, match=f"depends on here, which is of type {named}: "):
        lasting_identity(taking(value))


def test_the_source_files_are_those_of_users(found, tmp_path):
    found()
    own: Any = sys.modules["own"]
    assert source_files(own.own) == {str(tmp_path / name) for name in ("own.py", "helper.py")}


LEAVES = [0.5, 1, True, "a", None, (1, 2.0), Point(1.0, 2.0), Colour.RED, Shade.BLUE, 2j]

Place = tuple[str, ...]


@st.composite
def nests(draw: st.DrawFn, depth: int = 3) -> dict[str, Any]:
    """A module as a plan: by name a leaf, an array, a function of other names, or a module."""
    plan: dict[str, Any] = {}
    for name in draw(st.lists(st.sampled_from("abcd"), min_size=1, max_size=3, unique=True)):
        kinds = ["leaf", "array", "closure", "default", "helper", "module"]
        kind = draw(st.sampled_from(kinds if depth else kinds[:2]))
        if kind == "module":
            plan[name] = draw(nests(depth - 1))
        else:
            number = draw(st.integers(0, len(LEAVES) - 1)) if kind == "leaf" else draw(st.floats())
            plan[name] = (kind, number)
    return plan


def leaf(kind: str, number: Any) -> Any:
    """Build a leaf of a plan."""
    by_kind = {
        "leaf": lambda: LEAVES[number],
        "array": lambda: np.array([number, 1.0, 2.0])[::2],
        "closure": lambda: lambda: number,
        "default": lambda: types.FunctionType((lambda x: x).__code__, {}, "f", (number,)),
        "helper": lambda: numba.njit(taking(number)),
    }
    return by_kind[kind]()


def built(plan: dict[str, Any], order: int) -> types.ModuleType:
    """Build the module of a plan, its names in one of two orders."""
    made = types.ModuleType("made")
    for name in list(plan)[::order]:
        value = plan[name]
        if isinstance(value, dict):
            setattr(made, name, built(value, order))
            continue
        setattr(made, name, leaf(*value))
    return made


def leaves(plan: dict[str, Any]) -> list[Place]:
    return [
        (name, *inner)
        for name, value in plan.items()
        for inner in (leaves(value) if isinstance(value, dict) else [()])
    ]


def changed(plan: dict[str, Any], place: Place) -> dict[str, Any]:
    """Return a plan in which one leaf is another."""
    first, *rest = place
    value = plan[first]
    if rest:
        return {**plan, first: changed(value, tuple(rest))}
    kind, number = value
    other = (number + 1) % len(LEAVES) if kind == "leaf" else math.nextafter(number, 1e9)
    if kind != "leaf" and (math.isnan(number) or other == number):
        other = 1.0
    return {**plan, first: (kind, other)}


def over(root: types.ModuleType, places: list[Place], handed_on: bool) -> Any:
    """Return a function that asks for every leaf, directly or by a name of its own."""
    if handed_on:
        body = "    own = root\n" + "".join(f"    own.{'.'.join(place)}\n" for place in places)
    else:
        body = "".join(f"    root.{'.'.join(place)}\n" for place in places)
    around: dict[str, Any] = {"root": root}
    exec(f"def asks():\n{body}", around)
    return around["asks"]


@given(plan=nests(), data=st.data(), handed_on=st.booleans())
def test_one_leaf_of_any_nest_changes_it_and_building_it_again_does_not(plan, data, handed_on):
    places = leaves(plan)
    here = identity(over(built(plan, 1), places, handed_on))
    assert here.unknown is None
    assert identity(over(built(plan, -1), places, handed_on)) == here
    other = changed(plan, data.draw(st.sampled_from(places)))
    assert identity(over(built(other, 1), places, handed_on)).text != here.text

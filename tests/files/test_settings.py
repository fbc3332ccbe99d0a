"""Settings files: what is read, and that everything else is refused in one line a mistake."""

from __future__ import annotations

import json
import math
import os
import pickle
import tomllib
from pathlib import Path
from typing import Annotated, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field, model_validator

from animat.files.settings import Settings, SettingsError, nearest, read_toml


class Variable(Settings):
    rate: Annotated[float, Field(gt=0, lt=1)] = 1e-4
    set_point: float = 0.9
    law: Literal["decay", "growth"] = "decay"
    zone: tuple[float, float] = (0.0, 1.0)

    @model_validator(mode="after")
    def _set_point_in_zone(self) -> Variable:
        low, high = self.zone
        problems = []
        if low >= high:
            problems.append(f"zone = {self.zone} is empty")
        if not low <= self.set_point <= high:
            problems.append(f"set_point = {self.set_point} lies outside zone = {self.zone}")
        if problems:
            raise ValueError("\n".join(problems))
        return self


class Mind(Settings):
    agent: Literal["BLIND", "AF", "LEARNING"] = "BLIND"
    variables: dict[str, Variable] = {}
    mortal: bool = True


class Study(Settings):
    seed: Annotated[int, Field(ge=0)]
    mind: Mind = Mind()
    worlds: list[str] = []
    out: Path = Path("results")


GOOD = """
seed = 1
worlds = ["abundant", "scarce"]
out = "here"
[mind]
agent = "AF"
mortal = false
[mind.variables.nutrition]
rate = 0.001
set_point = 0.8
law = "growth"
zone = [0, 1.0]
"""


def read(folder: Path, text: str | bytes) -> Study:
    file = folder / "study.toml"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_toml(file, Study)


def refused(folder: Path, text: str | bytes) -> list[str]:
    """The lines of the refusal, without the file's name that leads each of them."""
    with pytest.raises(SettingsError) as caught:
        read(folder, text)
    file = f"{folder / 'study.toml'}: "
    lines = str(caught.value).split("\n")
    assert all(line.startswith(file) for line in lines)
    assert list(caught.value.problems) == lines
    return [line.removeprefix(file) for line in lines]


def test_a_good_file_is_read_whole(tmp_path):
    nutrition = Variable(rate=0.001, set_point=0.8, law="growth", zone=(0.0, 1.0))
    mind = Mind(agent="AF", mortal=False, variables={"nutrition": nutrition})
    expected = Study(seed=1, worlds=["abundant", "scarce"], out=Path("here"), mind=mind)
    assert read(tmp_path, GOOD) == expected
    assert read(tmp_path, b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode()) == expected


@given(value=st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_keep_every_bit(tmp_path_factory, value):
    class Number(Settings):
        value: float

    file = tmp_path_factory.mktemp("numbers") / "n.toml"
    file.write_text(f"value = {value!r}")
    assert read_toml(file, Number).value.hex() == value.hex()


def test_settings_cannot_be_changed():
    with pytest.raises(SettingsError, match="frozen"):
        Mind().agent = "AF"  # pyright: ignore[reportAttributeAccessIssue]


MISTAKES = {
    "[mind.variables.n]\nrate = -1": "key mind.variables.n.rate = -1: must be greater than 0",
    "[mind.variables.n]\nset_pont = 1": (
        'key mind.variables.n.set_pont: unknown key; did you mean "set_point"?'
    ),
    "[mind.variables.n]\nzzzz = 1": (
        "key mind.variables.n.zzzz: unknown key; known: rate, set_point, law, zone"
    ),
    '[mind.variables."my own"]\nrate = true': (
        'key mind.variables."my own".rate = true: must be a number'
    ),
    "[mind.variables.n]\nrate = nan": "key mind.variables.n.rate = nan: must be a finite number",
    "[mind.variables.n]\nset_point = -inf": (
        "key mind.variables.n.set_point = -inf: must be a finite number"
    ),
    "[mind.variables.n]\nset_point = 2": (
        "key mind.variables.n: set_point = 2.0 lies outside zone = (0.0, 1.0)"
    ),
    "[mind.variables.n]\nzone = [0, 1, 2]": (
        "key mind.variables.n.zone: must have at most 2 items, not 3"
    ),
    '[mind.variables.n]\nzone = [0, "1"]': 'key mind.variables.n.zone[1] = "1": must be a number',
    "[mind.variables]\nn = 3": "key mind.variables.n = 3: must be a table",
    '[mind]\nagent = "BLINT"': (
        'key mind.agent = "BLINT": must be one of "BLIND", "AF", "LEARNING"; did you mean "BLIND"?'
    ),
    '[mind]\nagent = "fa"': (
        'key mind.agent = "fa": must be one of "BLIND", "AF", "LEARNING"; did you mean "AF"?'
    ),
    '[mind]\nagent = "ghost"': (
        'key mind.agent = "ghost": must be one of "BLIND", "AF", "LEARNING"'
    ),
    "[mind]\nagent = 1": 'key mind.agent = 1: must be one of "BLIND", "AF", "LEARNING"',
    "[mind]\nmortal = 1": "key mind.mortal = 1: must be true or false",
    "mind = 1979-05-27": "key mind = 1979-05-27: is a date or a time; put text in quotes",
    "worlds = [07:32:00]": "key worlds[0] = 07:32:00: is a date or a time; put text in quotes",
    "out = 1979-05-27": "key out = 1979-05-27: is a date or a time; put text in quotes",
    'worlds = "abundant"': 'key worlds = "abundant": must be a list',
    "worlds = [1]": "key worlds[0] = 1: must be a string",
    "mood = 1": "key mood: unknown key; known: seed, mind, worlds, out",
}


@pytest.mark.parametrize(("text", "line"), MISTAKES.items())
def test_a_mistake_is_one_line(tmp_path, text, line):
    assert refused(tmp_path, "seed = 1\n" + text) == [line]


def test_a_missing_key_is_named(tmp_path):
    assert refused(tmp_path, "worlds = []") == ["key seed: missing key; it must be given"]
    assert refused(tmp_path, "seed = 1.0") == ["key seed = 1.0: must be a whole number"]


def test_all_mistakes_are_told_at_once(tmp_path):
    text = "[mind]\nmortal = 2\nagnt = 1\n[mind.variables.n]\nrate = 7\n[mind.variables.m]\nlaw=''"
    lines = refused(tmp_path, text)
    keys = ["seed", "mind.mortal", "mind.agnt", "mind.variables.n.rate", "mind.variables.m.law"]
    assert sorted(line.split()[1].rstrip(":") for line in lines) == sorted(keys)


def test_a_validator_may_find_several(tmp_path):
    assert refused(tmp_path, "seed = 1\n[mind.variables.n]\nzone = [1, 0]") == [
        "key mind.variables.n: zone = (1.0, 0.0) is empty",
        "key mind.variables.n: set_point = 0.9 lies outside zone = (1.0, 0.0)",
    ]


NO_SETTINGS = {
    "empty": ("", "is empty: it sets nothing"),
    "only a comment": ("# seed = 1\n\n", "is empty: it sets nothing"),
    "Latin-1": (b"seed = 1\nout = '\xe9t\xe9'", "is not UTF-8 text (line 2)"),
    "an image": (b"\x89PNG\r\n\x1a\n\x00", "is not UTF-8 text (line 1)"),
    "digits": (f"seed = {'9' * 5000}", "has a whole number of too many digits"),
    "lists": (f"seed = {'[' * 50}{']' * 50}", "is nested too deeply: more than 32 levels"),
    "many lists": ("seed = " + "[" * 100_000, "is nested too deeply: more than 32 levels"),
    "tables": (".".join("a" * 2000) + " = 1", "is nested too deeply: more than 32 levels"),
    "large": ("#" * 1_000_001, "is too large for a settings file: more than 1 MB"),
}


NO_TOML = {
    "zeros": (bytes(100), 1),
    "syntax": ("seed = 1\nmind = = 2", 2),
    "cut off": ("seed = 1\nworlds = [\n", 2),
    "twice": ("seed = 1\nseed = 2\n", 2),
}


@pytest.mark.parametrize("case", NO_TOML)
def test_what_is_no_toml_is_refused_with_its_line(tmp_path, case):
    text, number = NO_TOML[case]
    (line,) = refused(tmp_path, text)
    assert line.startswith("is not TOML: ")
    assert f"line {number}" in line


@pytest.mark.parametrize("case", NO_SETTINGS)
def test_what_is_no_settings_file_is_refused(tmp_path, case):
    text, line = NO_SETTINGS[case]
    assert refused(tmp_path, text) == [line]


def test_a_file_as_large_as_allowed_is_read(tmp_path):
    assert read(tmp_path, "seed = 1\n".ljust(1_000_000, "#")).seed == 1


def test_what_cannot_be_opened_is_refused(tmp_path):
    def message(path: Path | str) -> str:
        with pytest.raises(SettingsError) as caught:
            read_toml(path, Study)
        return str(caught.value)

    assert message(tmp_path / "none.toml") == f"{tmp_path / 'none.toml'}: no such file"
    assert message(tmp_path) == f"{tmp_path}: is a directory, not a settings file"
    assert message("a\0b").endswith("is no path: embedded null byte")
    assert message("a" * 5000).endswith("cannot be read: File name too long")
    locked = tmp_path / "locked.toml"
    locked.write_text(GOOD)
    locked.chmod(0)
    if not os.access(locked, os.R_OK):
        assert message(locked) == f"{locked}: cannot be read: Permission denied"


def test_python_gives_the_same_lines(tmp_path):
    data = tomllib.loads("seed = -1\n[mind]\nagent = 'LERNING'\n[mind.variables.n]\nrat = 1\n")
    with pytest.raises(SettingsError) as caught:
        Study(**data)
    file = refused(tmp_path, "seed = -1\nmind = {agent='LERNING', variables.n.rat=1}")
    assert list(caught.value.problems) == file
    assert len(file) == 3


def test_an_error_crosses_processes():
    error = SettingsError("a: one", "a: two")
    assert pickle.loads(pickle.dumps(error)).problems == error.problems
    assert str(pickle.loads(pickle.dumps(error))) == "a: one\na: two"


KEYS = st.sampled_from(["seed", "mind", "agent", "variables", "rate", "zone", "out", "x y", ""])
VALUES = st.recursive(
    st.booleans()
    | st.integers(-(2**70), 2**70)
    | st.floats()
    | st.text(st.characters(exclude_categories=["Cs"]), max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=3),
    max_leaves=8,
)


def toml(value: object) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml(k)} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return json.dumps(value)


def places(data: object, here: tuple = ()) -> list[tuple]:
    items = data.items() if isinstance(data, dict) else enumerate(data)  # pyright: ignore
    found = []
    for key, value in items:
        found.append((*here, key))
        if isinstance(value, dict | list):
            found += places(value, (*here, key))
    return found


@given(data=st.data())
def test_a_changed_value_is_either_read_or_named(tmp_path_factory, data):
    """The key of a refusal is where the value was put, above it, or within it."""
    content = tomllib.loads(GOOD)
    place = data.draw(st.sampled_from(places(content)))
    value = data.draw(VALUES)
    holder = content
    for key in place[:-1]:
        holder = holder[key]
    holder[place[-1]] = value
    folder = tmp_path_factory.mktemp("changed")
    text = "\n".join(f"{key} = {toml(value)}" for key, value in content.items())
    try:
        read(folder, text)
    except SettingsError:
        for line in refused(folder, text):
            assert line.startswith(f"key {place[0]}")
            assert ": " in line
            assert line.isprintable()
            assert "Input should" not in line


@given(data=st.data())
def test_a_misspelt_key_is_never_ignored(tmp_path_factory, data):
    content = tomllib.loads(GOOD)
    known = [place for place in places(content) if isinstance(place[-1], str)]
    place = data.draw(
        st.sampled_from([p for p in known if p[:2] != ("mind", "variables") or p[3:]])
    )
    cut = data.draw(st.integers(0, len(place[-1]) - 1))
    misspelt = place[-1][:cut] + data.draw(st.sampled_from(["", "q", "qq"])) + place[-1][cut + 1 :]
    holder = content
    for key in place[:-1]:
        holder = holder[key]
    holder[misspelt] = holder.pop(place[-1])
    text = "\n".join(f"{key} = {toml(value)}" for key, value in content.items())
    lines = refused(tmp_path_factory.mktemp("misspelt"), text)
    assert sum("unknown key" in line for line in lines) == 1
    if len(place[-1]) > 3:
        assert f'unknown key; did you mean "{place[-1]}"?' in "\n".join(lines)


@given(
    content=st.binary(max_size=200)
    | st.text(max_size=200).map(lambda t: t.encode("utf-8", "replace"))
)
def test_any_bytes_are_read_or_refused(tmp_path_factory, content):
    folder = tmp_path_factory.mktemp("bytes")
    try:
        read(folder, content)
    except SettingsError:
        assert refused(folder, content)


def test_the_nearest_name():
    known = ["set_point", "rate", "low", "high", "AF"]
    assert nearest("setpoint", known) == '; did you mean "set_point"?'
    assert nearest("RATE", known) == '; did you mean "rate"?'
    assert nearest("fa", known) == '; did you mean "AF"?'
    assert nearest("kind", known) == "; known: set_point, rate, low, high, AF"
    assert nearest("kind", {}) == ""
    assert nearest("hi", ["HI", "Hi", "low"]) == '; did you mean "HI"?'


@pytest.mark.parametrize("check", [Mind.model_validate, Mind.model_validate_json])
def test_what_pydantic_offers_refuses_like_a_constructor(check):
    given = {"agnt": "BLIND"}
    with pytest.raises(SettingsError) as by_name:
        Mind(**given)
    with pytest.raises(SettingsError) as told:
        check(given if check == Mind.model_validate else json.dumps(given))
    assert str(told.value) == str(by_name.value)
    assert Mind.model_validate_json('{"agent": "LEARNING"}') == Mind(agent="LEARNING")

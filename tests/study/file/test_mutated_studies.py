"""Hundreds of wrong study files: each is refused in lines, or means what it says.

Good files are changed at random. What an accepted file means is told here without the models: what
is written, over every default.
"""

from __future__ import annotations

import copy
import tomllib
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from animat.files.settings import SettingsError
from animat.study.file.cases import cases
from animat.study.file.read import read_study
from animat.study.file.study import Study

GOOD = """
name = "all of it"
seed = 3
lives = 10
steps = 20_000
paired = false
measures = ["likelihoods"]

[world]
layout = "rich"
spares = 1

[worlds.rich]
layout = "random"
counts = { TS = 2, CL = 1 }
gap = 60

[worlds.poor]
layout = "scarce"
resolution = 4.0

[robot]
infrared = "linear"
max_motor = 9

[mind]
agent = "AF"
physiology = "decay"
lethal_margin = 0.02
consumed = true

[mind.variables.nutrition]
set_point = 0.8

[mind.drives]
hunger = { a = { nutrition = 1.0 }, b = { nutrition = -50.0 } }
fatigue = { a = { stamina = 0.8, nutrition = 0.2 } }

[mind.behaviours.eat]
serves = "hunger"
needs = "grasp"
success = { nutrition = 0.3 }

[mind.behaviours.rest]
serves = "fatigue"
needs = "shelter"

[mind.learning]
cycles = 5

[teacher]
robots = 3
world = "rich"

[record]
what = "every:10"
lives = 2

[design.grid]
"mind.failure_effect" = [0, 0.1, 0.2]
meal = { small = { "mind.success_effect" = 0.1, "mind.interaction_steps" = 40 }, large = {} }
"teacher.steps" = [1_000, 2_000]

[design.sample]
method = "latin_hypercube"
points = 2
seed = 4
over = { "mind.learning.rate" = { low = 0.1, high = 1, scale = "log" }, "world.gap" = [50.0, 70] }

[[design.cases]]
"mind.gate" = "always"
"worlds.rich.counts.TS" = 1
[[design.cases]]
"worlds.rich.counts.TS" = 3

[[design.exclude]]
when = { "mind.failure_effect" = 0, meal = ["large"] }
why = "it would be the same"
"""

SMALL = """
name = "small"
[design.grid]
"world.layout" = ["abundant", "scarce"]
"mind.agent" = ["BLIND", "ORACLE"]
"""

WORDS = (
    "mind", "seed", "name", "lives", "design", "grid", "over", "mind.agent", "agent", "world",
    "layout", "counts", "TS", "low", "points", "BLIND", "ORACLE", "decay", "excess", "abundant",
    "scarce", "random", "rich", "poor", "nutrition", "hunger", "meal", "small", "large", "why",
    "mind.learning", "last:5", "linear", "clamp", "lethal", "always", "likelihoods",
)  # fmt: skip

TEXTS = st.sampled_from(["", "x y", "a.toml", "é", "\t", '"', "[", "1"]) | st.sampled_from(WORDS)

NUMBERS = (
    st.sampled_from([0, 1, 2, 8, -1, 0.5, -0.1, 1e-9, 1e300, 2**63, 10**30, 1.0, 64, 100.0])
    | st.integers(-(2**70), 2**70)
    | st.floats()
)

VALUES = st.recursive(
    st.booleans() | NUMBERS | TEXTS,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXTS, inner, max_size=3),
    max_leaves=6,
)

Place = tuple[str | int, ...]


def places(value: Any, here: Place = ()) -> list[Place]:
    """Where anything stands in a file."""
    if not isinstance(value, dict | list):
        return []
    items = value.items() if isinstance(value, dict) else enumerate(value)
    return [p for key, inner in items for p in ((*here, key), *places(inner, (*here, key)))]


def at(data: Any, place: Place) -> Any:
    for part in place:
        data = data[part]
    return data


def near(value: Any) -> st.SearchStrategy[Any]:
    """Values that might as well stand there."""
    if isinstance(value, bool):
        return st.sampled_from([not value, int(value), str(value)])
    if isinstance(value, int | float):
        return st.sampled_from([value + 1, 2 * value, value / 2, -value, float(value), str(value)])
    if isinstance(value, str):
        return st.sampled_from(WORDS)
    if isinstance(value, list):
        return st.just(value[::-1]) | st.just(value[1:])
    return st.just(dict(list(value.items())[1:]))


@st.composite
def mutations(draw: st.DrawFn) -> tuple[str, dict[str, Any]]:
    """A good study file with one to three things changed, and what was done to it last."""
    data = copy.deepcopy(tomllib.loads(draw(st.sampled_from([GOOD, GOOD, SMALL]))))
    kind = ""
    for _ in range(draw(st.sampled_from([1, 1, 1, 2, 3]))):
        if not (there := places(data)):
            break
        *above, last = draw(st.sampled_from(there))
        holder = at(data, tuple(above))
        kind = draw(st.sampled_from(MUTATIONS))
        if kind == "another value":
            holder[last] = draw(VALUES)
        elif kind == "a near value":
            holder[last] = draw(near(holder[last]))
        elif kind == "no key":
            del holder[last]
        elif kind == "wrapped":
            holder[last] = draw(st.sampled_from([[holder[last]], {str(last): holder[last]}]))
        elif kind == "twice" and isinstance(holder, list):
            holder.append(copy.deepcopy(holder[last]))
        elif kind == "elsewhere":
            moved = copy.deepcopy(holder[last])
            tables = [p for p in [(), *there] if isinstance(at(data, p), dict)]
            goal = at(data, draw(st.sampled_from(tables)))
            goal[str(last)] = moved
        elif kind == "a key more":
            tables = [p for p in [(), *there] if isinstance(at(data, p), dict)]
            at(data, draw(st.sampled_from(tables)))[draw(TEXTS)] = draw(VALUES)
        elif isinstance(holder, dict):
            cut = draw(st.integers(0, len(last) - 1)) if last else 0
            letter = draw(st.sampled_from(["", "q", ".", "_", last[cut : cut + 1] * 2]))
            holder[last[:cut] + letter + last[cut + 1 :]] = holder.pop(last)
    return kind, data


MUTATIONS = (
    "another value", "a near value", "a near value", "no key", "wrapped", "twice", "elsewhere",
    "a key more", "misspelt",
)  # fmt: skip


FREE = {
    "worlds", "mind.variables", "mind.drives", "mind.behaviours", "world.counts", "design.grid",
    "design.sample.over", "teacher.world.counts",
}  # fmt: skip
"""Tables with names of the user's own: what is written under a name is all there is of it."""

TEACHER = {"robots": 100, "steps": 300_000, "world": {}}
SAMPLE = {"seed": 0}
RANGE = {"scale": "linear"}
WORLD = {"layout": "abundant", "seed": 0, "gap": 70.0, "spares": 0, "resolution": 2.0}
RECORD = {"lives": 1}
DRIVE = {"b": {}}
DEFAULTS = tomllib.loads(Study(name="x").to_toml())


def meaning(data: dict[str, Any]) -> dict[str, Any]:
    """What an accepted file says, every default in it, as `Study.to_toml` is to write it."""
    said = _overlaid(DEFAULTS, data, "")
    said["worlds"] = {name: WORLD | world for name, world in data.get("worlds", {}).items()}
    for name, default in {"drives": DRIVE, "behaviours": {}}.items():
        parts = data.get("mind", {}).get(name, {})
        said["mind"][name] = DEFAULTS["mind"][name] | {
            part: default | given if isinstance(given, dict) else given
            for part, given in parts.items()
        }
    if "teacher" in data:
        said["teacher"] = TEACHER | data["teacher"]
        if isinstance(said["teacher"]["world"], str):
            said["teacher"]["world"] = {"layout": said["teacher"]["world"]}
    if "record" in data:
        said["record"] = RECORD | data["record"]
    design = {k: v for k, v in data.get("design", {}).items() if v not in ({}, [])}
    if "sample" in design:
        design["sample"] = SAMPLE | design["sample"]
        design["sample"]["over"] = {
            name: RANGE | over if isinstance(over, dict) and "low" in over and "high" in over
            and not isinstance(over["low"], dict) else over
            for name, over in design["sample"]["over"].items()
        }  # fmt: skip
    said.pop("design", None)
    return _without_empty(said | ({"design": design} if design else {}))


def written(study: Study) -> dict[str, Any]:
    """What the file that a study writes says."""
    return _without_empty(tomllib.loads(study.to_toml()))


def _without_empty(said: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in said.items() if value != {}}


def _overlaid(below: dict[str, Any], above: dict[str, Any], path: str) -> dict[str, Any]:
    result = dict(below)
    for key, value in above.items():
        here = f"{path}.{key}".lstrip(".")
        if here not in FREE and isinstance(value, dict) and isinstance(below.get(key), dict):
            result[key] = _overlaid(below[key], value, here)
        else:
            result[key] = value
    return result


def same(one: Any, other: Any) -> bool:
    """Tell whether two values of TOML are one; 1 is 1.0 but not true."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(same, one, other))
    return one == other and isinstance(one, bool) == isinstance(other, bool)


@pytest.fixture(scope="module")
def file(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("studies") / "study.toml"


def refused(file: Path) -> list[str]:
    """The lines of the refusal, without the file's name that leads each of them."""
    with pytest.raises(SettingsError) as caught:
        read_study(file)
    lines = str(caught.value).split("\n")
    assert len(set(lines)) == len(lines)
    for line in lines:
        assert line.startswith(f"{file}: ")
        assert line.isprintable()
        assert "Input should" not in line
    return [line.removeprefix(f"{file}: ") for line in lines]


@settings(max_examples=4 * settings().max_examples, suppress_health_check=list(HealthCheck))
@given(mutation=mutations())
def test_a_changed_study_is_refused_or_means_what_it_says(file, mutation):
    _, data = mutation
    file.write_text(tomli_w.dumps(data))
    try:
        study = read_study(file)
    except SettingsError:
        assert refused(file)
        return
    assert same(written(study), meaning(data))
    found = cases(study)
    file.write_text(study.to_toml())
    again = read_study(file)
    assert again == study
    assert cases(again) == found


@pytest.mark.parametrize("text", [GOOD, SMALL], ids=["good", "small"])
def test_a_good_study_means_what_it_says(file, text):
    file.write_text(text)
    assert same(written(read_study(file)), meaning(tomllib.loads(text)))

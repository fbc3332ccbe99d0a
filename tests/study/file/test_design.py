"""Designs and their cases, held against every combination written out by hand."""

from __future__ import annotations

import itertools
import tomllib
from collections import Counter
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.files.settings import SettingsError, validated
from animat.study.file.cases import Case, cases, excluded
from animat.study.file.design import Exclusion
from animat.study.file.settings import LifeSettings, WorldChoice
from animat.study.file.study import Study

POOL: dict[str, list[Any]] = {
    "mind.agent": ["BLIND", "ORACLE", "RANDOM", "AF"],
    "mind.physiology": ["excess", "decay", "linear"],
    "mind.success_effect": [0.1, 0.2, 1],
    "mind.consumed": [True, False],
    "mind.learning.cycles": [1, 5, 10],
    "mind.drives.hunger.a.nutrition": [0.5, 2.0],
    "mind.variables.stamina.set_point": [0.3, 0.4],
    "robot.infrared": ["linear", "michel1996"],
    "world.layout": ["abundant", "scarce"],
    "world.spares": [1, 2],
    "steps": [100, 200],
    "teacher.steps": [10, 20],
}


@st.composite
def designs(draw: st.DrawFn) -> dict[str, Any]:
    """A design: its keys dealt out to a grid, to levels, to a sample and to a list of cases."""
    keys = draw(st.permutations(sorted(POOL)))[: draw(st.integers(0, 7))]
    part = {key: draw(st.sampled_from(["grid", "grid", "levels", "over", "cases"])) for key in keys}
    of = {name: [key for key in keys if part[key] == name] for name in set(part.values())}

    def some(key: str) -> list[Any]:
        values = st.lists(st.sampled_from(POOL[key]), min_size=1, max_size=3, unique_by=repr)
        return draw(values)

    grid: dict[str, Any] = {key: some(key) for key in of.get("grid", [])}
    if "levels" in of:
        chosen = [{key: draw(st.sampled_from(POOL[key])) for key in of["levels"]}, {}]
        grid["mine"] = {f"level {number}": level for number, level in enumerate(chosen)}
    design: dict[str, Any] = {"grid": dict(draw(st.permutations(list(grid.items()))))}
    if "over" in of:
        over = {key: some(key) for key in of["over"]}
        design["sample"] = {"method": "latin_hypercube", "points": 3, "over": over}
    if "cases" in of:
        first = of["cases"][0]
        rows = [{first: value} for value in some(first)]
        for key in of["cases"][1:]:
            draw(st.sampled_from(rows))[key] = draw(st.sampled_from(POOL[key]))
        design["cases"] = rows
    return design


def study_of(design: dict[str, Any], **further: Any) -> Study:
    return validated({"name": "x", "teacher": {}, **further, "design": design}, Study)


def nested(changes: dict[str, Any]) -> dict[str, Any]:
    """Changes by dotted key over the defaults, as a settings file."""
    data: dict[str, Any] = {}
    for key, value in changes.items():
        *tables, last = key.split(".")
        holder = data
        for table in tables:
            holder = holder.setdefault(table, {})
        holder[last] = value
    if "drives" in data.get("mind", {}):
        data["mind"]["drives"]["hunger"] = {"a": data["mind"]["drives"]["hunger"]["a"]}
    return data


def written_out(design: dict[str, Any]) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Factors and changes of every combination, but for those of a sample."""
    axes = []
    for name, levels in design["grid"].items():
        if isinstance(levels, dict):
            axes.append([({name: level}, changes) for level, changes in levels.items()])
        else:
            axes.append([({name: value}, {name: value}) for value in levels])
    if "cases" in design:
        axes.append([(row, row) for row in design["cases"]])
    return [
        (
            {k: v for factors, _ in combination for k, v in factors.items()},
            {k: v for _, changes in combination for k, v in changes.items()},
        )
        for combination in itertools.product(*axes)
    ]


def check(case: Case, changes: dict[str, Any]) -> None:
    """Hold a case against what it should be when it is written in a settings file."""
    data = nested(changes)
    own = {name: data[name] for name in ("world", "robot", "mind") if name in data}
    assert case.settings == validated(own, LifeSettings)
    assert case.steps == changes.get("steps", 300_000)
    if changes.get("mind.agent") == "AF":
        assert case.teacher is not None
        assert case.teacher.steps == changes.get("teacher.steps", 300_000)
    else:
        assert case.teacher is None


@given(design=designs(), paired=st.booleans())
def test_cases_are_all_combinations_in_order(design, paired):
    study = study_of(design, paired=paired, seed=7, lives=5)
    found = cases(study)
    expected = written_out(design)
    points = design.get("sample", {}).get("points", 1)
    assert len(found) == len(expected) * points
    assert [case.number for case in found] == list(range(len(found)))
    assert {case.seed for case in found} == {7}
    assert [case.first for case in found] == [0 if paired else 5 * case.number for case in found]
    spread = list(design.get("sample", {}).get("over", {}))
    for case in found:
        at_point = {key: case.factors[key] for key in spread}
        assert all(value in POOL[key] for key, value in at_point.items())
        rows = len(design.get("cases", [None]))
        outer, row = divmod(case.number, rows)
        factors, changes = expected[outer // points * rows + row]
        assert factors.items() | at_point.items() <= case.factors.items()
        check(case, {**changes, **at_point})


@given(design=designs(), data=st.data())
def test_what_is_excluded_is_counted_once_and_not_a_case(design, data):
    everything = cases(study_of(design))
    names = [n for n in everything[0].factors if n in design["grid"]]
    rules = []
    for _ in range(data.draw(st.integers(1, 3)) if names else 0):
        named = data.draw(st.lists(st.sampled_from(names), min_size=1, unique=True))
        when = {n: data.draw(st.sampled_from(sorted(design["grid"][n], key=repr))) for n in named}
        rules.append({"when": when, "why": f"rule {len(rules)}"})
    first = Counter(
        next((r["why"] for r in rules if r["when"].items() <= case.factors.items()), None)
        for case in everything
    )
    study = study_of({**design, "exclude": rules})
    assert [(e.why, e.count) for e in excluded(study)] == [
        (rule["why"], first[rule["why"]]) for rule in rules
    ]
    if not first[None]:
        with pytest.raises(SettingsError, match="leaves no case"):
            cases(study)
        return
    left = cases(study)
    assert [case.number for case in left] == list(range(first[None]))
    kept = [case for case in everything if case.factors in [c.factors for c in left]]
    assert [c._replace(number=0) for c in left] == [c._replace(number=0) for c in kept]


def test_a_study_without_a_design_is_one_case():
    (case,) = cases(study_of({}))
    assert case.factors == {}
    assert case.settings == LifeSettings()


def test_a_case_that_leaves_a_key_out_has_the_value_in_force():
    rows = [{"mind.success_effect": 0.3}, {"mind.gate": "always", "mind.lethal_margin": 0.02}]
    one, two = cases(study_of({"cases": rows}, mind={"failure_effect": 0.1}))
    assert one.factors == {"mind.success_effect": 0.3, "mind.gate": "positive"}
    assert two.factors == {
        "mind.success_effect": 0.2, "mind.gate": "always", "mind.lethal_margin": 0.02
    }  # fmt: skip


def test_a_range_of_a_setting_of_whole_numbers_gives_whole_numbers():
    over = {
        "mind.interaction_steps": {"low": 1, "high": 4},
        "mind.learning.rate": {"low": 1, "high": 4},
    }
    sample = {"method": "sobol", "points": 64, "over": over}
    found = cases(study_of({"sample": sample}))
    steps = Counter(case.settings.mind.interaction_steps for case in found)
    assert steps == {1: 16, 2: 16, 3: 16, 4: 16}
    rates = [case.settings.mind.learning.rate for case in found]
    assert all(isinstance(rate, float) for rate in rates)
    assert len(set(rates)) == 64
    assert [case.factors["mind.learning.rate"] for case in found] == rates


RICH = {"layout": "random", "counts": {"TS": 2}, "seed": 4, "gap": 80.0}


def test_a_world_of_the_study_stands_in_the_place_of_its_name():
    grid = {"world.layout": ["abundant", "rich"], "mind.agent": ["AF"]}
    study = study_of({"grid": grid}, worlds={"rich": RICH}, teacher={"world": "rich"})
    abundant, rich = cases(study)
    assert abundant.settings.world == WorldChoice()
    assert rich.settings.world == WorldChoice(**RICH, name="rich")  # pyright: ignore
    assert rich.settings.world.world().name == "rich"
    for case in (abundant, rich):
        assert case.teacher is not None
        assert case.teacher.world == rich.settings.world
    assert rich.factors == {"world.layout": "rich", "mind.agent": "AF"}


def test_what_is_set_beside_the_name_of_a_world_goes_before_what_the_world_sets():
    beside = {"layout": "rich", "gap": 90.0, "spares": 1}
    (case,) = cases(study_of({}, worlds={"rich": RICH}, world=beside))
    assert case.settings.world == WorldChoice(**(RICH | {"gap": 90.0, "spares": 1, "name": "rich"}))
    design = {"grid": {"worlds.rich.counts.TS": [1, 3], "world.seed": [5]}}
    for case, count in zip(
        cases(study_of(design, worlds={"rich": RICH}, world=beside)), (1, 3), strict=True
    ):
        assert case.settings.world.counts == {"TS": count}
        assert case.settings.world.seed == 5
        assert case.settings.world.gap == 90.0


def test_a_world_may_go_by_another_name():
    (case,) = cases(
        study_of({}, worlds={"rich": RICH | {"name": "Eden"}}, world={"layout": "rich"})
    )
    assert case.settings.world.world().name == "Eden"


@given(design=designs())
def test_a_design_is_written_with_its_factors_in_their_order(design):
    study = study_of(design)
    again = tomllib.loads(study.design.to_toml()).get("design", {})
    assert [list(part) for part in (again.get("grid", {}), again.get("cases", []))] == [
        list(part) for part in (design["grid"], design.get("cases", []))
    ]
    same = study_of(again)
    assert same == study
    assert cases(same) == cases(study)
    assert [list(c.factors) for c in cases(same)] == [list(c.factors) for c in cases(study)]


@pytest.mark.parametrize("why", ["two\nlines", "\x1b[2J"])
def test_a_reason_is_a_line_that_can_be_printed(why):
    with pytest.raises(SettingsError, match="must be one line of what can be printed"):
        Exclusion(when={"mind.agent": "AF"}, why=why)

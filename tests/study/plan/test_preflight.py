"""Studies that cannot be lived are refused before any life is."""

from __future__ import annotations

import tomllib
from collections import Counter

import pytest

from animat.files.settings import SettingsError, validated
from animat.study.file.study import Study
from animat.study.plan.plan import Plan
from animat.study.plan.preflight import MOST_DRAWN, check_livable
from animat.world.arena import Arena
from animat.world.world import World


def plan_of(text: str) -> Plan:
    return Plan(validated({"name": "x", **tomllib.loads(text)}, Study))


def refused(text: str) -> list[str]:
    """The lines of a refusal, by the plan or by who looks further."""
    with pytest.raises(SettingsError) as caught:
        check_livable(plan_of(text))
    return list(caught.value.problems)


RICH = '[worlds.rich]\nlayout = "random"\ncounts = { TX = 2 }\n'

MISTAKES = {
    "an unknown type": (
        RICH + '[design.grid]\n"world.layout" = ["scarce", "rich"]\n"mind.gate" = ["always"]',
        'where world.layout = "rich", mind.gate = "always" (1 of 2 cases): counts: unknown type TX',
    ),
    "no such file": (
        '[design.grid]\n"world.layout" = ["scarce", "none.toml"]',
        'where world.layout = "none.toml" (1 of 2 cases): none.toml: no such file',
    ),
    "no room": (
        RICH.replace("TX = 2", "TL = 60") + '[world]\nlayout = "rich"',
        "the objects do not fit into",
    ),
    "no spare sites": (
        '[design.grid]\n"mind.consumed" = [true, false]',
        "where mind.consumed = true (1 of 2 cases): consumed = true needs spare sites",
    ),
    "none for the teacher": (
        '[mind]\nagent = "AF"\nconsumed = true\n[world]\nspares = 2\n[teacher]',
        "consumed = true needs spare sites",
    ),
    "what no object affords": (
        '[design.grid]\n"mind.behaviours.eat.needs" = ["grasp", "grsp"]',
        'behaviours.eat.needs = "grsp": no object of this world affords it; did you mean "grasp"?',
    ),
    "a function of no file": (
        '[mind]\nselector = "none.py:choose"',
        'selector = "none.py:choose": no such built-in and no such file',
    ),
    "a resolution": (
        "[world]\nresolution = 0.01",
        "resolution = 0.01; allowed are finite numbers from 0.1 to 50",
    ),
    "too many cells": (
        "[world]\nresolution = 0.1",
        "resolution = 0.1 mm makes 12,000 x 12,000 cells of an arena of 1000 x 1000 mm;"
        " allowed are 100,000,000",
    ),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_what_cannot_be_lived_is_told_with_its_cases(case):
    text, told = MISTAKES[case]
    (line,) = refused(text)
    assert told in line


def test_features_that_the_networks_do_not_know_are_told(tmp_path):
    kind = World.abundant().types[0].model_copy(update={"features": {"colour": 1.0}})
    other = tmp_path / "other.toml"
    World.random({"TS": 2}, types=(kind,)).save(other)
    text = f'[mind]\nagent = "AF"\n[teacher]\n[design.grid]\n"world.layout" = ["scarce", "{other}"]'
    (line,) = refused(text)
    assert "the networks know the features ('shape', 'size')" in line
    text = text.replace("[teacher]\n", f'[teacher]\nworld = "{other}"\n')
    (line,) = refused(text)
    assert 'where world.layout = "scarce"' in line


def test_a_world_without_room_for_the_robot_is_told(tmp_path):
    full = tmp_path / "full.toml"
    World.random({}, arena=Arena(width=125.0, height=125.0), name="full").save(full)
    wide = "[robot]\nring_radius = 40.0\n"
    text = f'{wide}[design.grid]\n"world.layout" = ["scarce", "{full}"]\n"mind.gate" = ["always"]'
    (line,) = refused(text)
    assert "(1 of 2 cases)" in line
    assert 'world "full" has no room for the robot to start' in line
    (line,) = refused(f'{wide}[mind]\nagent = "AF"\n[teacher]\nworld = "{full}"')
    assert line == 'world "full" has no room for the robot to start'


def test_what_can_be_lived_passes():
    check_livable(plan_of('[mind]\nagent = "AF"\n[teacher]\nworld = "scarce"'))


def test_each_world_is_drawn_once_for_each_reach(monkeypatch):
    plan = plan_of(
        '[design.grid]\n"mind.agent" = ["BLIND", "RANDOM", "AF"]\nsteps = [1, 2, 3]\n'
        '"world.layout" = ["abundant", "scarce"]\n"mind.encounter_range" = [20.0, 30.0]\n[teacher]'
    )
    drawn: Counter[str] = Counter()
    settings, classes = plan.setting, plan.setting_of_class

    def setting(place):
        case = plan.lived[place]
        drawn[f"{case.settings.world.layout} {case.settings.mind.encounter_range}"] += 1
        return settings(place)

    def setting_of_class(place):
        drawn["class"] += 1
        return classes(place)

    monkeypatch.setattr(plan, "setting", setting)
    monkeypatch.setattr(plan, "setting_of_class", setting_of_class)
    check_livable(plan)
    assert drawn == {
        f"{world} {reach}": 1 for world in ("abundant", "scarce") for reach in (20.0, 30.0)
    }


def test_of_very_many_worlds_not_all_are_drawn(monkeypatch):
    plan = plan_of(
        '[worlds.rich]\nlayout = "random"\ncounts = { TS = 1 }\n[world]\nlayout = "rich"\n'
        f"[design.grid]\n"
        f'"worlds.rich.seed" = {list(range(250))}'
    )
    drawn = []
    setting = plan.setting
    monkeypatch.setattr(plan, "setting", lambda place: drawn.append(place) or setting(place))
    check_livable(plan)
    assert drawn == list(range(0, 250, 3))
    assert len(drawn) <= MOST_DRAWN

"""Cases that cannot be lived are refused before any is."""

from __future__ import annotations

import tomllib
from collections import Counter

import pytest

import animat.study.livable
from animat.settings import SettingsError, validated
from animat.study.design import Case, cases
from animat.study.livable import check_livable
from animat.study.study import Study
from animat.world.world import World


def cases_of(text: str) -> list[Case]:
    return cases(validated({"name": "x", **tomllib.loads(text)}, Study))


def refused(text: str) -> list[str]:
    with pytest.raises(SettingsError) as caught:
        check_livable(cases_of(text))
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
    "a resolution": ("[world]\nresolution = 0.01", "resolution = 0.01: allowed is a length from"),
    "too many cells": ("[world]\nresolution = 0.1", "at most 100000000 cells are allowed"),
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


def test_what_can_be_lived_passes():
    check_livable(cases_of('[mind]\nagent = "AF"\n[teacher]\nworld = "scarce"'))


def test_what_cases_share_is_looked_at_once(monkeypatch):
    seen: Counter[str] = Counter()
    real = animat.study.livable.bring_together

    def counting(mind, world, robot):
        seen[f"{mind.agent} {world.name}"] += 1
        return real(mind, world, robot)

    monkeypatch.setattr(animat.study.livable, "bring_together", counting)
    check_livable(
        cases_of('[design.grid]\n"mind.agent" = ["BLIND", "RANDOM"]\nsteps = [1, 2, 3, 4]')
    )
    assert seen == {"BLIND abundant": 1, "RANDOM abundant": 1}

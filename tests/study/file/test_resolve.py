"""Sections of settings: validated once, and shared by the cases that do not differ in them."""

from __future__ import annotations

import tomllib

import animat.study.file.resolve
from animat.files.settings import validated
from animat.study.file.axes import axes, combinations
from animat.study.file.cases import cases
from animat.study.file.resolve import resolver
from animat.study.file.study import Study

TEXT = """
name = "x"
[mind]
gate = "always"
[teacher]
[worlds.rich]
layout = "scarce"
[design.grid]
"mind.agent" = ["BLIND", "AF"]
"mind.error" = ["signed", "absolute"]
"robot.infrared" = ["linear", "michel1996"]
"worlds.rich.spares" = [1, 2]
"world.layout" = ["abundant", "rich"]
"teacher.robots" = [1, 2]
steps = [1, 2]
"""


def test_what_does_not_differ_is_the_same_object():
    found = cases(validated(tomllib.loads(TEXT), Study))
    assert len(found) == 2**7
    assert len({id(case.settings.mind) for case in found}) == 4
    assert len({id(case.settings.robot) for case in found}) == 2
    assert len({id(case.settings.world) for case in found}) == 4
    assert len({id(case.teacher) for case in found if case.teacher}) == 4


def test_each_is_validated_once(monkeypatch):
    study = validated(tomllib.loads(TEXT), Study)
    along = axes(study.design, study)
    counted = []
    real = animat.study.file.resolve.validated
    monkeypatch.setattr(
        animat.study.file.resolve, "validated", lambda *args: counted.append(args) or real(*args)
    )
    base = study.varied()
    resolve = resolver(base, along)
    for combination in combinations(along):
        assert resolve(combination).problems == ()
    assert len(counted) == 4 + 2 + 2 + 4 + 4
    assert base == study.varied()


def test_all_that_is_wrong_with_a_case_is_told():
    text = '[design.grid]\n"mind.contact_range" = [90]\n"robot.wheel_base" = [60.0]\n'
    text += '"world.layout" = ["nowhere"]'
    study = validated({"name": "x"} | tomllib.loads(text), Study)
    resolved = resolver(study.varied(), axes(study.design, study))((0, 0, 0))
    lines = "\n".join(resolved.problems)
    for told in ("contact_range = 90.0", "wheel_base 60 mm", "key world.layout: world"):
        assert told in lines

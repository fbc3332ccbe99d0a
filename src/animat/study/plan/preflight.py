"""Whether a study can be lived, beyond what its plan knows: worlds are drawn and entered.

That costs more than reading the study, so it is done where nothing has been lived yet, and of very
many worlds not with all.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from animat.files.settings import SettingsError
from animat.life.scenario import Setting
from animat.study.file.cases import Case
from animat.study.file.messages import InCases, told
from animat.study.file.settings import WorldChoice
from animat.study.plan.plan import Plan

MOST_DRAWN = 100
"""Worlds that are drawn; of more, so many that are spread over the study."""


def check_livable(plan: Plan) -> None:
    """Refuse worlds that cannot be drawn, and those in which no robot finds a place to start.

    Raises:
        SettingsError: with a line for every mistake, and the cases that share it.
    """
    settings: dict[str, Callable[[], Setting]] = {}
    lived_in: dict[str, list[Case]] = {}
    for place, case in enumerate(plan.lived):
        mark = _mark(case, case.settings.world)
        settings.setdefault(mark, lambda place=place: plan.setting(place))
        lived_in.setdefault(mark, []).append(case)
    for place, each in enumerate(plan.classes):
        mark = _mark(each.case, each.teacher.world)
        settings.setdefault(mark, lambda place=place: plan.setting_of_class(place))
        lived_in.setdefault(mark, []).append(each.case)
    refused: dict[str, InCases] = {}
    for mark in list(settings)[:: math.ceil(len(settings) / MOST_DRAWN)]:
        first = lived_in[mark][0]
        for line in _problems(settings[mark], first):
            for case in lived_in[mark]:
                before = refused.get(line, InCases(0, case.factors, case.factors))
                refused[line] = before.and_in(case.factors)
    if refused:
        lines = (one.told(line, len(plan.lived)) for line, one in refused.items())
        raise SettingsError(*told(lines))


def _mark(case: Case, choice: WorldChoice) -> str:
    """Return what the drawing of a world, and where a robot may start in it, depend on."""
    robot, reach = case.settings.robot, case.settings.mind.encounter_range
    return f"{choice.model_dump_json()} {robot.model_dump_json()} {reach}"


def _problems(setting: Callable[[], Setting], case: Case) -> tuple[str, ...]:
    try:
        setting().begin(case.seed, np.array([case.first], np.uint64))
    except SettingsError as error:
        return error.problems
    except ValueError as error:
        return (str(error),)
    return ()

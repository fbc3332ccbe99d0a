"""Whether a study can be lived, beyond what its plan knows: every world is drawn and entered.

That costs more than reading the study, so it is done where nothing has been lived yet.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from animat.life.setting import Setting
from animat.settings import SettingsError
from animat.study.design import Case
from animat.study.plan import Plan
from animat.study.settings import WorldChoice
from animat.study.telling import InCases, told


def check_livable(plan: Plan) -> None:
    """Refuse worlds that cannot be drawn, and those in which no robot finds a place to start.

    Raises:
        SettingsError: with a line for every mistake, and the cases that share it.
    """
    drawn: dict[str, tuple[str, ...]] = {}
    refused: dict[str, InCases] = {}

    def draw(case: Case, choice: WorldChoice, setting: Callable[[], Setting]) -> None:
        """Draw what a case is lived in, once for all cases that are lived in the same."""
        robot, reach = case.settings.robot, case.settings.mind.encounter_range
        mark = f"{choice.model_dump_json()} {robot.model_dump_json()} {reach}"
        if mark not in drawn:
            drawn[mark] = _problems(setting, case.seed, case.first)
        for line in drawn[mark]:
            refused[line] = refused.get(line, InCases(0, case.factors, case.factors)).and_in(
                case.factors
            )

    for place, case in enumerate(plan.lived):
        draw(case, case.settings.world, lambda place=place: plan.setting(place))
    for place, each in enumerate(plan.classes):
        draw(each.case, each.teacher.world, lambda place=place: plan.setting_of_class(place))
    if refused:
        lines = (one.told(line, len(plan.lived)) for line, one in refused.items())
        raise SettingsError(*told(lines))


def _problems(setting: Callable[[], Setting], seed: int, first: int) -> tuple[str, ...]:
    try:
        setting().begin(seed, np.array([first], np.uint64))
    except SettingsError as error:
        return error.problems
    except ValueError as error:
        return (str(error),)
    return ()

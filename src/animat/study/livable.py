"""Whether the cases of a study can be lived: mind, robot and world of each are brought together.

This draws every world and compiles the user's functions, so it costs more than reading the file.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from animat.life.setting import bring_together
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.settings import SettingsError
from animat.study.design import Case
from animat.study.settings import WorldChoice
from animat.study.telling import InCases, told
from animat.world.world import World


def check_livable(cases: Sequence[Case]) -> None:
    """Refuse cases that cannot be lived: worlds that cannot be, minds that do not fit into them.

    Raises:
        SettingsError: with a line for every mistake, and the cases that share it.
    """
    worlds: dict[int, World | SettingsError] = {}
    checked: dict[tuple[int, ...], tuple[str, ...]] = {}
    refused: dict[str, InCases] = {}
    for case in cases:
        # Cases share the sections that do not differ, so most are the same objects.
        parts = (case.settings.world, case.settings.robot, case.settings.mind, case.teacher)
        mark = tuple(map(id, parts))
        if mark not in checked:
            checked[mark] = _problems(case, worlds)
        for line in checked[mark]:
            before = refused.get(line, InCases(0, case.factors, case.factors))
            refused[line] = before.and_in(case.factors)
    if refused:
        raise SettingsError(*told(one.told(line, len(cases)) for line, one in refused.items()))


def _problems(case: Case, worlds: dict[int, World | SettingsError]) -> tuple[str, ...]:
    """Return what keeps the lives of a case from being lived, a line for each mistake."""
    settings, mind = case.settings, case.settings.mind
    try:
        world = _world(settings.world, worlds)
        if case.teacher is not None:
            school = _world(case.teacher.world, worlds)
            bring_together(mind.model_copy(update={"agent": "LEARNING"}), school, settings.robot)
            mind = mind.model_copy(update={"networks": untaught(mind, school)})
        setting = bring_together(mind, world, settings.robot)
        setting.begin(case.seed, np.array([case.first], np.uint64))
    except SettingsError as error:
        return error.problems
    except ValueError as error:
        return (" ".join(str(error).split()),)
    return ()


def _world(choice: WorldChoice, worlds: dict[int, World | SettingsError]) -> World:
    """Return a world, laid out once however many cases choose it. Raises SettingsError."""
    if id(choice) not in worlds:
        try:
            worlds[id(choice)] = choice.world()
        except SettingsError as error:
            worlds[id(choice)] = error
    world = worlds[id(choice)]
    if isinstance(world, SettingsError):
        raise world
    return world


def untaught(mind: Mind, world: World) -> Networks:
    """Return networks of the shape that a robot with this mind learns in this world."""
    shape = len(mind.behaviours), mind.weight_count(len(world.feature_names))
    hidden = mind.learning.hidden_units
    return Networks(tuple(mind.behaviours), world.feature_names, hidden, np.zeros(shape))

"""A setting: mind, robot and world brought together, as the kernel takes them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from animat.files.arguments import boolean, instance
from animat.files.settings import SettingsError
from animat.files.validation_errors import plain
from animat.life.birth import born, clear_biases, draw_weights, place
from animat.life.state import Counts
from animat.mind.functions import BUILT_IN, Functions
from animat.mind.mind import Mind
from animat.mind.parameters import parameters
from animat.mind.trial import Surroundings, try_functions
from animat.names import LIKELIHOOD, spelled
from animat.numerics.layout import raw
from animat.robot.khepera import Khepera
from animat.world.raster import Raster
from animat.world.world import World


class LifeError(SettingsError):
    """Mind, robot and world do not go together, or a life was asked for that cannot be lived."""


class Setting(NamedTuple):
    """What lives are lived in: checked settings, and what the kernel reads of them.

    `constants` are mind, robot and raster as kernels take them.
    """

    mind: Mind
    robot: Khepera
    world: World
    mind_parameters: np.record
    robot_parameters: np.record
    raster: Raster
    functions: Functions
    counts: Counts
    constants: tuple[NDArray[Any], NDArray[Any], Raster]

    def begin(
        self, seed: int, lives: NDArray[np.uint64], weights: NDArray[np.float64] | None = None
    ) -> tuple[NDArray[np.void], NDArray[np.uint8]]:
        """Return states [L] and present objects [L, S] of lives at birth.

        `weights` [B, W] or [L, B, W] are the networks they are born with; without, they are those
        of the mind, or untrained. Raises LifeError where the world has no room to start.
        """
        if weights is None and self.mind.networks is not None:
            weights = self.mind.networks.weights
        states = born(self.counts, self.mind_parameters, len(lives), weights)
        present = np.zeros((len(lives), max(1, self.world.n_sites)), np.uint8)
        present[:, : self.world.n_objects] = 1
        arena = self.world.arena
        homeless = place.of(self.counts)(
            raw(states),
            present,
            lives,
            *self.constants[1:],
            np.uint64(seed),
            float(arena.width),
            float(arena.height),
        )
        if homeless:
            raise LifeError(f'world "{self.world.name}" has no room for the robot to start')
        if weights is None:
            draw_weights.of(self.counts)(raw(states), lives, np.uint64(seed))
            if not self.mind.learning.biases:
                clear_biases(states, self.counts.F, self.counts.H)
        return states, present


def bring_together(
    mind: Mind,
    world: World,
    robot: Khepera | None = None,
    functions: Functions | None = None,
    *,
    check_functions: bool = False,
) -> Setting:
    """Return the setting of a mind in a robot in a world.

    `functions` are the custom functions of the mind, where they are compiled already. They are
    tried; with `check_functions` they also check every index they use in every step. Raises
    LifeError, or FunctionError for a custom function that will not do.
    """
    instance("mind", mind, Mind, LifeError)
    instance("world", world, World, LifeError)
    robot = Khepera() if robot is None else instance("robot", robot, Khepera, LifeError)
    mind_parameters = checked_parameters(mind, world)
    horizon = robot.radius + mind.encounter_range + world.resolution
    body, raster = robot.parameters(), world.raster(horizon)
    check_functions = boolean("check_functions", check_functions, LifeError)
    functions = functions or mind.functions(check=check_functions)
    if functions != BUILT_IN:
        hidden = mind.learning.hidden_units
        around = Surroundings(raster.features, hidden, body.sensor_cosine, body.sensor_y)
        try_functions(functions, mind_parameters, around)
    counts = counts_of(mind, raster.features.shape[1], len(robot.sensors))
    records = [raw(np.array([one], one.dtype)) for one in (mind_parameters, body)]
    constants = records[0], records[1], raster
    return Setting(mind, robot, world, mind_parameters, body, raster, functions, counts, constants)


def counts_of(mind: Mind, features: int, sensors: int) -> Counts:
    """Return what the records of lives are shaped by, of a mind that sees so many features."""
    return Counts(
        V=len(mind.resolved_variables()),
        D=len(mind.drives),
        B=len(mind.behaviours),
        N=sensors,
        F=features,
        H=mind.learning.hidden_units,
        W=mind.weight_count(features),
    )


def checked_parameters(mind: Mind, world: World) -> np.record:
    """Return what the step reads of a mind in a world. Raises LifeError where they do not fit."""
    if mind.agent == "AF" and mind.networks is None:
        raise LifeError(
            "agent AF needs trained networks: live a LEARNING life first and give its networks,"
            ' Mind(agent="AF", networks=life.networks)'
        )
    if mind.networks is not None and mind.networks.features != world.feature_names:
        raise LifeError(
            f"the networks know the features {mind.networks.features},"
            f" the objects of this world have {world.feature_names}"
        )
    if mind.consumed and world.n_sites == world.n_objects:
        raise LifeError(
            "consumed = true needs spare sites to put objects to: give the world some,"
            " world.with_spares(2), or spares = 2"
        )
    if problems := _columns_twice(mind, world):
        raise LifeError(*problems)
    try:
        return parameters(mind, world.affordances)
    except ValueError as error:
        raise LifeError(str(error)) from error


def _columns_twice(mind: Mind, world: World) -> list[str]:
    """Tell of behaviours and object types whose names together give a column twice."""
    seen: dict[str, str] = {}
    problems = []
    for behaviour in mind.behaviours:
        for kind in world.types:
            (column,) = spelled([LIKELIHOOD], behaviour=[behaviour], object=[kind.name])
            pair = f"behaviour {plain(behaviour)} with object type {plain(kind.name)}"
            if (before := seen.setdefault(column, pair)) != pair:
                problems.append(f"{pair} and {before} give one column, {column}")
    return problems

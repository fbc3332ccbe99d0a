"""Small worlds, short lives, and what is said of them as columns of numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from numpy.typing import NDArray

from animat.life.life import Life, live
from animat.life.lives import live_on
from animat.life.setting import bring_together
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.robot.khepera import Khepera
from animat.world.arena import Arena
from animat.world.objects import TABLE_1
from animat.world.world import World

Columns = dict[str, NDArray[Any]]

SMALL = Arena(width=560.0, height=560.0)
ONE_EACH = {"TS": 1, "TL": 1, "CS": 1, "CL": 1}

QUIET = {"set_point": 0.5, "rate": 1e-9, "lethal": False}
"""Changes that make a variable of any physiology ask for nothing, almost for ever."""


def _columns(life: Life | pa.Table) -> Columns:
    table = life.trace if isinstance(life, Life) else life
    assert table is not None
    return {
        name: np.array(table[name].to_pylist(), object)
        if pa.types.is_dictionary(table[name].type)
        else table[name].to_numpy()
        for name in table.column_names
    }


def _affording(probability: float) -> World:
    """A small world in which every act succeeds with the same probability."""
    types = tuple(
        kind.model_copy(update={"affords": dict.fromkeys(kind.affords, probability)})
        for kind in TABLE_1
    )
    return World.random(ONE_EACH, seed=1, arena=SMALL, types=types, name="constant")


def _caring_for(variable: str, **changes: Any) -> dict[str, dict[str, Any]]:
    """Changes to the variables of a mind that leave only one that matters."""
    others = {name: QUIET for name in ("nutrition", "stamina", "restlessness") if name != variable}
    return {**others, variable: changes}


def _step_by_step(
    mind: Mind, world: World, steps: int, seed: int = 0, robot: Khepera | None = None
) -> Iterator[tuple[np.record, NDArray[np.uint8]]]:
    """Yield the state and the present objects of life 0 at birth and after every step."""
    setting = bring_together(mind, world, robot)
    lives = np.zeros(1, np.uint64)
    states, present = setting.begin(seed, lives)
    yield states[0].copy(), present[0].copy()
    for until in range(1, steps + 1):
        live_on(setting, seed, lives, states, present, until)
        yield states[0].copy(), present[0].copy()


@pytest.fixture(scope="session")
def columns() -> Callable[[Life | pa.Table], Columns]:
    return _columns


@pytest.fixture(scope="session")
def affording() -> Callable[[float], World]:
    return _affording


@pytest.fixture(scope="session")
def caring_for() -> Callable[..., dict[str, dict[str, Any]]]:
    return _caring_for


@pytest.fixture(scope="session")
def step_by_step() -> Callable[..., Iterator[tuple[np.record, NDArray[np.uint8]]]]:
    return _step_by_step


@pytest.fixture(scope="session")
def small() -> World:
    """One object of each type close together, and spare places."""
    return World.random(ONE_EACH, seed=1, arena=SMALL, name="small")


@pytest.fixture(scope="session")
def spared() -> World:
    """Few objects, and spare places to put them to."""
    return World.random({"TS": 2, "CL": 1}, seed=2, spares=3, name="spared")


@pytest.fixture(scope="session")
def trained() -> Networks:
    """The networks of a robot that learnt in a small world with two objects of each type."""
    world = World.random({"TS": 2, "TL": 2, "CS": 2, "CL": 2}, seed=3, name="school")
    slow = {"restlessness": {"law": "linear", "kind": "excess", "rate": 2e-4}}
    mind = Mind(agent="LEARNING", variables=slow)
    return live(mind, world, seed=1, steps=200_000).networks

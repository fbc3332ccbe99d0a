"""Small worlds, short lives, and what is said of them as columns of numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from numpy.typing import NDArray

from animat.life.batch import advance
from animat.life.life import Life, live
from animat.life.scenario import bring_together
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.robot.khepera import Khepera
from animat.world.arena import Arena
from animat.world.objects import TABLE_1
from animat.world.world import World

STEPS = 3_000

SMALL = Arena(width=560.0, height=560.0)
ONE_EACH = {"TS": 1, "TL": 1, "CS": 1, "CL": 1}

QUIET = {"set_point": 0.5, "rate": 1e-9, "lethal": False}
"""Changes that make a variable of any physiology ask for nothing, almost for ever."""


class Told(dict[str, Any]):
    """The columns of a trace as arrays, words as objects, and what tests ask of them.

    `life` is the life it is the trace of.
    """

    life: Life

    def happened(self, event: str) -> NDArray[np.bool_]:
        """Tell in which steps an event happened."""
        return np.array([event in text.split() for text in self["event"]])

    def before_any_outcome(self) -> slice:
        """Return the steps until the first act ends, at least thirty."""
        ended = np.flatnonzero(self["reward"])
        first = int(ended[0]) + 1 if len(ended) else len(self["step"])
        assert first > 30
        return slice(0, first)

    def drifted(self, variable: str, law: Callable[[NDArray[Any]], NDArray[Any]]) -> None:
        """Hold a variable, until the first act ended, to where it is after so many steps."""
        until = self.before_any_outcome()
        assert np.abs(self[variable][until] - law(self["step"][until] + 1)).max() < 1e-12

    def jumps(self, variable: str, behaviour: str, reward: int) -> NDArray[np.float64]:
        """Return how far outcomes moved a variable that hardly drifts; none met a bound."""
        ended = (self["reward"][:-1] == reward) & (self["behaviour"][:-1] == behaviour)
        values = self[variable]
        t = np.flatnonzero(ended & (values[:-1] > 0.25) & (values[:-1] < 0.95))
        assert len(t) > 0
        return values[t + 1] - values[t]

    def acts(self) -> Iterator[tuple[str, str, int, str]]:
        """Yield behaviour, object type, reward, and winning drive at the encounter, of each act."""
        met = np.flatnonzero(self.happened("encounter"))
        for t in np.flatnonzero(self["reward"]):
            start = met[met < t][-1]
            reward = int(self["reward"][t])
            yield self["behaviour"][t], self["object"][t], reward, self["winning_drive"][start]

    @staticmethod
    def runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
        """Return (first, last) of every run of True."""
        edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
        return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]

    def lengths(self, doing: str) -> list[int]:
        """Return how many steps each run of a behaviour took, the last aside."""
        return [last - first + 1 for first, last in self.runs(self["behaviour"] == doing)][:-1]

    def distances(self) -> NDArray[np.float64]:
        """Return how far (mm) the object dealt with is from the robot's centre in every row."""
        raster = self.life.setting.raster
        rows = (self["y"] / raster.resolution + raster.border).astype(int)
        places = (self["x"] / raster.resolution + raster.border).astype(int)
        here = raster.near_site[rows, places] == self["site"][:, None]
        return np.where(here, raster.near_distance[rows, places], np.inf).min(axis=1)

    def gone(self) -> NDArray[np.float64]:
        """Return how far (mm) each step led."""
        return np.hypot(np.diff(self["x"]), np.diff(self["y"]))

    def turned(self) -> NDArray[np.float64]:
        """Return how far (rad) each step turned the robot."""
        return (np.diff(self["heading"]) + math.pi) % math.tau - math.pi

    def free(self) -> NDArray[np.bool_]:
        """Tell after which steps the robot stands where its motors led it."""
        return ~self.happened("blocked")[:-1]


def _columns(life: Life) -> Told:
    table = life.trace
    assert table is not None
    told = Told(
        {
            name: np.array(table[name].to_pylist(), object)
            if pa.types.is_dictionary(table[name].type)
            else table[name].to_numpy()
            for name in table.column_names
        }
    )
    told.life = life
    return told


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
        advance(setting, seed, lives, states, present, until)
        yield states[0].copy(), present[0].copy()


@pytest.fixture(scope="session")
def columns() -> Callable[[Life], Told]:
    return _columns


@pytest.fixture(scope="session")
def lived(small: World) -> Callable[..., Told]:
    """Live a short life without death, and tell of it; equal settings give equal lives."""

    def lived(
        world: World = small, robot: Khepera | None = None, steps: int = STEPS, **settings: Any
    ) -> Told:
        mind = Mind(**{"death": False, **settings})
        return _columns(live(mind, world, robot=robot, seed=4, steps=steps, record="all"))

    return lived


@pytest.fixture(scope="session")
def usual(lived: Callable[..., Told]) -> Told:
    return lived()


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

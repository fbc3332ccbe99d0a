"""Experiment 1: can affordances be learnt? (paper, "First Experiment Set"; Figures 3 and 4)

Robots of the kind LEARNING live in World 1 for 300,000 steps without dying. Reported are what
their networks say of every object type at the end, how that came about over the episodes, and the
last steps of the first robot.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from threading import Event
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.life.life import Progress, live
from animat.life.likelihoods import afforded, likelihoods
from animat.life.lives import live_on
from animat.life.setting import Setting, bring_together
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.robot.khepera import Khepera
from animat.world.world import World

LOOK_EVERY = 250
"""Steps between two looks at the networks while a learning curve is drawn."""

CURVE_EPISODES = 200
"""How many episodes a learning curve shows."""

LAST = 500
"""How many of the last steps Figures 3 and 4 show."""

CHUNK = 16


class Learnt(NamedTuple):
    """What came of Experiment 1.

    `final` (seed, network, object, likelihood, afforded) and `curve` (seed, episode, network,
    object, likelihood) have a row for each network and object type; `networks` are those of the
    robots in turn; `trace` is that of the first robot's last steps.
    """

    final: pa.Table
    curve: pa.Table
    networks: list[Networks]
    trace: pa.Table


def learn(
    mind: Mind,
    world: World,
    robot: Khepera,
    *,
    robots: int,
    steps: int,
    seed: int,
    progress: Progress | None = None,
) -> Learnt:
    """Let robots learn; `mind` is that of Experiment 2, only its agent is taken to be LEARNING.

    `progress` is called with steps lived. Raises LifeError for what cannot be lived.
    """
    learner = mind.model_copy(update={"agent": "LEARNING", "networks": None})
    setting = bring_together(learner, world, robot)
    stop = Event()
    starts = range(0, robots, CHUNK)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        try:
            parts = list(
                pool.map(
                    lambda start: _learn_chunk(
                        setting,
                        seed,
                        np.arange(start, min(start + CHUNK, robots), dtype=np.uint64),
                        steps,
                        stop,
                        progress,
                    ),
                    starts,
                )
            )
        finally:
            stop.set()
    states = np.concatenate([states for states, _ in parts])
    networks = [
        Networks(
            tuple(learner.behaviours), world.feature_names, learner.learning.hidden_units, weights
        )
        for weights in states["weights"]
    ]
    last = live(
        learner, world, robot=robot, seed=seed, steps=steps, record=f"last:{min(LAST, steps)}"
    )
    assert last.trace is not None
    return Learnt(
        _final(setting, states),
        _curve(setting, np.concatenate([curve for _, curve in parts])),
        networks,
        last.trace,
    )


def _learn_chunk(
    setting: Setting,
    seed: int,
    lives: NDArray[np.uint64],
    steps: int,
    stop: Event,
    progress: Progress | None,
) -> tuple[NDArray[np.void], NDArray[np.float64]]:
    """Return the states [L] at the end and the curve [L, CURVE_EPISODES + 1, B, T]."""
    states, present = setting.begin(seed, lives)
    known = likelihoods(setting, states)
    curve = np.repeat(known[:, None], CURVE_EPISODES + 1, axis=1)
    until = 0
    while until < steps and not stop.is_set():
        episodes = states["trainings"].copy()
        curving = episodes.min() < CURVE_EPISODES
        until = min(until + (LOOK_EVERY if curving else 40 * LOOK_EVERY), steps)
        before = int(states["step"].sum())
        live_on(setting, seed, lives, states, present, until)
        if progress:
            progress(int(states["step"].sum()) - before)
        if curving:
            known = likelihoods(setting, states)
            for row, episode in enumerate(states["trainings"]):
                if episode > episodes[row]:
                    curve[row, episode:] = known[row]
    return states, curve


def _final(setting: Setting, states: NDArray[np.void]) -> pa.Table:
    said = likelihoods(setting, states)
    return _long(setting, said, {"seed": np.arange(len(states))}).append_column(
        "afforded", pa.array(np.broadcast_to(afforded(setting), said.shape).ravel())
    )


def _curve(setting: Setting, curve: NDArray[np.float64]) -> pa.Table:
    return _long(
        setting,
        curve,
        {"seed": np.arange(curve.shape[0]), "episode": np.arange(curve.shape[1])},
    )


def _long(setting: Setting, said: NDArray, axes: dict[str, NDArray[np.int64]]) -> pa.Table:
    """Return likelihoods [..., B, T] as a table with a row for each of them."""
    columns: dict[str, pa.Array] = {}
    names = {
        "network": list(setting.mind.behaviours),
        "object": [t.name for t in setting.world.types],
    }
    for axis, (name, values) in enumerate({**axes, **names}.items()):
        shape = [1] * said.ndim
        shape[axis] = -1
        codes = np.broadcast_to(np.arange(len(values)).reshape(shape), said.shape).ravel()
        if name in names:
            columns[name] = pa.DictionaryArray.from_arrays(
                pa.array(codes, pa.int32()), pa.array(values)
            )
        else:
            columns[name] = pa.array(np.asarray(values)[codes])
    columns["likelihood"] = pa.array(said.ravel())
    return pa.table(columns)

"""Experiment 1: can affordances be learnt? (paper, "First Experiment Set"; Figures 3 and 4)

Robots of the kind LEARNING live in World 1 for 300,000 steps without dying. Reported are what
their networks say of every object type at the end, how that came about over the episodes of each
network, and the last steps of one robot.
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

LOOK_EVERY = 500
"""Steps between two looks at the networks, for the learning curve; an act takes 20 and more."""

CURVE_EPISODES = 100
"""How many episodes of each network a learning curve shows."""

LAST = 500
"""How many of the last steps Figures 3 and 4 show."""

CHUNK = 16


class Learnt(NamedTuple):
    """What came of Experiment 1.

    `final` (seed, network, object, likelihood, afforded) and `curve` (seed, episode, network,
    object, likelihood) have a row for each network and object type, an episode being an act of the
    network's behaviour; `networks` are those of the robots in turn; `trace` holds the last steps
    of the robot `shown`, the first of those that ran most of the behaviours, and most often, in
    these steps.
    """

    final: pa.Table
    curve: pa.Table
    networks: list[Networks]
    shown: int
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
    states, curve, recent = (np.concatenate(part) for part in zip(*parts, strict=True))
    networks = [
        Networks(
            tuple(learner.behaviours), world.feature_names, learner.learning.hidden_units, weights
        )
        for weights in states["weights"]
    ]
    shown = int(np.argmax(steps * (recent > 0).sum(axis=1) + recent.sum(axis=1)))
    last = live(
        learner,
        world,
        robot=robot,
        seed=seed,
        life=shown,
        steps=steps,
        record=f"last:{min(LAST, steps)}",
    )
    assert last.trace is not None
    return Learnt(
        _final(setting, states),
        _curve(setting, curve),
        networks,
        shown,
        last.trace,
    )


def _learn_chunk(
    setting: Setting,
    seed: int,
    lives: NDArray[np.uint64],
    steps: int,
    stop: Event,
    progress: Progress | None,
) -> tuple[NDArray[np.void], NDArray[np.float64], NDArray[np.int64]]:
    """Return of L robots the states [L] at the end, curves and acts in the last steps.

    The curves [L, CURVE_EPISODES + 1, B, T] are over the episodes of each network; the acts are
    [L, B].
    """
    states, present = setting.begin(seed, lives)
    curve = np.repeat(likelihoods(setting, states)[:, None], CURVE_EPISODES + 1, axis=1)
    acts = states["acts_by_behaviour"].copy()
    recent = acts
    lived = 0
    for until in [*range(LOOK_EVERY, steps - LAST, LOOK_EVERY), max(steps - LAST, 0), steps]:
        if stop.is_set():
            break
        live_on(setting, seed, lives, states, present, until)
        known = likelihoods(setting, states)
        recent = states["acts_by_behaviour"] - acts
        for row, behaviour in zip(*np.nonzero(recent), strict=True):
            curve[row, acts[row, behaviour] + 1 :, behaviour] = known[row, behaviour]
        acts = states["acts_by_behaviour"].copy()
        if progress:
            progress(len(lives) * (until - lived))
        lived = until
    return states, curve, recent


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

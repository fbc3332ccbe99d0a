"""One life from the command line: lived, told in a few lines, its trace and figure written.

A life lived again is the same life. So it is lived first to see how long it is, and again for its
trace and for its figure, and memory does not grow with its length.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow.parquet as pq

from animat.files import check_writable, whole
from animat.life.life import Life, Recording, check, live, lived
from animat.life.setting import bring_together
from animat.life.trace import table
from animat.mind.mind import Mind
from animat.progress import Telling
from animat.study.settings import LifeSettings
from animat.world.world import World

LEARNING_STEPS = 300_000
"""How long AF has learnt before it lives, as in Experiment 1."""

FIGURE_ROWS = 300_000
"""How many steps of a life a figure is drawn from at most; of a longer one, every n-th."""

DRAWINGS = (".svg", ".png", ".pdf")


class OneLife(NamedTuple):
    """Which life to live, and what to write of it."""

    settings: LifeSettings
    seed: int
    index: int
    steps: int
    trace: Path | None
    figure: Path | None
    force: bool


def live_one(asked: OneLife, tell: Telling) -> Life:
    """Live a life, write its trace and figure where asked, and return it without a trace.

    An AF without networks learns first, as in Experiment 1. Raises SettingsError for what cannot
    be lived or written.
    """
    check(asked.seed, asked.index, asked.steps)
    if asked.trace:
        check_writable(asked.trace, (".parquet",), force=asked.force)
    if asked.figure:
        check_writable(asked.figure, DRAWINGS, force=asked.force)
    world = asked.settings.world.world()
    mind = asked.settings.mind
    if mind.agent == "AF" and mind.networks is None:
        mind = _taught(asked, mind, world, tell)
    life = _live(
        asked,
        mind,
        world,
        steps=asked.steps,
        progress=lambda steps: tell("Life, steps", steps, asked.steps),
    )
    if asked.trace:
        with whole(asked.trace) as partial:
            _write_trace(life, partial)
    if asked.figure:
        every = max(1, life.lifespan // FIGURE_ROWS)
        drawn = _live(asked, mind, world, steps=asked.steps, record=f"every:{every}").figure()
        with whole(asked.figure) as partial:
            drawn.savefig(partial, format=asked.figure.suffix[1:].lower())
    return life


def story(life: Life) -> list[str]:
    """Return in a few lines how a life went and why it ended."""
    told = life.summary
    acts, successes = told["acts"], told["successes"]
    ended = f"died of {life.death}" if life.dead else "was alive at the cap"
    lines = [
        f"{life.mind.agent} in {life.world.name}, physiology {life.mind.physiology},"
        f" seed {life.seed}, life {life.index}",
        f"lived {life.lifespan:,} steps and {ended}",
        f"met {told['encounters']:,} objects, disregarded {told['disregarded']:,},"
        f" did not reach {told['unreached']:,}",
        f"acted {acts:,} times, {successes:,} with success: "
        + ", ".join(
            f"{name} {told[f'successes_{name}']} of {told[f'acts_{name}']}"
            for name in life.mind.behaviours
        ),
        "at the end "
        + ", ".join(
            f"{name} {value:.3f}"
            for name, value in zip(
                life.mind.resolved_variables(), life.state["values"], strict=True
            )
        )
        + f"; mean drive {told['mean_drive']:.3f}",
    ]
    if life.mind.nature.learns:
        for kind in life.world.types:
            said = life.networks.likelihoods(kind.features)
            lines.append(
                f"{kind.name} affords "
                + ", ".join(f"{name} {value:.2f}" for name, value in said.items())
            )
    return lines


def _live(asked: OneLife, mind: Mind, world: World, **further: Any) -> Life:
    """Live the life asked for, with this mind in this world."""
    robot, seed, index = asked.settings.robot, asked.seed, asked.index
    return live(mind, world, robot=robot, seed=seed, life=index, **further)


def _taught(asked: OneLife, mind: Mind, world: World, tell: Telling) -> Mind:
    learner = mind.model_copy(update={"agent": "LEARNING"})
    learnt = _live(
        asked,
        learner,
        world,
        steps=LEARNING_STEPS,
        progress=lambda steps: tell("Learning first, steps", steps, LEARNING_STEPS),
    )
    return mind.model_copy(update={"networks": learnt.networks})


def _write_trace(life: Life, path: Path) -> None:
    """Live the life again and write a row for every step, a part at a time."""
    setting = bring_together(life.mind, life.world, life.setting.robot)
    states, present = setting.begin(life.seed, np.array([life.index], np.uint64))
    parts = lived(setting, states, present, life.seed, life.index, life.lifespan, Recording())
    first = table(next(parts), life.mind, life.world)
    with pq.ParquetWriter(path, first.schema) as writer:
        writer.write_table(first)
        for part in parts:
            writer.write_table(table(part, life.mind, life.world))

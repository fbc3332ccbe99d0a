"""One life from the command line: lived, told in a few lines, its recording, trace, figure written.

A life lived again is the same life. So it is lived first to see how long it is, and again for its
trace and for its figure, and memory does not grow with its length.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyarrow as pa

from animat.files.arguments import callback, file
from animat.files.atomic import check_writable, whole
from animat.files.provenance import provenance
from animat.files.settings import SettingsError
from animat.files.tables import write_tables
from animat.life.life import Life, Moment, Progress, TraceChoice, birth, check, drawn, live, lived
from animat.life.likelihoods import likelihoods
from animat.life.scenario import LifeError, bring_together, checked_parameters
from animat.life.trace import table
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.progress import Telling
from animat.recording.recording import EVERY, Recording, write_recording
from animat.robot.khepera import Khepera
from animat.study.file.settings import LifeSettings
from animat.study.plan.identity import networks_matter
from animat.world.world import World

STEPS = 300_000
"""The cap of a life."""

LEARNING_STEPS = 300_000
"""How long AF has learnt before it lives, as in Experiment 1."""

DRAWINGS = (".svg", ".png", ".pdf")


class OneLife(NamedTuple):
    """Which life to live, and what to write of it.

    It is born with the settings, seed and index, or, if there is a `source`, taken from that
    recording where it has lived `at` steps, all that were recorded if None. It is lived up to
    `steps`: 300,000 if None, or what the recording says. `every` is EVERY if None. With
    `check_functions`, custom functions check every index they use. `networks` are read at birth,
    `save_networks` written at the end.
    """

    settings: LifeSettings
    seed: int
    index: int
    steps: int | None
    trace: Path | None
    figure: Path | None
    force: bool
    record: Path | None = None
    every: int | None = None
    source: Path | None = None
    at: int | None = None
    check_functions: bool = False
    networks: Path | None = None
    save_networks: Path | None = None


def live_one(asked: OneLife, tell: Telling) -> Life:
    """Live a life, write its files where asked, and return it without a trace.

    An AF without networks learns first, as in Experiment 1. Raises SettingsError for what cannot
    be lived or written.
    """
    _check_files(asked)
    moment, steps = _born(asked, tell) if asked.source is None else _recorded(asked.source, asked)

    def progress(more: int) -> None:
        tell("Life, steps", more, steps - moment.step)

    if asked.record:
        life = write_recording(
            asked.record,
            moment,
            steps=steps,
            every=EVERY if asked.every is None else asked.every,
            made=provenance(),
            progress=progress,
        )
    else:
        life = moment.live(steps, progress=progress)
    if asked.trace:
        with whole(asked.trace) as partial:
            write_tables(
                _trace(moment.copy(), life.lifespan),
                partial,
                csv=asked.trace.suffix.lower() == ".csv",
            )
    if asked.figure:
        mind, world = moment.setting.mind, moment.setting.world
        rows = lived(moment.copy(), life.lifespan, TraceChoice())
        parts = (table(part, mind, world) for part in rows)
        picture = drawn(life, parts, (moment.step, life.lifespan))
        with whole(asked.figure) as partial:
            picture.savefig(partial, format=asked.figure.suffix[1:].lower())
    if asked.save_networks:
        life.networks.save(asked.save_networks)
    return life


def record(
    mind: Mind,
    world: World,
    path: str | Path,
    *,
    robot: Khepera | None = None,
    seed: int = 0,
    life: int = 0,
    steps: int = 300_000,
    every: int = EVERY,
    progress: Progress | None = None,
    check_functions: bool = False,
) -> Life:
    """Live one life as `live` does, write its recording to `path`, and return it without a trace.

    Every `every` steps the whole state is kept. A file that was there is replaced, when the new
    one is whole. Raises SettingsError for what cannot be lived, recorded or written; a life that
    fails (FailedLifeError) leaves no file.
    """
    seed, life, steps = check(seed, life, steps)
    callback("progress", progress, LifeError)
    setting = bring_together(mind, world, robot, check_functions=check_functions)
    moment = birth(setting, seed, life)
    return write_recording(
        file("path", path), moment, steps=steps, every=every, made=provenance(), progress=progress
    )


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
        (said,) = likelihoods(life.setting, np.array([life.state], life.state.dtype))
        for t, kind in enumerate(life.world.types):
            each = zip(life.mind.behaviours, said[:, t], strict=True)
            lines.append(
                f"{kind.name} affords " + ", ".join(f"{name} {value:.2f}" for name, value in each)
            )
    return lines


def _born(asked: OneLife, tell: Telling) -> tuple[Moment, int]:
    """Return the beginning of a life, and up to which step it is to be lived."""
    steps = STEPS if asked.steps is None else asked.steps
    check(asked.seed, asked.index, steps)
    settings = asked.settings
    world, mind = settings.world.world(), settings.mind
    if asked.networks is not None:
        mind = _knowing(mind, world, asked.networks)
    if mind.agent == "AF" and mind.networks is None:
        learnt = live(
            mind.model_copy(update={"agent": "LEARNING"}),
            world,
            robot=settings.robot,
            seed=asked.seed,
            life=asked.index,
            steps=LEARNING_STEPS,
            progress=lambda more: tell("Learning first, steps", more, LEARNING_STEPS),
            check_functions=asked.check_functions,
        )
        mind = mind.model_copy(update={"networks": learnt.networks})
    setting = bring_together(mind, world, settings.robot, check_functions=asked.check_functions)
    return birth(setting, asked.seed, asked.index), steps


def _knowing(mind: Mind, world: World, path: Path) -> Mind:
    """Return a mind with the networks of a file. Raises SettingsError where they do not fit."""
    networks = Networks.load(path)
    try:
        knowing = Mind(**{**dict(mind), "networks": networks})
        record = checked_parameters(knowing, world)
    except SettingsError as error:
        raise type(error)(*(f"{path}: {line}" for line in error.problems)) from None
    if not networks_matter(record):
        raise LifeError(f"{path}: the agent {mind.agent} asks no networks; take AF or LEARNING")
    return knowing


def _recorded(source: Path, asked: OneLife) -> tuple[Moment, int]:
    """Return the moment a recorded life is to go on from, and up to which step."""
    recording = Recording.load(source)
    head = recording.head
    steps = head.steps if asked.steps is None else asked.steps
    moment = recording.at(head.last if asked.at is None else asked.at)
    if asked.check_functions:
        setting = moment.setting
        checked = setting.mind.functions(check=True)
        moment = moment._replace(setting=setting._replace(functions=checked))
    if moment.state.dead:
        raise LifeError(f"{source}: the life ended at step {moment.step}; go on from before, --at")
    if steps <= moment.step:
        raise LifeError(
            f"steps = {steps}: the life has lived {moment.step} steps already; give more"
        )
    return moment, steps


def _trace(moment: Moment, until: int) -> Iterator[pa.Table]:
    """Live a life on, in place, and yield a row for every step, a part at a time."""
    mind, world = moment.setting.mind, moment.setting.world
    for part in lived(moment, until, TraceChoice()):
        yield table(part, mind, world)


def _check_files(asked: OneLife) -> None:
    """Refuse, before any work, files that could not be written at its end."""
    for path, suffixes in (
        (asked.trace, (".parquet", ".csv")),
        (asked.save_networks, (".toml",)),
        (asked.figure, DRAWINGS),
        (asked.record, (".parquet",)),
    ):
        if path is not None:
            check_writable(path, suffixes, force=asked.force)
    if asked.record and asked.trace and asked.record.resolve() == asked.trace.resolve():
        raise SettingsError(f"{asked.record}: is to be both trace and recording; give two names")

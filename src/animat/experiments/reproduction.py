"""The reproduction of the paper: both experiments, and the verdict on every claim.

The experiments are the studies that come with animat, simulated into a directory each, so that a
reproduction that was interrupted can be resumed.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc

from animat.experiments.experiment1 import Learnt, learnt
from animat.files.atomic import RunError
from animat.files.settings import SettingsError, validated
from animat.life.life import check as check_life
from animat.life.scenario import LifeError
from animat.progress import Telling
from animat.statistics.lives import cell, cells, first_lives
from animat.statistics.paper_claims import Claim, judge
from animat.statistics.survival import CellSummary, LogRank, logrank, summarise
from animat.study.execute.run import run, threads
from animat.study.file.builtin import shipped
from animat.study.file.read import read_study
from animat.study.file.settings import LifeSettings, WorldChoice
from animat.study.file.study import Study
from animat.study.plan.plan import Plan, plan_of
from animat.study.store.manifest import MANIFEST, differences_from
from animat.study.store.results import Results
from animat.world.world import World

PAPERS_LIVES = 20
"""Lives in each cell of the paper's Figure 5."""

SPARES = 2
"""Spare sites of every type, where objects that were used are put elsewhere."""

EXPERIMENTS = ("experiment1", "experiment2")

NEEDED = {"drives": ("hunger", "fatigue"), "behaviours": ("eat", "shelter")}
"""What the figures of Experiment 1 show of a mind, whatever else it has."""


class Size(NamedTuple):
    """How much is run: robots of Experiment 1, lives a cell of Experiment 2, the cap in steps."""

    robots: int = 100
    lives: int = 1_000
    steps: int = 300_000


QUICK = Size(robots=10, lives=60, steps=60_000)
"""Enough to see everything work; too little for most verdicts."""


class Reproduction(NamedTuple):
    """What came of it.

    `lives` are those of Experiment 2, those that failed left out. `summaries` and `papers` are of
    all lives and of the first 20 a cell; `tests` compares BLIND and AF in each world. `failed` is
    how many lives, robots of Experiment 1 included, failed.
    """

    settings: LifeSettings
    seed: int
    size: Size
    worlds: tuple[World, World]
    learnt: Learnt
    lives: pa.Table
    claims: list[Claim]
    summaries: list[CellSummary]
    papers: list[CellSummary]
    tests: dict[str, LogRank]
    failed: int


def check(settings: LifeSettings, seed: int, size: Size) -> None:
    """Refuse what would be left out of account, and what is too little. Raises LifeError."""
    problems = []
    if settings.world != WorldChoice():
        problems.append(
            "the settings choose a world; a reproduction is of Worlds 1 and 2, take [world] out"
        )
    if settings.mind.agent != "BLIND":
        problems.append(
            f'mind.agent = "{settings.mind.agent}"; a reproduction is of LEARNING, BLIND and AF,'
            " take agent out"
        )
    for group, names in NEEDED.items():
        missing = [name for name in names if name not in getattr(settings.mind, group)]
        if missing:
            problems.append(
                f"mind.{group} has no {' and no '.join(missing)}, of which Figures 3 and 4 tell"
            )
    if size.robots < 1:
        problems.append(f"seeds = {size.robots}; Experiment 1 needs at least 1 robot")
    if size.lives < 2:
        problems.append(f"lives = {size.lives}; a comparison needs at least 2 a cell")
    if problems:
        raise LifeError(*problems)
    check_life(seed, 0, size.steps)


def studies(settings: LifeSettings, seed: int, size: Size) -> tuple[Study, Study]:
    """Return both experiments as studies of these settings."""
    mind = settings.mind.model_dump(mode="json", exclude_unset=True)
    both = {
        "seed": seed,
        "steps": size.steps,
        "mind": mind,
        "robot": settings.robot.model_dump(mode="json", exclude_unset=True),
        "world": {"spares": SPARES} if settings.mind.consumed else {},
    }
    robots = {"lives": size.robots, "record": {"lives": size.robots}}
    teacher: dict[str, Any] = {"robots": size.robots, "steps": size.steps}
    if settings.mind.consumed:
        teacher["world"] = {"layout": "abundant", "spares": SPARES}
    first, second = (read_study(shipped(name)) for name in EXPERIMENTS)
    return (
        _changed(first, {**both, **robots, "mind": {**mind, "agent": "LEARNING"}}),
        _changed(second, {**both, "lives": size.lives, "teacher": teacher}),
    )


def reproduce(
    settings: LifeSettings,
    *,
    seed: int,
    size: Size,
    directory: Path,
    tell: Telling,
    anew: bool = False,
    check_functions: bool = False,
) -> Reproduction:
    """Run both experiments into `directory`, or resume them there, and judge the claims.

    With `anew`, experiments of other settings that were broken off there are thrown away. With
    `check_functions`, custom functions check every index they use.

    Raises:
        SettingsError: what cannot be lived, or a directory that holds experiments of other
            settings, or cannot be written.
        RunError: another process runs them there, it cannot be written any more, or all lives of
            a case failed.
        KeyboardInterrupt: the run was ended before its time.
    """
    check(settings, seed, size)
    lived: list[Results] = []
    for study in studies(settings, seed, size):
        plan = plan_of(study.to_toml(), check_functions)
        lived.append(_lived(plan, directory / study.name, lived, tell, anew))
    for results in lived:
        _check_some_lived(results)
    robots = learnt(lived[0])
    tell("Statistics", 0, 3)
    lives = _lives(lived[1])
    claims = judge(lives, robots.final)
    tell("Statistics", 1, 3)
    summaries = summarise(lives)
    tell("Statistics", 1, 3)
    papers = summarise(first_lives(lives, PAPERS_LIVES))
    tests = {
        world: logrank(*(rows for _, rows in cells(cell(lives, world=world), by=("agent",))))
        for world in dict.fromkeys(lives["world"].to_pylist())
    }
    tell("Statistics", 1, 3)
    worlds = (World.abundant(), World.scarce())
    if settings.mind.consumed:
        worlds = (worlds[0].with_spares(SPARES), worlds[1].with_spares(SPARES))
    failed = sum(results.tally().counts["lives"].failed for results in lived)
    return Reproduction(
        settings, seed, size, worlds, robots, lives, claims, summaries, papers, tests, failed
    )


def _lived(
    plan: Plan, directory: Path, lenders: list[Results], tell: Telling, anew: bool
) -> Results:
    """Return the results of an experiment, simulated as far as its directory lacks them."""
    if (directory / MANIFEST).exists() and (found := differences_from(directory, plan)):
        if not anew:
            raise SettingsError(
                *(f"{directory}: {line}" for line in found),
                f"{directory}: was broken off; --force begins anew, --out names another directory",
            )
        shutil.rmtree(directory)

    def told(task: str, done: int, total: int, note: str = "") -> None:
        which = plan.study.name.replace("experiment", "Experiment ")
        tell(f"{which}, {task[0].lower()}{task[1:]}", done, total, note)

    with threads() as workers:
        if not run(plan, directory, workers, told, lenders).complete:
            raise KeyboardInterrupt
    return Results(directory)


def _check_some_lived(results: Results) -> None:
    """Raise RunError where all lives of a case failed, so that there is nothing to judge."""
    lives = results.lives(["case", "error"])
    there = lives.filter(pc.field("error").is_null())["case"].unique()
    if len(there) < results.cases.num_rows:
        (first,) = results.failures(1)
        raise RunError(f"{results.study.name}: all lives of a case failed, such as {first}")


def _changed(study: Study, changes: dict[str, Any]) -> Study:
    """Return a study with some of its keys, those in tables as well, set to something else."""
    data = study.model_dump(mode="json", exclude_unset=True)
    for key, value in changes.items():
        inner = isinstance(value, dict) and isinstance(data.get(key), dict)
        data[key] = {**data[key], **value} if inner else value
    return validated(data, Study)


def _lives(results: Results) -> pa.Table:
    """Return the lives of Experiment 2 that did not fail, as a table of lives."""
    own = {"case", "error", *results.factors}
    lives = results.lives(where=pc.field("error").is_null())
    return lives.select([name for name in lives.column_names if name not in own])

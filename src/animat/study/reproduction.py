"""The reproduction of the paper: both experiments, and the verdict on every claim."""

from __future__ import annotations

from typing import NamedTuple

import pyarrow as pa

from animat.life.setting import LifeError
from animat.progress import Telling
from animat.report.claims import Claim, judge
from animat.report.lives import cell, cells, first_lives
from animat.report.survival import CellSummary, LogRank, logrank, summarise
from animat.study.experiment1 import Learnt, learn
from animat.study.experiment2 import compare
from animat.study.settings import StudySettings
from animat.world.world import World

PAPERS_LIVES = 20
"""Lives in each cell of the paper's Figure 5."""


class Size(NamedTuple):
    """How much is run: robots of Experiment 1, lives a cell of Experiment 2, the cap in steps."""

    robots: int = 100
    lives: int = 1_000
    steps: int = 300_000


QUICK = Size(robots=10, lives=60, steps=60_000)
"""Enough to see everything work; too little for most verdicts."""


class Reproduction(NamedTuple):
    """What came of it.

    `summaries` and `papers` are of all lives and of the first 20 a cell; `tests` compares BLIND
    and AF in each world.
    """

    settings: StudySettings
    seed: int
    size: Size
    worlds: tuple[World, World]
    learnt: Learnt
    lives: pa.Table
    claims: list[Claim]
    summaries: list[CellSummary]
    papers: list[CellSummary]
    tests: dict[str, LogRank]


def reproduce(settings: StudySettings, *, seed: int, size: Size, tell: Telling) -> Reproduction:
    """Run both experiments and judge the claims. Raises LifeError for what cannot be lived."""
    if size.lives < 2:
        raise LifeError(f"lives = {size.lives}; a comparison needs at least 2 a cell")
    worlds = (World.abundant(), World.scarce())
    if settings.mind.consumed:
        worlds = (worlds[0].with_spares(2), worlds[1].with_spares(2))
    all_steps = size.robots * size.steps
    learnt = learn(
        settings.mind,
        worlds[0],
        settings.robot,
        robots=size.robots,
        steps=size.steps,
        seed=seed,
        progress=lambda steps: tell("Experiment 1, steps", steps, all_steps),
    )
    lives = compare(
        settings.mind,
        worlds,
        settings.robot,
        learnt.networks,
        lives=size.lives,
        steps=size.steps,
        seed=seed,
        progress=lambda lives: tell("Experiment 2, lives", lives, 4 * size.lives),
    )
    tell("Statistics", 0, 3)
    claims = judge(lives, learnt.final)
    tell("Statistics", 1, 3)
    summaries = summarise(lives)
    tell("Statistics", 1, 3)
    papers = summarise(first_lives(lives, PAPERS_LIVES))
    tests = {
        world: logrank(*(rows for _, rows in cells(cell(lives, world=world), by=("agent",))))
        for world in dict.fromkeys(lives["world"].to_pylist())
    }
    tell("Statistics", 1, 3)
    return Reproduction(
        settings, seed, size, worlds, learnt, lives, claims, summaries, papers, tests
    )

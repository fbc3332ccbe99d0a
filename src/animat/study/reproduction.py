"""The reproduction of the paper: both experiments, and the verdict on every claim."""

from __future__ import annotations

from typing import NamedTuple

import pyarrow as pa

from animat.life.life import check as check_life
from animat.life.setting import LifeError
from animat.progress import Telling
from animat.report.claims import Claim, judge
from animat.report.lives import cell, cells, first_lives
from animat.report.survival import CellSummary, LogRank, logrank, summarise
from animat.study.experiment1 import Learnt, learn
from animat.study.experiment2 import compare
from animat.study.settings import LifeSettings, WorldChoice
from animat.world.world import World

PAPERS_LIVES = 20
"""Lives in each cell of the paper's Figure 5."""


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

    `summaries` and `papers` are of all lives and of the first 20 a cell; `tests` compares BLIND
    and AF in each world.
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


def reproduce(settings: LifeSettings, *, seed: int, size: Size, tell: Telling) -> Reproduction:
    """Run both experiments and judge the claims. Raises LifeError for what cannot be lived."""
    check(settings, seed, size)
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

"""How fast a step is on one core: nanoseconds by world, sensors and agent, and by size of arena.

    python bench/speed.py [--repeat 9] [--json FILE] [--markdown]

Noise is on. Lives are kept from dying so that every figure is over the same number of steps. Times
are of the processor; each is the least of the repeats, which are taken in turns.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from statistics import median
from typing import NamedTuple

import numpy as np

import animat
import figures
from animat.life.batch import advance
from animat.life.scenario import Setting, bring_together
from figures import Table, Target

AGENTS = ("BLIND", "AF", "LEARNING")
SENSORS = ("michel1996", "linear")

DENSITY = 8
"""Objects per square metre of the arenas of equal density."""

MILLIONS = {"abundant": 6.0, "scarce": 8.0, "empty": 10.0}
"""The least robot-steps per second, in millions, of BLIND with michel1996 in these worlds."""

GROWTH = 1.1
"""How much dearer a step may be in an arena of 4 m by 4 m than in one of 1 m by 1 m."""


class Size(NamedTuple):
    """How much is measured."""

    lives: int = 8
    steps: int = 20_000
    spread: int = 64
    """Lives in the arenas that are compared, from starts all over them."""
    layouts: int = 5


TINY = Size(lives=2, steps=200, spread=4, layouts=2)


def arena(metres: int, seed: int = 1) -> animat.World:
    """Return a square arena of so many metres, with DENSITY objects to a square metre."""
    size = 1000.0 * metres
    each = DENSITY * metres * metres // 4
    return animat.World.random(
        dict.fromkeys(("TS", "TL", "CS", "CL"), each),
        seed=seed,
        arena=animat.Arena(width=size, height=size),
        name=f"{metres} m x {metres} m, {4 * each} objects",
    )


def timing(setting: Setting, lives: int, steps: int) -> Callable[[], float]:
    """Return a function that lives and returns the nanoseconds of a step."""
    indices = np.arange(lives, dtype=np.uint64)

    def measure() -> float:
        states, present = setting.begin(1, indices)
        start = time.thread_time()
        advance(setting, 1, indices, states, present, steps)
        return 1e9 * (time.thread_time() - start) / (lives * steps)

    return measure


def minds() -> dict[str, animat.Mind]:
    """Return an immortal mind of every agent; AF knows what one LEARNING robot has learnt."""
    learnt = animat.live(animat.Mind(agent="LEARNING"), animat.World.abundant(), seed=1).networks
    known = {"AF": learnt}
    return {
        agent: animat.Mind(agent=agent, death=False, networks=known.get(agent)) for agent in AGENTS
    }


def by_world(size: Size, repeat: int) -> Table:
    """Measure every world, sensor model and agent."""
    worlds = [
        animat.World.abundant(),
        animat.World.scarce(),
        animat.World.random({}, name="empty"),
        *(arena(metres) for metres in (1, 2, 4)),
    ]
    agents = minds()
    measures = {
        (world.name, sensors, agent): timing(
            bring_together(mind, world, animat.Khepera(infrared=sensors)), size.lives, size.steps
        )
        for world in worlds
        for sensors in SENSORS
        for agent, mind in agents.items()
    }
    taken = figures.in_turns(measures, repeat)
    least = {key: min(times) for key, times in taken.items()}
    rows = []
    for world in worlds:
        for sensors in SENSORS:
            costs = {agent: least[world.name, sensors, agent] for agent in AGENTS}
            speed = 1e3 / costs["BLIND"]
            wanted = MILLIONS.get(world.name) if sensors == SENSORS[0] else None
            rows.append(
                {"world": world.name, "sensors": sensors}
                | {f"{agent}, ns": cost for agent, cost in costs.items()}
                | {
                    "BLIND, million steps/s": speed,
                    "target": Target(speed, wanted, at_least=True) if wanted else None,
                }
            )
    share = median(median(times) / min(times) for times in taken.values())
    return Table(
        "A robot-step on one core",
        rows,
        f"Nanoseconds of the processor, the least of {repeat} turns over {size.lives} lives of "
        f"{size.steps:,} steps; the median of the turns is {share:.2f} times as much. "
        "World 1 is abundant, World 2 scarce.",
    )


def by_arena(size: Size, repeat: int) -> Table:
    """Compare arenas of 1 m by 1 m and of 4 m by 4 m, several layouts of each."""
    mind = animat.Mind(death=False)
    measures = {
        (seed, metres): timing(bring_together(mind, arena(metres, seed)), size.spread, size.steps)
        for seed in range(1, size.layouts + 1)
        for metres in (1, 4)
    }
    least = {key: min(times) for key, times in figures.in_turns(measures, repeat).items()}
    rows = [
        row(str(seed), least[seed, 1], least[seed, 4], None) for seed in range(1, size.layouts + 1)
    ]
    small, large = (float(np.mean(list(of(metres, least)))) for metres in (1, 4))
    rows.append(row("mean", small, large, Target(large / small, GROWTH, at_least=False)))
    return Table(
        "16 times the area with 16 times the objects",
        rows,
        f"BLIND, michel1996, {DENSITY} objects to a square metre, laid out anew for every seed; "
        f"{size.spread} lives of {size.steps:,} steps, which start all over the arena.",
    )


def of(metres: int, least: dict[tuple[int, int], float]) -> Iterable[float]:
    """Return the times in arenas of so many metres."""
    return (cost for (_, size), cost in least.items() if size == metres)


def row(layout: str, small: float, large: float, target: Target | None) -> dict[str, object]:
    """Return a row of the comparison of arenas."""
    return {
        "layout": layout,
        "1 m x 1 m, ns": small,
        "4 m x 4 m, ns": large,
        "ratio": large / small,
        "target": target,
    }


def tables(repeat: int, tiny: bool) -> Iterator[Callable[[], Table]]:
    """Yield what makes each table."""
    size = TINY if tiny else Size()
    yield partial(by_world, size, repeat)
    yield partial(by_arena, size, repeat)


if __name__ == "__main__":
    figures.run(__doc__, tables, repeat=9)

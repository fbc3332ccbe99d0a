"""How fast a step is: nanoseconds per robot-step on one core, by world, agent and sensor model.

    python bench/speed.py [--repeat 5] [--json FILE]

Noise is on. Lives are kept from dying so that every figure is over the same number of steps. Times
are of the processor, not of the clock, and each is the least of the repeats: other programs on the
machine only ever add to it.
"""

from __future__ import annotations

import argparse
import json
import resource
import sys
import time
from pathlib import Path

import numpy as np

import animat
from animat.life.lives import live_on
from animat.life.setting import Setting, bring_together
from animat.study.provenance import provenance

LIVES = 8
STEPS = 20_000
DENSITY = 8
"""Objects per square metre of the arenas of equal density."""


def arena(metres: int) -> animat.World:
    """Return a square arena of so many metres, with DENSITY objects to a square metre."""
    size = 1000.0 * metres
    each = DENSITY * metres * metres // 4
    return animat.World.random(
        dict.fromkeys(("TS", "TL", "CS", "CL"), each),
        seed=1,
        arena=animat.Arena(width=size, height=size),
        name=f"{metres} m x {metres} m, {4 * each} objects",
    )


def nanoseconds(setting: Setting, repeat: int) -> float:
    """Return the least time of a step over some repeats."""
    lives = np.arange(LIVES, dtype=np.uint64)
    best = np.inf
    for _ in range(repeat):
        states, present = setting.begin(1, lives)
        start = time.thread_time()
        live_on(setting, 1, lives, states, present, STEPS)
        best = min(best, time.thread_time() - start)
    return 1e9 * best / (LIVES * STEPS)


def peak_memory() -> float:
    """Return the largest memory this process has had, in MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def main() -> None:
    """Measure, print a table, and write it as JSON where asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=9)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    made = provenance()
    start = time.perf_counter()
    animat.live(animat.Mind(), animat.World.abundant(), steps=1)
    made["first life, seconds"] = time.perf_counter() - start
    before = peak_memory()
    animat.live(animat.Mind(death=False), animat.World.abundant(), steps=5_000_000)
    made["memory that 5,000,000 steps add, MB"] = peak_memory() - before
    worlds = [
        animat.World.abundant(),
        animat.World.scarce(),
        animat.World.random({"TS": 0}, name="empty"),
        arena(1),
        arena(2),
        arena(4),
    ]
    rows = []
    for world in worlds:
        for agent in ("BLIND", "LEARNING", "ORACLE"):
            for infrared in ("michel1996", "linear"):
                mind = animat.Mind(agent=agent, death=False)
                setting = bring_together(mind, world, animat.Khepera(infrared=infrared))
                cost = nanoseconds(setting, options.repeat)
                rows.append(
                    {
                        "world": world.name,
                        "agent": agent,
                        "infrared": infrared,
                        "ns per step": round(cost, 1),
                        "million steps per second": round(1e3 / cost, 2),
                    }
                )
                print(
                    f"{world.name:28s} {agent:9s} {infrared:11s} {cost:7.1f} ns"
                    f" {1e3 / cost:6.2f} M/s",
                    flush=True,
                )
    made["steps"] = rows
    if options.json:
        options.json.write_text(json.dumps(made, indent=2) + "\n", encoding="utf-8")
    print(json.dumps({key: value for key, value in made.items() if key != "steps"}, indent=2))


if __name__ == "__main__":
    sys.exit(main())

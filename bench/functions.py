"""What functions of one's own cost: CPU time of lives with them over that with the built-in ones.

    python bench/functions.py [--repeat 21] [--json FILE]

Both live the same lives in turn, on one core, and every turn gives a ratio of CPU times. Death is
off, so that both live the same number of steps. A ratio of 1 means that one's own cost nothing.
Printed are the ratio of the least times, because other programs only ever add to a time, and the
median of the ratios with the quartiles.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import animat
from animat.life.lives import live_on
from animat.life.setting import Setting, bring_together
from animat.mind.affordance import back_propagate, feed_forward
from animat.mind.behaviours import curved_wander
from animat.mind.drives import signed
from animat.mind.homeostasis import decay
from animat.mind.selection import winner_take_all
from animat.study.provenance import provenance

EXAMPLES = Path(__file__).parents[1] / "docs" / "examples"
LIVES = 4
STEPS = 50_000


class Pair(NamedTuple):
    """Two minds in a world; `same` if their lives must be the same, bit for bit."""

    name: str
    world: animat.World
    built_in: Mapping[str, Any]
    own: Mapping[str, Any]
    same: bool


def pairs() -> list[Pair]:
    """Return what is compared."""
    abundant = animat.World.abundant()
    empty = animat.World.random({}, name="empty")
    learner = {"agent": "LEARNING", "physiology": "decay"}
    all_six = {
        "variables": {
            name: {"law": decay, "kind": "deficit"}
            for name in ("nutrition", "stamina", "restlessness")
        },
        "drive_function": signed,
        "selector": winner_take_all,
        "learning": {"estimator": feed_forward, "learner": back_propagate},
        "wander": curved_wander,
    }
    product = {"selector": f"{EXAMPLES / 'product.py'}:product"}
    deadband = {"drive_function": f"{EXAMPLES / 'deadband.py'}:deadband"}
    times = {"selector": "affordance_times_drive"}
    return [
        Pair("product.py over affordance_times_drive", abundant, times, product, True),
        # Without objects no drive has a say in what the robot does: the same steps, other drives.
        Pair("deadband.py over signed", empty, {}, deadband, False),
        Pair("deadband.py over signed", abundant, {}, deadband, False),
        Pair("all six, ours given as one's own", abundant, learner, learner | all_six, True),
    ]


def timed(setting: Setting) -> tuple[float, bytes]:
    """Return the CPU time (s) of some lives, and the states they end in."""
    lives = np.arange(LIVES, dtype=np.uint64)
    states, present = setting.begin(1, lives)
    start = time.thread_time()
    live_on(setting, 1, lives, states, present, STEPS)
    return time.thread_time() - start, states.tobytes()


def compare(pair: Pair, repeat: int) -> dict[str, Any]:
    """Return the ratios of CPU times of own over built-in, turn by turn."""
    built_in, own = (
        bring_together(animat.Mind(death=False, **given), pair.world)
        for given in (pair.built_in, pair.own)
    )
    (_, one), (_, other) = timed(built_in), timed(own)  # compiles
    if pair.same and one != other:
        raise SystemExit(f"{pair.name}: the lives differ")
    times = []
    for turn in range(repeat):
        first, second = (built_in, own) if turn % 2 == 0 else (own, built_in)
        spent = timed(first)[0], timed(second)[0]
        times.append(spent if turn % 2 == 0 else spent[::-1])
    lower, median, upper = statistics.quantiles([mine / ours for ours, mine in times], n=4)
    least = [min(column) for column in zip(*times, strict=True)]
    nanoseconds = 1e9 / (LIVES * STEPS)
    return {
        "functions": pair.name,
        "world": pair.world.name,
        "built-in, ns per step": least[0] * nanoseconds,
        "own, ns per step": least[1] * nanoseconds,
        "ratio of the least": least[1] / least[0],
        "ratio, median": median,
        "ratio, quartiles": [lower, upper],
        "same lives": one == other,
    }


def main() -> None:
    """Measure, print a table, and write it as JSON where asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=21)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    made = provenance()
    rows = []
    for pair in pairs():
        row = compare(pair, options.repeat)
        rows.append(row)
        print(
            f"{row['functions']:40s} {row['world']:9s} {row['built-in, ns per step']:6.1f} ns"
            f" {row['own, ns per step']:6.1f} ns   ratio {row['ratio of the least']:.3f},"
            f" median {row['ratio, median']:.3f}"
            f" ({row['ratio, quartiles'][0]:.3f} to {row['ratio, quartiles'][1]:.3f})",
            flush=True,
        )
    made["functions"] = rows
    if options.json:
        options.json.write_text(json.dumps(made, indent=2) + "\n", encoding="utf-8")
    print(json.dumps({key: value for key, value in made.items() if key != "functions"}, indent=2))


if __name__ == "__main__":
    main()

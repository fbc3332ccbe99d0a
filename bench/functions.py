"""What functions of one's own cost: CPU time of lives with them over that with the built-in ones.

    python bench/functions.py [--repeat 21] [--json FILE] [--markdown]

Both live the same lives in turn, on one core, and every turn gives a ratio of CPU times. Death is
off, so that both live the same number of steps. A ratio of 1 means that one's own cost nothing.
Printed are the ratio of the least times, because other programs only ever add to a time, and the
median of the ratios with the quartiles.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import animat
import figures
from animat.life.batch import advance
from animat.life.scenario import Setting, bring_together
from animat.mind.affordance import back_propagate, feed_forward
from animat.mind.behaviours import curved_wander
from animat.mind.drives import signed
from animat.mind.homeostasis import decay
from animat.mind.selection import winner_take_all
from figures import Table

EXAMPLES = Path(__file__).parents[1] / "docs" / "examples"
LIVES = 4


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


def timed(setting: Setting, steps: int) -> tuple[float, bytes]:
    """Return the CPU time (s) of some lives, and the states they end in."""
    lives = np.arange(LIVES, dtype=np.uint64)
    states, present = setting.begin(1, lives)
    start = time.thread_time()
    advance(setting, 1, lives, states, present, steps)
    spent = time.thread_time() - start
    states["readings"] = 0  # a search of one's own is also shown the noise of the dark
    return spent, states.tobytes()


def compare(pair: Pair, steps: int, repeat: int) -> dict[str, Any]:
    """Return the ratios of CPU times of own over built-in, turn by turn."""
    built_in, own = (
        bring_together(animat.Mind(death=False, **given), pair.world)
        for given in (pair.built_in, pair.own)
    )
    (_, one), (_, other) = timed(built_in, steps), timed(own, steps)  # compiles
    if pair.same and one != other:
        raise SystemExit(f"{pair.name}: the lives differ")
    taken = figures.in_turns(
        {"built-in": lambda: timed(built_in, steps)[0], "own": lambda: timed(own, steps)[0]}, repeat
    )
    ratios = [mine / ours for ours, mine in zip(taken["built-in"], taken["own"], strict=True)]
    lower, middle, upper = np.quantile(ratios, (0.25, 0.5, 0.75))
    nanoseconds = 1e9 / (LIVES * steps)
    least = {which: min(times) * nanoseconds for which, times in taken.items()}
    return {
        "functions": pair.name,
        "world": pair.world.name,
        "built-in, ns": least["built-in"],
        "own, ns": least["own"],
        "ratio of the least": least["own"] / least["built-in"],
        "ratio, median": float(middle),
        "lower quartile": float(lower),
        "upper quartile": float(upper),
        "same lives": one == other,
    }


def own_functions(steps: int, repeat: int) -> Table:
    """Compare all pairs."""
    rows = [compare(pair, steps, repeat) for pair in pairs()]
    return Table(
        "Functions of one's own",
        rows,
        f"{LIVES} lives of {steps:,} steps on one core, {repeat} turns of both.",
    )


def tables(repeat: int, tiny: bool) -> Iterator[Callable[[], Table]]:
    """Yield what makes the table."""
    yield partial(own_functions, 100 if tiny else 50_000, repeat)


if __name__ == "__main__":
    figures.run(__doc__, tables, repeat=21)

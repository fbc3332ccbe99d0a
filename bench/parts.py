"""Where the time of a step goes: its parts in nanoseconds, and what the machine could do at best.

    python bench/parts.py [--repeat 9] [--json FILE] [--markdown]

Every part is a function of the package, over states of real lives in World 1 (BLIND, michel1996).
It is measured twice. Alone, over one state after another: calls do not wait for each other, so this
is what the part costs where the processor has nothing else to do. In a step: lives are lived with
the part done once more in every step that needs it, which changes nothing in them, and the
difference is taken.

The floor of a part is what its arithmetic costs where nothing waits: the operations counted in the
source, of the kind that takes longest, at the rate at which this machine does them, which is
measured in the same run. No order of the same scalar arithmetic is faster; loads, branches and
waiting come on top.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np

import animat
import figures
import machine
from animat.life.batch import advance
from animat.life.scenario import Setting, bring_together
from animat.mind.behaviours import ACT, WANDER
from figures import Table
from step_parts import NOTHING, PARTS, Part, alone, dark_at, in_step

SEED = np.uint64(1)


class Sample(NamedTuple):
    """States of real lives, and which of them do what."""

    setting: Setting
    states: np.ndarray
    present: np.ndarray
    groups: dict[str, np.ndarray]

    def share(self, part: Part) -> float:
        """Return how often a step does a part."""
        return float(self.groups[part.when].mean())


def sample(setting: Setting, lives: int, every: int, times: int) -> Sample:
    """Live some lives and keep their states every so many steps."""
    indices = np.arange(lives, dtype=np.uint64)
    states, present = setting.begin(1, indices)
    kept = []
    for turn in range(1, times + 1):
        advance(setting, 1, indices, states, present, turn * every)
        kept.append(states.copy())
    states = np.concatenate(kept)
    wanders = states["mode"] == WANDER
    moves = states["mode"] != ACT
    robot, raster = setting.robot_parameters, setting.raster
    dark = np.array([dark_at(state["x"], state["y"], robot, raster) for state in states])
    groups = {
        "always": np.ones(len(states)),
        "draws and turns": moves * 1.0 + (wanders & ~dark),
        "wanders": wanders,
        "wanders in the dark": wanders & dark,
        "wanders in the light": wanders & ~dark,
        "moves": moves,
    }
    return Sample(setting, states, present, groups)


def time_alone(taken: Sample, part: Part, which: int, calls: int) -> Callable[[], float]:
    """Return a function that gives the nanoseconds of a call of a part, or of no part."""
    chosen = taken.states[taken.groups[part.when] > 0]
    rounds = max(1, calls // max(1, len(chosen)))
    setting = taken.setting

    def measure() -> float:
        states, scratch = chosen.copy(), taken.states[:1].copy()
        start = time.thread_time()
        alone(which, rounds, states, scratch, *read(setting), taken.present)
        return 1e9 * (time.thread_time() - start) / (rounds * max(1, len(states)))

    return measure


def time_in_step(taken: Sample, which: int, lives: int, steps: int) -> Callable[[], float]:
    """Return a function that gives the nanoseconds of a step with one part more, or none.

    Raises SystemExit if the part changed the lives.
    """

    def measure() -> float:
        states, spent = once_more(taken, which, lives, steps)
        if states.tobytes() != same.tobytes():
            raise SystemExit(f"part {which}: to do it once more changes the lives")
        return spent

    same, _ = once_more(taken, NOTHING, lives, steps)
    return measure


def once_more(taken: Sample, which: int, lives: int, steps: int) -> tuple[np.ndarray, float]:
    """Live with a part done once more; return the states and the nanoseconds of a step."""
    setting = taken.setting
    states, present = setting.begin(1, np.arange(lives, dtype=np.uint64))
    start = time.thread_time()
    in_step(which, steps, states, taken.states[:1].copy(), *read(setting), present)
    return states, 1e9 * (time.thread_time() - start) / (lives * steps)


def read(setting: Setting) -> tuple[Any, Any, Any, Any, np.uint64]:
    """Return what a step reads and does not change."""
    return (
        setting.mind_parameters,
        setting.robot_parameters,
        setting.raster,
        setting.functions,
        SEED,
    )


def of_a_step(repeat: int, tiny: bool, rates: dict[str, float]) -> Table:
    """Measure every part, alone and in a step."""
    setting = bring_together(animat.Mind(death=False), animat.World.abundant())
    taken = sample(setting, 8, 500, 4) if tiny else sample(setting, 16, 2_000, 32)
    calls, lives, steps = (1_000, 2, 100) if tiny else (200_000, 8, 20_000)
    measures: dict[tuple[str, int, str], Callable[[], float]] = {}
    for part in PARTS:
        measures["alone", part.which, part.when] = time_alone(taken, part, part.which, calls)
        measures["alone", NOTHING, part.when] = time_alone(taken, part, NOTHING, calls)
        if not part.name.startswith("-"):
            measures["step", part.which, ""] = time_in_step(taken, part.which, lives, steps)
    measures["step", NOTHING, ""] = time_in_step(taken, NOTHING, lives, steps)
    for measure in measures.values():
        measure()  # compiles
    least = {key: min(times) for key, times in figures.in_turns(measures, repeat).items()}
    whole = least["step", NOTHING, ""]
    rows = []
    total = 0.0
    floors = 0.0
    for part in PARTS:
        call = least["alone", part.which, part.when] - least["alone", NOTHING, part.when]
        more = least.get(("step", part.which, ""), whole) - whole
        floor = at_best(part, rates)
        inner = part.name.startswith("-")
        rows.append(
            {
                "part": part.name,
                "times in a step": taken.share(part),
                "alone, ns a call": call,
                "alone, ns a step": call * taken.share(part),
                "once more in a step, ns": None if inner else more,
                "floor, ns a call": floor or None,
                "alone / floor": call / floor if floor else None,
            }
        )
        if part.whole:
            total += call * taken.share(part)
        if part.whole or inner:
            floors += floor * taken.share(part)
    rows.append(closing("the rest: modes, events, memory, loop", whole - total))
    rows.append(closing("a step", whole))
    return Table(
        "Where the time of a step goes",
        rows,
        "World 1, BLIND, michel1996; nanoseconds of the processor, the least of "
        f"{repeat} turns. Rows with a dash are contained in the row above them, sine and cosine in "
        "motion and in sensing in the light. The floors of the rows that make up a step come to "
        f"{figures.cell(floors)} ns. What is done once more overlaps with the step, and is the "
        "difference of two times that are large beside it: a few ns of it are noise.",
    )


def at_best(part: Part, rates: dict[str, float]) -> float:
    """Return the nanoseconds below which the arithmetic of a part cannot come, 0 if not counted."""
    return max(
        part.products * rates[machine.PRODUCT],
        part.additions_and_products * rates[machine.FLOAT],
        part.quotients * rates[machine.QUOTIENT],
    )


def closing(name: str, cost: float) -> dict[str, object]:
    """Return a row that holds a cost per step only."""
    return {
        "part": name,
        "times in a step": 1.0,
        "alone, ns a call": None,
        "alone, ns a step": cost,
        "once more in a step, ns": None,
        "floor, ns a call": None,
        "alone / floor": None,
    }


def tables(repeat: int, tiny: bool) -> Iterator[Callable[[], Table]]:
    """Yield what makes each table."""
    rates = machine.rates(repeat, 1_000 if tiny else 1_000_000)
    yield partial(machine.table, rates)
    yield partial(of_a_step, repeat, tiny, rates)


if __name__ == "__main__":
    figures.run(__doc__, tables, repeat=9)

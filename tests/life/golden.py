"""Lives whose every bit is known: the hashes that hold on any machine.

    python tests/life/golden.py                lives them again and writes golden.json anew
    python tests/life/golden.py --print        prints the hashes as JSON and writes nothing
    python tests/life/golden.py --print-short  prints those that can be had uncompiled
    python tests/life/golden.py --print-few    prints some of those, of every kind of mind

A changed hash breaks the promise that a life is a pure function of seed, index and settings. So
it is only written under a new number of the engine, of which CHANGELOG.md says why.
"""

from __future__ import annotations

import hashlib
import json
import re
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import chain, product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from animat.life.batch import advance
from animat.life.digest import digest
from animat.life.engine import ENGINE
from animat.life.scenario import bring_together
from animat.mind.agents import AGENTS
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.mind.physiology import PHYSIOLOGIES
from animat.robot.khepera import Khepera, Sensor
from animat.robot.parameters import MODELS
from animat.world.arena import Arena
from animat.world.layout import Layout, Placement
from animat.world.world import World

FILE = Path(__file__).with_name("golden.json")
CHANGELOG = Path(__file__).parents[2] / "CHANGELOG.md"

SHORT, LONG = 300, 10_000
"""Steps after which lives are hashed: some after the few, which can be lived uncompiled, and all
after the many."""

SEED = 2**63 + 3
MANY = 1_000

READINGS: dict[str, dict[str, Any]] = {
    "absolute error": {"agent": "ORACLE", "error": "absolute"},
    "rectified error": {"agent": "ORACLE", "error": "rectified"},
    "overflow lethal": {"agent": "ORACLE", "overflow": "lethal"},
    "failed act clamp": {"agent": "BLIND", "failed_act": "clamp"},
    "affordance times drive": {"selector": "affordance_times_drive"},
    "noisy features": {"feature_noise": 0.3},
    "consumed": {"consumed": True},
    "gives up": {"approach_steps": 2},
    "no biases": {"learning": {"biases": False}},
}
"""Readings that are lived besides, by a LEARNING robot if they name no other."""

SMALL = World(
    layout=Layout(
        placements=(
            Placement(type="TS", x=110.0, y=100.0, angle=0.3),
            Placement(type="TL", x=300.0, y=110.0, angle=1.1),
            Placement(type="CS", x=120.0, y=300.0, angle=-0.4),
            Placement(type="CL", x=290.0, y=290.0, angle=0.2),
        ),
        spares=(
            Placement(type="TS", x=205.0, y=200.0),
            Placement(type="CS", x=205.0, y=78.0, angle=0.7),
        ),
        arena=Arena(width=420.0, height=420.0),
        minimum_gap=20.0,
    ),
    name="small",
    resolution=4.0,
)

# Hidden units that tell large from small; eating likes small ones, sheltering large ones.
KNOWING = Networks(
    ("eat", "shelter", "interact"),
    ("shape", "size"),
    2,
    np.array(
        [
            [-4.0, 0.5, 8.0, 4.0, 0.25, -8.0, 0.0, -3.0, 3.0],
            [-4.0, 0.5, 8.0, 4.0, 0.25, -8.0, 0.0, 3.0, -3.0],
            [-4.0, 0.5, 8.0, 4.0, 0.25, -8.0, 2.0, 1.0, 1.0],
        ]
    ),
)

USUAL: dict[str, Any] = {"interaction_steps": 8, "gate": "always"}


@cache
def worlds() -> dict[str, World]:
    """Return the worlds of the golden lives by name."""
    counts = {"TS": 2, "TL": 1, "CS": 2, "CL": 1}
    random = World.random(counts, seed=5, arena=Arena(width=700.0, height=600.0))
    return {
        "small": SMALL,
        "abundant": World.abundant(),
        "scarce": World.scarce(),
        "random": random,
    }


class Case(NamedTuple):
    """A golden life; `short` if it is hashed after the few steps too."""

    name: str
    short: bool
    world: World
    mind: Mind
    robot: Khepera


def cases() -> Iterator[Case]:
    """Yield every golden life."""
    for world, agent, physiology, model in product(worlds(), AGENTS, PHYSIOLOGIES, MODELS):
        networks = KNOWING if agent == "AF" else None
        mind = Mind(agent=agent, physiology=physiology, networks=networks, **USUAL)
        name = f"{world}, {agent}, {physiology}, {model}"
        short = world == "small" or (physiology, model) == ("excess", "michel1996")
        yield Case(name, short, worlds()[world], mind, Khepera(infrared=model))
    for name, reading in READINGS.items():
        mind = Mind(**{"agent": "LEARNING", **USUAL, **reading})
        yield Case(name, True, SMALL, mind, Khepera())
    ahead = Khepera(sensors=(Sensor(x=24.5, y=0.0, direction=0.0),) * 8)
    yield Case("grazing the walls", True, SMALL, Mind(**USUAL, death=False), ahead)
    still = Khepera(motor_noise=False, infrared_noise=False)
    yield Case("no noise", True, SMALL, Mind(**USUAL), still)


def lived(case: Case, steps: int) -> tuple[np.record, NDArray[np.uint8]]:
    """Return the state and the present objects of a golden life after so many steps."""
    setting = bring_together(case.mind, case.world, case.robot)
    lives = np.array([5], np.uint64)
    states, present = setting.begin(SEED, lives)
    advance(setting, SEED, lives, states, present, steps)
    return states[0], present[0]


def few() -> list[Case]:
    """Return a third of the lives in the small world, which has every agent, physiology and sensor
    model, and all of the readings.
    """
    small = [case for case in cases() if case.world is SMALL]
    crossed = len(AGENTS) * len(PHYSIOLOGIES) * len(MODELS)
    return small[:crossed:3] + small[crossed:]


def hashes(steps: int, which: Iterable[Case] | None = None) -> dict[str, str]:
    """Return the digests of the golden lives, or of some, after so many steps."""
    if which is None:
        which = (case for case in cases() if case.short or steps > SHORT)
    return {case.name: digest(*lived(case, steps)) for case in which}


def rasters(which: Iterable[str] | None = None) -> dict[str, str]:
    """Return a hash of the raster of every world, or of some, as the golden lives read it."""
    found = {}
    for name in which or worlds():
        world = worlds()[name]
        total = hashlib.blake2b(digest_size=16)
        for field, value in bring_together(Mind(), world).raster._asdict().items():
            values = np.ascontiguousarray(value)
            values = values.astype(values.dtype.newbyteorder("<"))
            total.update(f"{field} {values.dtype.str} {values.shape}\n".encode())
            total.update(values.tobytes())
        found[name] = total.hexdigest()
    return found


def many(batch: int = MANY, threads: int = 1, shuffled: bool = False) -> str:
    """Return one hash of a thousand lives, however they are lived: in which batches, on how many
    threads, in which order.
    """
    setting = bring_together(Mind(agent="LEARNING", **USUAL, consumed=True), SMALL)
    order = np.arange(MANY, dtype=np.uint64)
    if shuffled:
        np.random.default_rng(batch).shuffle(order)

    def part(start: int) -> list[tuple[int, str]]:
        lives = order[start : start + batch].copy()
        states, present = setting.begin(SEED, lives)
        advance(setting, SEED, lives, states, present, SHORT)
        return [
            (int(life), digest(state, there))
            for life, state, there in zip(lives, states, present, strict=True)
        ]

    with ThreadPoolExecutor(threads) as pool:
        ends = sorted(chain.from_iterable(pool.map(part, range(0, MANY, batch))))
    return hashlib.blake2b(json.dumps(ends).encode(), digest_size=16).hexdigest()


def told(how_much: str = "all") -> dict[str, Any]:
    """Return what is known of the golden lives, as it stands in the file: "all" of it, what can be
    had uncompiled ("short"), or a little of that ("few"), with many lives beside it ("some").
    """
    if how_much == "few":
        return {"engine": ENGINE, "rasters": rasters(["small"]), "short": hashes(SHORT, few())}
    if how_much == "some":
        return {**told("few"), "many": many()}
    soon = {"engine": ENGINE, "rasters": rasters(), "short": hashes(SHORT)}
    return soon if how_much == "short" else {**soon, "long": hashes(LONG), "many": many()}


def changed(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return the names of the lives that are not what they were; new names are no change.

    Nor are rasters: a world may be drawn otherwise without any life being another.
    """
    found = ["many"] if before["many"] != now["many"] else []
    for part in ("short", "long"):
        for name, known in before[part].items():
            if now[part].get(name) != known:
                found.append(f"{part}: {name}")
    return found


def objection(before: dict[str, Any], now: dict[str, Any], changelog: str) -> str | None:
    """Return why the file must not be written over with what is told now, or None."""
    found = changed(before, now)
    if now["engine"] < before["engine"]:
        return f"golden.json is of engine {before['engine']}, this is engine {now['engine']}"
    if found and now["engine"] == before["engine"]:
        more = f" and {len(found) - 3} more" if len(found) > 3 else ""
        return (
            f"{len(found)} golden lives are not those of engine {ENGINE} any more"
            f" ({'; '.join(found[:3])}{more}).\nIf that is meant: raise ENGINE in"
            " src/animat/life/engine.py, say why in CHANGELOG.md, and run this again."
        )
    missing = unexplained(changelog, now["engine"])
    if missing:
        return f'CHANGELOG.md says nothing of engine {missing[0]}: give it a line "Engine N: ..."'
    return None


def unexplained(changelog: str, engine: int) -> list[int]:
    """Return the numbers of the engine after the first of which the changelog says nothing."""
    said = {int(number) for number in re.findall(r"\bengine (\d+)\b", changelog, re.IGNORECASE)}
    return [number for number in range(2, engine + 1) if number not in said]


def main(arguments: list[str]) -> int:
    """Print the hashes, or write the file anew; return the exit code."""
    if arguments:
        how_much = arguments[0].removeprefix("--print").removeprefix("-") or "all"
        sys.stdout.write(json.dumps(told(how_much)))
        return 0
    now = told()
    if FILE.exists():
        before = json.loads(FILE.read_text(encoding="utf-8"))
        if before == now:
            sys.stdout.write(f"golden.json is as it was, of engine {ENGINE}\n")
            return 0
        reason = objection(before, now, CHANGELOG.read_text(encoding="utf-8"))
        if reason:
            sys.stderr.write(reason + "\n")
            return 1
    FILE.write_text(json.dumps(now, indent=1) + "\n", encoding="utf-8")
    sys.stdout.write(f"wrote golden.json, of engine {ENGINE}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""Lives whose every bit is known: the hashes that hold on any machine.

    python tests/life/golden.py            lives them again and writes golden.json anew
    python tests/life/golden.py --print N  prints the hashes after N steps as JSON

A changed hash breaks the promise that a life is a pure function of seed, index and settings: the
CHANGELOG says why.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from animat.life.life import live
from animat.life.state import state_dtype
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.robot.khepera import SENSORS, Khepera, Sensor
from animat.world.arena import Arena
from animat.world.layout import Layout, Placement
from animat.world.world import World

FILE = Path(__file__).with_name("golden.json")

SHORT, LONG = 300, 10_000
"""Steps after which the lives are hashed; the short ones are lived uncompiled too."""

AGENTS = ("BLIND", "AF", "LEARNING", "ORACLE", "RANDOM")
PHYSIOLOGIES = ("excess", "decay", "relax", "linear")
MODELS = ("michel1996", "linear")

READINGS: dict[str, dict[str, Any]] = {
    "absolute error": {"error": "absolute"},
    "rectified error": {"error": "rectified"},
    "overflow lethal": {"overflow": "lethal"},
    "failed act clamp": {"failed_act": "clamp"},
    "affordance times drive": {"selector": "affordance_times_drive"},
    "noisy features": {"feature_noise": 0.3},
    "consumed": {"consumed": True},
    "no biases": {"learning": {"biases": False}},
}
"""Readings that are lived by a LEARNING robot besides."""

WORLD = World(
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
    name="golden",
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


def cases() -> Iterator[tuple[str, Mind, Khepera]]:
    """Yield the name, mind and robot of every golden life."""
    usual: dict[str, Any] = {"interaction_steps": 8, "gate": "always"}
    for agent, physiology, model in product(AGENTS, PHYSIOLOGIES, MODELS):
        networks = KNOWING if agent == "AF" else None
        mind = Mind(agent=agent, physiology=physiology, networks=networks, **usual)
        yield f"{agent}, {physiology}, {model}", mind, Khepera(infrared=model)
    for name, reading in READINGS.items():
        yield name, Mind(agent="LEARNING", **usual, **reading), Khepera()
    ahead = Khepera(sensors=(Sensor(x=24.5, y=0.0, direction=0.0),) * SENSORS)
    yield "grazing the walls", Mind(**usual, death=False), ahead
    yield "no noise", Mind(**usual), Khepera(motor_noise=False, infrared_noise=False)


def hashes(steps: int) -> dict[str, str]:
    """Return the hash of every golden life after so many steps."""
    return {
        name: digest(live(mind, WORLD, robot=robot, seed=2**63 + 3, life=5, steps=steps).state)
        for name, mind, robot in cases()
    }


def digest(state: np.record) -> str:
    """Return a hash of everything a state holds."""
    assert set(state.dtype.names or ()) == set(state_dtype(1, 1, 1, 1, 1, 1).names or ())
    total = hashlib.sha256()
    for name in sorted(state.dtype.names or ()):
        total.update(name.encode() + np.ascontiguousarray(state[name]).tobytes())
    return total.hexdigest()[:32]


def main(arguments: list[str]) -> None:
    """Print hashes, or write the file anew."""
    if arguments[:1] == ["--print"]:
        sys.stdout.write(json.dumps(hashes(int(arguments[1]))))
        return
    told = {str(steps): hashes(steps) for steps in (SHORT, LONG)}
    FILE.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])

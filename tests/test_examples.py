"""The functions of docs/examples, lived with."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from animat.life.batch import advance
from animat.life.life import live
from animat.life.lives import live_many
from animat.life.scenario import bring_together
from animat.life.state import ENCOUNTERED
from animat.mind.loading import load
from animat.mind.mind import Mind
from animat.world.world import World

EXAMPLES = Path(__file__).parents[1] / "docs" / "examples"
BAND = 0.1
"""As in deadband.py."""

WATCHED = {
    "hunger": ("nutrition", 0.9, 1),
    "fatigue": ("stamina", 0.2, -1),
    "curiosity": ("restlessness", 0.1, -1),
}
"""The variable that each drive watches, its set point, and its sense."""

CONTENT = {
    "nutrition": {"start": 0.85},
    "stamina": {"start": 0.25},
    "restlessness": {"start": 0.15},
}
"""Variables that are all near their set points at birth."""

QUIET = math.floor(math.log(0.2 / 0.15) / 1e-3)
"""Steps until restlessness, which grows by 1e-3 a step, is farther than BAND from its set point."""


@pytest.mark.parametrize("agent", ["ORACLE", "LEARNING"])
def test_a_product_of_ones_own_lives_the_lives_of_the_built_in_one(agent):
    world = World.abundant()
    own, built_in, other = (
        live_many(Mind(agent=agent, selector=selector), world, lives=6, seed=3, steps=20_000).table
        for selector in (
            f"{EXAMPLES / 'product.py'}:product",
            "affordance_times_drive",
            "winner_take_all",
        )
    )
    assert own.equals(built_in)
    assert not own.equals(other)
    assert sum(own["acts"].to_pylist()) > 0


def lived(**settings):
    """A life of which every step is recorded, and the errors of its variables by drive."""
    mind = Mind(agent="ORACLE", variables=CONTENT, **settings)
    trace = live(mind, World.abundant(), seed=1, steps=20_000, record="all").trace
    assert trace is not None
    seen = {name: np.array(trace[name].to_pylist()) for name in trace.column_names}
    errors = {
        drive: sense * (set_point - seen[variable])
        for drive, (variable, set_point, sense) in WATCHED.items()
    }
    return seen, errors


def test_a_deadband_asks_for_nothing_near_the_set_point():
    seen, errors = lived(drive_function=f"{EXAMPLES / 'deadband.py'}:deadband")
    for drive, error in errors.items():
        assert (seen[drive][np.abs(error) < BAND] == 0.0).all()
        beyond = np.sign(error) * np.maximum(np.abs(error) - BAND, 0.0)
        np.testing.assert_allclose(seen[drive], beyond, rtol=0, atol=1e-15)
        assert (seen[drive][:QUIET] == 0.0).all()
    assert seen["curiosity"][QUIET + 1] > 0.0
    met = np.char.find(seen["event"].astype(str), "encounter") >= 0
    assert not met[:QUIET].any()
    assert met.any()


def test_without_a_deadband_the_robot_wants_what_it_nearly_has():
    seen, errors = lived()
    for drive, error in errors.items():
        np.testing.assert_allclose(seen[drive], error, rtol=0, atol=1e-15)
        assert (seen[drive][:QUIET] > 0.0).any()


def test_a_selector_with_a_memory_persists():
    """What is chosen is what its Python would choose, with what it remembers of the life."""
    address = EXAMPLES / "persistent.py"
    plain = load(address).persistent
    setting = bring_together(Mind(selector=f"{address}:persistent", death=False), World.abundant())
    lives = np.arange(4, dtype=np.uint64)
    states, present = setting.begin(2, lives)
    memories = np.zeros((len(lives), 4))
    served = []
    for step in range(6_000):
        advance(setting, 2, lives, states, present, step + 1)
        for n in np.flatnonzero(states["event"] & ENCOUNTERED):
            chosen = plain(states["drives"][n], None, np.arange(3), 0.0, memories[n])
            assert states["behaviour"][n] == chosen
            assert (states["choice_memory"][n] == memories[n]).all()
            served.append(memories[n][1])
    assert served.count(2.0) > 3
    assert max(served) == 3.0

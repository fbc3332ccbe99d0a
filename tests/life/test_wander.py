"""Wandering covers the arena and does not stick, in both worlds."""

import numpy as np
import pytest
from scipy import ndimage

from animat.life.batch import advance
from animat.life.life import live
from animat.life.scenario import bring_together
from animat.mind.behaviours import ACT
from animat.mind.mind import Mind
from animat.robot.khepera import Khepera
from animat.world.world import World

WORLDS = {"abundant": World.abundant, "scarce": World.scarce}

SQUARE = 50  # mm

CONTENT = {
    "nutrition": {"start": 0.95, "rate": 1e-12},
    "stamina": {"start": 0.1, "rate": 1e-12},
    "restlessness": {"start": 0.05, "rate": 1e-12},
}
"""Nothing to put right for 300,000 steps and more: such a robot only wanders."""

MINDS = {
    "content": Mind(death=False, variables=CONTENT),
    "busy": Mind(death=False),
    "choosy": Mind(agent="ORACLE", death=False),
}


def reachable_squares(raster, x, y):
    """The squares in which the centre can be, on its way from (x, y), 30 mm from everything."""
    parts, _ = ndimage.label(raster.clearance >= 30.0)
    start = parts[int(y / 2 + raster.border), int(x / 2 + raster.border)]
    assert start > 0
    rows, places = np.nonzero(parts == start)
    x, y = ((n - raster.border + 0.5) * 2 for n in (places, rows))
    return squares(x, y)


def squares(x, y):
    return set(zip((x // SQUARE).astype(int), (y // SQUARE).astype(int), strict=True))


@pytest.mark.parametrize("mind", MINDS)
@pytest.mark.parametrize("world", WORLDS)
def test_a_life_of_300_000_steps_covers_the_arena(world, mind, columns):
    life = live(MINDS[mind], WORLDS[world](), seed=3, steps=300_000, record="every:8")
    c = columns(life)
    reachable = reachable_squares(life.setting.raster, c["x"][0], c["y"][0])
    visited = squares(c["x"], c["y"])
    assert len(reachable) > 300
    assert len(visited & reachable) >= 0.9 * len(reachable)
    assert life.state.blocked < 0.02 * 300_000


LOOK = 20
STAY = 200 - LOOK
"""Lives are looked at every LOOK steps; a stay of 200 steps is seen as one of STAY at least."""


def stayed(setting, lives, steps, seed):
    """Tell which lives stayed within 5 mm for 200 steps without an act, and their states."""
    indices = np.arange(lives, dtype=np.uint64)
    states, present = setting.begin(seed, indices)
    looks = STAY // LOOK + 1
    x, y, acts = (np.full((looks, lives), np.nan) for _ in range(3))
    held = np.zeros(lives, bool)
    for look, until in enumerate(range(LOOK, steps + 1, LOOK)):
        advance(setting, seed, indices, states, present, until)
        now, first = look % looks, (look + 1) % looks
        x[now], y[now] = states["x"], states["y"]
        acts[now] = states["acts"]
        acts[now, states["mode"] == ACT] = np.nan
        still = (np.hypot(x - x[first], y - y[first]) <= 5.0) & (acts == acts[first])
        held |= still.all(axis=0)
    return held, states


@pytest.mark.parametrize("mind", MINDS)
@pytest.mark.parametrize("world", WORLDS)
def test_no_life_of_a_thousand_stays_in_one_place(world, mind):
    setting = bring_together(MINDS[mind], WORLDS[world]())
    held, states = stayed(setting, 1_000, 5_000, seed=5)
    assert not held.any()
    assert states["blocked"].sum() < 0.02 * states["step"].sum()


def test_a_robot_between_rays_and_ring_gets_free_again():
    """Of `linear` sensors a corner may slip between the rays; it must not hold the robot for good.

    Before turning in vain was broken off, 85 of 1,000 such lives were held to their end.
    """
    setting = bring_together(MINDS["content"], World.abundant(), Khepera(infrared="linear"))
    held, states = stayed(setting, 500, 10_000, seed=5)
    blocked = states["blocked"].copy()
    advance(
        setting, 5, np.arange(500, dtype=np.uint64), states, np.ones((500, 99), np.uint8), 12_000
    )
    assert held.mean() < 0.05
    assert (states["blocked"] - blocked).max() < 2_000

"""Every setting of the robot does what it says."""

import math

import numpy as np
import pytest

from animat.robot.khepera import Khepera, Sensor
from animat.world.arena import Arena
from animat.world.world import World

CALM = {"motor_noise": False, "infrared_noise": False}


@pytest.mark.parametrize("radius", [27.5, 20.0])
def test_khepera_radius(radius, lived):
    c = lived(robot=Khepera(radius=radius, wheel_base=40.0), steps=6_000)
    met = np.flatnonzero(c.happened("encounter"))
    met = met[met > 0]
    assert radius + 30.0 - 4.0 < c.distances()[met].max() <= radius + 30.0


@pytest.mark.parametrize("base", [50.0, 53.0])
def test_khepera_wheel_base(base, lived):
    c = lived(robot=Khepera(wheel_base=base, **CALM))
    commanded = 0.5 * (c["right"] - c["left"])[:-1] / base
    assert np.abs(c.turned() - commanded)[c.free()].max() < 1e-12
    assert np.abs(commanded).max() > 0.0


@pytest.mark.parametrize("length", [0.5, 0.8])
def test_khepera_step_mm(length, lived):
    c = lived(robot=Khepera(step_mm=length, **CALM))
    ahead = (c["left"] + c["right"] == 10)[:-1] & c.free()
    assert np.abs(c.gone()[ahead] - 5.0 * length).max() < 1e-12


@pytest.mark.parametrize("most", [10, 3])
def test_khepera_max_motor(most, lived):
    c = lived(robot=Khepera(max_motor=most, **CALM))
    driven = min(5, most)
    assert max(np.abs(c["left"]).max(), np.abs(c["right"]).max()) <= most
    straight = (c["left"] == driven) & (c["right"] == driven)
    way = c.gone()[straight[:-1] & c.free()]
    assert np.abs(way - 0.5 * driven).max() < 1e-12


def test_khepera_motor_noise(lived, usual):
    c = lived(robot=Khepera(motor_noise=False))
    for told, spread in ((c, 0.0), (usual, 0.1)):
        straight = (told["left"] == 5) & (told["right"] == 5)
        way = told.gone()[straight[:-1] & told.free()]
        assert 0.8 * spread <= np.abs(way / 2.5 - 1.0).max() <= spread + 1e-12


@pytest.mark.parametrize("spread", [0.10, 0.30])
def test_khepera_position_noise(spread, lived):
    c = lived(robot=Khepera(position_noise=spread))
    straight = (c["left"] == 5) & (c["right"] == 5)
    way = c.gone()[straight[:-1] & c.free()] / 2.5
    assert 0.8 * spread < np.abs(way - 1.0).max() <= spread + 1e-12


@pytest.mark.parametrize("spread", [0.05, 0.20])
def test_khepera_turn_noise(spread, lived):
    c = lived(robot=Khepera(turn_noise=spread))
    turning = (np.abs(c["left"] - c["right"]) == 10)[:-1] & c.free()
    share = np.abs(c.turned())[turning] / 0.1
    assert 0.9 * spread < np.abs(share - 1.0).max() <= spread + 1e-12


@pytest.mark.parametrize("ring", [30.0, 40.0])
def test_khepera_ring_radius(ring, lived):
    """A robot that does not see keeps its ring free of walls, and comes close to them."""
    blind = tuple(Sensor(x=0.0, y=0.0, direction=180.0) for _ in range(8))
    empty = World.random({}, arena=Arena(width=560.0, height=560.0))
    c = lived(world=empty, robot=Khepera(ring_radius=ring, sensors=blind))
    walls = np.minimum.reduce([c["x"] - 22, 538 - c["x"], c["y"] - 26, 536 - c["y"]])
    assert c.happened("blocked").any()
    reach = ring * math.cos(math.pi / 8)  # the ring is eight points
    assert reach - 2.0 <= walls.min() < ring + 3.0


def test_khepera_infrared(lived, usual):
    """Rays read 1023 (1 - d / 50 mm): every value occurs; the sums of probes are few."""
    values = {}
    for model in ("michel1996", "linear"):
        c = lived(robot=Khepera(infrared=model, infrared_noise=False))
        values[model] = set(np.concatenate([c[f"infrared_{n}"] for n in range(8)]).tolist())
    assert {0, 40, 160} <= values["michel1996"]
    assert len(values["linear"]) > 2 * len(values["michel1996"])
    assert not lived(robot=Khepera(infrared="linear")).life.trace.equals(usual.life.trace)


def test_khepera_infrared_noise(lived, usual):
    c = lived(robot=Khepera(infrared_noise=False))
    dark = [told[f"infrared_{n}"] for told in (c,) for n in range(8)]
    assert (np.concatenate(dark) == 0).mean() > 0
    assert not set(np.concatenate(dark).tolist()) & set(range(1, 7))
    assert set(range(7)) <= set(usual["infrared_0"].tolist())


def test_khepera_sensors(lived, usual):
    front = tuple(Sensor(x=24.5, y=0.0, direction=0.0) for _ in range(8))
    c = lived(robot=Khepera(sensors=front, infrared_noise=False))
    for n in range(1, 8):
        assert np.array_equal(c[f"infrared_{n}"], c["infrared_0"])
    assert c["infrared_0"].max() > 0
    assert not np.array_equal(usual["infrared_0"], usual["infrared_5"])

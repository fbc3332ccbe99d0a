"""Bodies with other sensors than the Khepera's: any number of them, wherever they look."""

from __future__ import annotations

import numpy as np
import pytest

from animat.errors import SettingsError
from animat.life.control import command
from animat.life.life import live
from animat.life.scenario import bring_together
from animat.mind.mind import Mind
from animat.robot.khepera import Khepera, Sensor
from animat.robot.parameters import MOST_SENSORS
from animat.world.world import World

EIGHT = Khepera().sensors
LIVES = np.arange(6, dtype=np.uint64)


@pytest.fixture(scope="module")
def world() -> World:
    return World.random({"TS": 2, "TL": 2, "CS": 2, "CL": 2}, seed=11)


def readings(world: World, sensors: tuple[Sensor, ...], **settings) -> np.ndarray:
    """Return what the sensors read [steps, L, N] of robots that all drive alike."""
    robot = Khepera(sensors=sensors, **settings)
    setting = bring_together(Mind(death=False), world, robot)
    states, present = setting.begin(1, LIVES)
    none = np.full(len(LIVES), -1)
    found = []
    for step in range(600):
        motors = np.full((len(LIVES), 2), 5)
        motors[:, 0] -= 3 * (step % 50 > 40)
        command(setting, 1, LIVES, states, present, motors, none)
        found.append(states["readings"].copy())
    return np.array(found)


@pytest.mark.parametrize("infrared", ["michel1996", "linear"])
def test_what_a_sensor_reads_does_not_depend_on_what_comes_after_it(infrared, world):
    eight = readings(world, EIGHT, infrared=infrared)
    assert (eight > 100).any()
    twice = readings(world, EIGHT + EIGHT, infrared=infrared)
    assert (twice[:, :, :8] == eight).all()
    # The same places with noise of their own: as far apart as noise puts them.
    assert (twice[:, :, 8:] != eight).any()
    assert np.abs(twice[:, :, 8:] - eight).max() < 0.25 * 1023
    assert (readings(world, EIGHT[:3], infrared=infrared) == eight[:, :, :3]).all()


def test_without_noise_equal_places_read_alike_whatever_their_number(world):
    order = [4, 0, 2, 2, 7, 1, 3, 5, 6, 4, 0]
    quiet = {"infrared_noise": False, "motor_noise": False}
    eight = readings(world, EIGHT, **quiet)
    eleven = readings(world, tuple(EIGHT[n] for n in order), **quiet)
    assert (eleven == eight[:, :, order]).all()


@pytest.mark.parametrize("number", [1, 9, MOST_SENSORS])
def test_a_life_with_any_number_of_sensors_has_a_column_for_each(number, world):
    sensors = (EIGHT * MOST_SENSORS)[:number]
    life = live(Mind(), world, robot=Khepera(sensors=sensors), steps=300, record="all")
    names = [name for name in life.trace.column_names if name.startswith("infrared_")]
    assert names == [f"infrared_{n}" for n in range(number)]


@pytest.mark.parametrize("number", [0, MOST_SENSORS + 1])
def test_none_or_too_many_are_refused(number):
    with pytest.raises(SettingsError, match="sensors"):
        Khepera(sensors=(EIGHT * MOST_SENSORS)[:number])

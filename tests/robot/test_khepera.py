import math

import numpy as np
import pytest

from animat.files.settings import SettingsError
from animat.robot.khepera import Khepera
from animat.robot.parameters import LINEAR, MICHEL1996, ROBOT


def test_record_holds_settings():
    robot = Khepera().parameters()
    assert robot.dtype == ROBOT.dtype({"N": 8})
    assert (robot.radius, robot.wheel_base, robot.step_mm) == (27.5, 50.0, 0.5)
    assert (robot.max_motor, robot.position_noise, robot.turn_noise) == (10, 0.10, 0.05)
    assert robot.motor_noise
    assert robot.infrared_noise
    assert robot.infrared == MICHEL1996
    other = Khepera(infrared="linear", motor_noise=False, infrared_noise=False).parameters()
    assert other.infrared == LINEAR
    assert not other.motor_noise
    assert not other.infrared_noise


def test_sensors_stand_and_look_as_in_michels_table():
    robot = Khepera().parameters()
    table = np.array(
        [
            [9.5, 23, 90],
            [18, 17.5, 45],
            [24.5, 5.5, 0],
            [24.5, -5.5, 0],
            [18, -17.5, -45],
            [9.5, -23, -90],
            [-23, -9.5, 180],
            [-23, 9.5, 180],
        ]
    )
    np.testing.assert_array_equal(robot.sensor_x, table[:, 0])
    np.testing.assert_array_equal(robot.sensor_y, table[:, 1])
    direction = np.radians(table[:, 2])
    np.testing.assert_allclose(robot.sensor_cosine, np.cos(direction), atol=2e-16)
    np.testing.assert_allclose(robot.sensor_sine, np.sin(direction), atol=2e-16)
    assert robot.sensor_radius == pytest.approx(np.hypot(table[:, 0], table[:, 1]).max())


def test_directions_are_exact_at_right_angles():
    robot = Khepera().parameters()
    assert set(robot.sensor_cosine[[0, 2, 3, 5, 6, 7]]) == {0.0, 1.0, -1.0}
    assert robot.ring_x[[0, 2, 4, 6]].tolist() == [30.0, 0.0, -30.0, 0.0]
    assert robot.ring_y[[0, 2, 4, 6]].tolist() == [0.0, 30.0, 0.0, -30.0]


def test_ring_is_counter_clockwise_from_the_front():
    robot = Khepera(ring_radius=32).parameters()
    angles = np.arctan2(robot.ring_y, robot.ring_x) % math.tau
    np.testing.assert_allclose(angles, np.arange(8) * math.pi / 4, atol=1e-15)
    np.testing.assert_allclose(np.hypot(robot.ring_x, robot.ring_y), 32)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"radius": 0}, "greater than 0"),
        ({"radius": math.nan}, "finite number"),
        ({"radius": "27"}, "must be a number"),
        ({"ring_radius": 20.0}, "inside the body"),
        ({"ring_radius": 41.0}, "less than or equal to 40"),
        ({"wheel_base": 60.0}, "wider than the body"),
        ({"wheel_base": -1.0}, "greater than 0"),
        ({"max_motor": 0}, "greater than or equal to 1"),
        ({"max_motor": 2.5}, "whole number"),
        ({"step_mm": 2.0}, "pass through an object"),
        ({"position_noise": 1.0}, "less than 1"),
        ({"turn_noise": -0.1}, "greater than or equal to 0"),
        ({"motor_noise": "yes"}, "true or false"),
        ({"infrared": "webots"}, 'one of "michel1996", "linear"'),
        ({"infra_red": "linear"}, 'did you mean "infrared"'),
        ({"sensors": []}, "at least 1 item"),
        ({"sensors": [{"x": 31.0, "y": 0.0, "direction": 0.0}] * 8}, "outside the collision ring"),
        ({"sensors": [{"x": 1.0, "y": 0.0}] * 8}, "missing key"),
    ],
)
def test_impossible_settings_are_refused(settings, message):
    with pytest.raises(SettingsError, match=message):
        Khepera(**settings)


def test_settings_are_frozen_and_come_back_from_json():
    robot = Khepera(infrared="linear", radius=26.0)
    with pytest.raises(SettingsError, match="frozen"):
        robot.radius = 1.0  # pyright: ignore[reportAttributeAccessIssue]
    assert Khepera.model_validate_json(robot.model_dump_json()) == robot
    assert Khepera(**robot.model_dump()) == robot

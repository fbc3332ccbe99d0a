"""The readings told are those of the mind and the robot, by the names of their settings."""

import pytest

from animat.mind.mind import Learning, Mind, VariableChange
from animat.report.readings_taken import readings
from animat.robot.khepera import Khepera


def told(mind=None, robot=None):
    return {
        setting: reading for _, setting, reading in readings(mind or Mind(), robot or Khepera())
    }


def test_every_reading_goes_by_the_name_of_a_setting():
    fields = {
        **Mind.model_fields,
        **VariableChange.model_fields,
        **{f"learning.{name}": field for name, field in Learning.model_fields.items()},
        **{f"robot.{name}": field for name, field in Khepera.model_fields.items()},
    }
    for setting in told():
        assert setting.split(" = ")[0] in fields


def test_every_point_is_told_once():
    assert len(told()) == len(readings(Mind(), Khepera()))


def test_the_default_readings():
    first = told()
    assert first['physiology = "excess"'] == (
        "nutrition decay, stamina growth, restlessness growth"
    )
    assert first["lethal_margin"] == "at the bound itself"
    assert first["success_effect"] == "0.2"
    assert first["encounter_range"] == "30 mm from the rim"
    assert first["robot.infrared"] == "michel1996"


@pytest.mark.parametrize(
    ("setting", "changes", "reading"),
    [
        ("lethal_margin", {"physiology": "decay"}, "nutrition 0.05"),
        ("overflow", {"overflow": "lethal"}, "lethal"),
        ("failed_act", {"failed_act": "clamp"}, "clamp"),
        ("success_effect", {"success_effect": 0.25}, "0.25"),
        ("failure_effect", {"failure_effect": 0.0}, "0"),
        ("error", {"error": "absolute"}, "absolute"),
        ("gate", {"gate": "always"}, "always"),
        ("consumed", {"consumed": True}, "re-placed"),
        ("encounter_range", {"encounter_range": 42.0}, "42 mm"),
        ("interaction_steps", {"interaction_steps": 33}, "33 steps"),
        ("approach_steps", {"approach_steps": 77}, "77 steps"),
        ("learning.biases", {"learning": Learning(biases=False)}, "no"),
        ("learning", {"learning": Learning(rate=0.25, cycles=3)}, "0.25, 3 cycles"),
        ("learning.threshold", {"learning": Learning(threshold=0.01)}, "0.01"),
        ("likelihood_threshold", {"likelihood_threshold": 0.75}, "0.75"),
        ("feature_noise", {"feature_noise": 0.125}, "0.125"),
        ("wander", {"cruise_speed": 7}, "7 motor units"),
    ],
)
def test_a_changed_setting_is_told(setting, changes, reading):
    changed = told(Mind(**changes))
    assert reading in changed[setting]
    assert changed[setting] != told()[setting]


def test_a_changed_robot_is_told():
    assert told(robot=Khepera(infrared="linear"))["robot.infrared"] == "linear"

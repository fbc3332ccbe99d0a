import math

import numpy as np
import pytest

from animat.mind.agents import ASK_NETWORKS
from animat.mind.mind import Learning, Mind
from animat.mind.parameters import MIND, SHARED, parameters
from animat.numerics.elementary import exponential

AFFORDANCES = ("grasp", "shelter", "interact")
LETHAL_BOUNDS = {"drift_floor", "drift_ceiling", "act_floor", "act_ceiling"}
BOUNDS = {"dies_below", "dies_above"} | LETHAL_BOUNDS


def fields(record):
    """The fields of a record by name, as lists."""
    return {name: np.asarray(record[name]).tolist() for name in record.dtype.names}


def changed(mind, base=None):
    """What differs in a mind's parameters, by name: from, to."""
    old = fields(parameters(base or Mind(), AFFORDANCES))
    new = fields(parameters(mind, AFFORDANCES))
    return {name: (old[name], new[name]) for name in old if old[name] != new[name]}


SETTINGS = {
    "agent": ("AF", {"judge": (0, ASK_NETWORKS)}),
    "lethal_margin": (0.0, None),
    "overflow": (
        "lethal",
        {
            "act_floor": ([-math.inf, 0.0, 0.0], [-math.inf] * 3),
            "act_ceiling": ([1.0, math.inf, math.inf], [math.inf] * 3),
        },
    ),
    "failed_act": (
        "clamp",
        {
            "act_floor": ([-math.inf, 0.0, 0.0], [0.0] * 3),
            "act_ceiling": ([1.0, math.inf, math.inf], [1.0] * 3),
        },
    ),
    "success_effect": (0.3, {"success": None}),
    "failure_effect": (0.0, {"failure": None}),
    "death": (False, None),
    "error": ("absolute", {"error": (0, 2)}),
    "drive_function": ("mine.py:drives", {"error": (0, 3)}),
    "selector": ("affordance_times_drive", {"selector": (0, 1)}),
    "gate": ("always", {"gated": (True, False)}),
    "likelihood_threshold": (0.7, {"likelihood_threshold": (0.5, 0.7)}),
    "encounter_range": (40.0, {"encounter_range": (30.0, 40.0)}),
    "contact_range": (12.0, {"contact_range": (10.0, 12.0)}),
    "interaction_steps": (5, {"interaction_steps": (20, 5)}),
    "approach_steps": (50, {"approach_steps": (100, 50)}),
    "leave_steps": (0, {"leave_steps": (40, 0)}),
    "consumed": (True, {"consumed": (False, True)}),
    "feature_noise": (0.1, {"feature_noise": (0.0, 0.1)}),
    "wander": ("mine.py:wander", {"wander": (0, 1)}),
    "cruise_speed": (7, {"cruise_speed": (5, 7)}),
    "turn_speed": (3, {"turn_speed": (5, 3)}),
}
"""A value other than the default for each plain setting, and what it changes for the step."""


@pytest.mark.parametrize("name", SETTINGS)
def test_a_setting_changes_what_it_is_about_and_nothing_else(name):
    value, wanted = SETTINGS[name]
    got = changed(Mind(**{name: value}))
    if wanted is None:
        return
    assert got.keys() == wanted.keys()
    for field, change in wanted.items():
        assert change is None or got[field] == change


def test_no_setting_is_left_out_here():
    told_elsewhere = {"physiology", "variables", "drives", "behaviours", "learning", "networks"}
    assert set(SETTINGS) | told_elsewhere == set(Mind.model_fields)
    assert set(SHARED) <= set(SETTINGS)


@pytest.mark.parametrize(
    ("name", "value", "field", "code"),
    [
        ("rate", 0.1, "learning_rate", 0.1),
        ("cycles", 1, "learning_cycles", 1),
        ("threshold", 0.3, "learning_threshold", 0.3),
        ("biases", False, "biases", False),
        ("estimator", "mine.py:estimate", "estimator", 1),
        ("learner", "mine.py:learn", "learner", 1),
    ],
)
def test_a_setting_of_learning_changes_what_it_is_about(name, value, field, code):
    got = changed(Mind(learning={name: value}))
    assert list(got) == [field]
    assert got[field][1] == code
    assert {*Learning.model_fields} == {
        "hidden_units", "rate", "cycles", "threshold", "biases", "estimator", "learner"
    }  # fmt: skip


def test_the_defaults_are_those_of_the_paper():
    record = fields(parameters(Mind(), AFFORDANCES))
    assert record["rate"] == [1e-4, 1e-4, 1e-3]
    assert record["set_point"] == [0.9, 0.2, 0.1]
    assert record["start"] == [0.5] * 3
    assert record["sense"] == [1.0, -1.0, -1.0]
    assert record["law"] == [0, 2, 2]
    assert record["a"] == np.eye(3).tolist()
    assert record["b"] == np.zeros((3, 3)).tolist()
    assert record["success"] == np.diag([0.2, -0.2, -0.2]).tolist()
    assert record["failure"] == np.diag([-0.2, 0.2, 0.2]).tolist()
    assert record["serves"] == record["needs"] == [0, 1, 2]
    assert (record["learning_rate"], record["learning_cycles"]) == (0.5, 10)
    assert (record["learning_threshold"], record["biases"]) == (0.05, True)
    assert record["interaction_steps"] == 20
    assert record["encounter_range"] == 30.0
    assert record["gated"]
    assert record["error"] == record["selector"] == 0


@pytest.mark.parametrize(
    ("physiology", "laws", "senses"),
    [
        ("excess", [0, 2, 2], [1, -1, -1]),
        ("decay", [0, 0, 0], [1, 1, 1]),
        ("relax", [0, 1, 1], [1, -1, -1]),
        ("linear", [3, 4, 4], [1, -1, -1]),
    ],
)
def test_a_physiology_sets_laws_and_kinds(physiology, laws, senses):
    record = parameters(Mind(physiology=physiology), AFFORDANCES)
    assert record.law.tolist() == laws
    assert record.sense.tolist() == senses
    np.testing.assert_array_equal(np.diagonal(record.success), 0.2 * record.sense)
    np.testing.assert_array_equal(np.diagonal(record.failure), -0.2 * record.sense)


@pytest.mark.parametrize(
    ("margin", "below", "above"), [(None, 0.05, 0.95), (0.01, 0.01, 0.99), (0.0, 0.0, 1.0)]
)
def test_the_lethal_margin_moves_the_lethal_bounds(margin, below, above):
    for physiology in ("decay", "relax"):
        record = parameters(Mind(physiology=physiology, lethal_margin=margin), AFFORDANCES)
        falling = record.sense > 0
        inwards = margin != 0.0
        np.testing.assert_array_equal(
            record.dies_below, np.where(falling, np.nextafter(below, inwards * 1.0), 0.0)
        )
        np.testing.assert_array_equal(
            record.dies_above,
            np.where(falling, 1.0, np.nextafter(above, 0.0) if inwards else above),
        )


def test_a_lethal_variable_drifts_freely_and_others_are_held():
    record = fields(parameters(Mind(variables={"stamina": {"lethal": False}}), AFFORDANCES))
    inf = math.inf
    assert record["dies_below"] == [0.0, -inf, 0.0]
    assert record["dies_above"] == [1.0, inf, 1.0]
    assert record["drift_floor"] == [-inf, 0.0, -inf]
    assert record["drift_ceiling"] == [inf, 1.0, inf]
    assert record["act_floor"] == [-inf, 0.0, 0.0]
    assert record["act_ceiling"] == [1.0, 1.0, inf]


def test_who_cannot_die_is_held_everywhere():
    got = changed(Mind(death=False))
    assert got.keys() == BOUNDS | {"mortal"}
    for name in ("drift_floor", "act_floor"):
        assert got[name][1] == [0.0] * 3
    for name in ("drift_ceiling", "act_ceiling"):
        assert got[name][1] == [1.0] * 3
    assert got["dies_below"][1] == [-math.inf] * 3
    assert got["dies_above"][1] == [math.inf] * 3


def test_the_factor_of_a_law_is_that_of_its_rate():
    record = parameters(Mind(variables={"nutrition": {"rate": 0.25}}), AFFORDANCES)
    assert record.factor[0] == exponential(-0.25) == pytest.approx(math.exp(-0.25), rel=1e-15)
    assert changed(Mind(variables={"nutrition": {"rate": 0.25}})).keys() == {"rate", "factor"}


def test_minds_of_any_size_fill_their_matrices():
    mind = Mind(
        variables={
            "water": {"law": "linear", "kind": "deficit", "rate": 1e-3, "set_point": 3.0,
                      "low": -1.0, "high": 4.0, "start": 2.0},
            "heat": {"law": "relax", "rate": 1e-2, "set_point": 0.3},
        },
        drives={
            "hunger": {"a": {"nutrition": 1.0}},
            "fatigue": {"a": {"stamina": 0.5, "heat": 0.25}, "b": {"stamina": 10.0}},
            "curiosity": {"a": {"restlessness": 1.0}},
            "thirst": {"a": {"water": 2.0}, "b": {"water": -3.0, "heat": 1.0}},
        },
        behaviours={
            "eat": {"serves": "hunger", "needs": "grasp"},
            "graze": {"serves": "hunger", "needs": "grasp", "success": {"nutrition": 0.1}},
            "shelter": {"serves": "fatigue", "needs": "shelter"},
            "interact": {"serves": "curiosity", "needs": "interact", "failure": {}},
            "drink": {
                "serves": "thirst", "needs": "drink",
                "success": {"water": 0.5, "heat": 0.2, "nutrition": -0.05},
                "failure": {"stamina": -0.1},
            },
        },
        success_effect=0.3,
        failure_effect=0.1,
    )  # fmt: skip
    record = parameters(mind, ("drink", "interact", "shelter", "grasp"))
    assert record.dtype == MIND.dtype({"V": 5, "D": 4, "B": 5})
    assert record.sense.tolist() == [1, -1, -1, 1, -1]
    assert record.law.tolist() == [0, 2, 2, 3, 1]
    assert (record.low[3], record.high[3], record.start[3]) == (-1.0, 4.0, 2.0)
    assert record.a.tolist() == [
        [1.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.5, 0.0, 0.0, 0.25],
        [0.0, 0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 2.0, 0.0],
    ]
    assert record.b.tolist() == [
        [0.0] * 5,
        [0.0, 10.0, 0.0, 0.0, 0.0],
        [0.0] * 5,
        [0.0, 0.0, 0.0, -3.0, 1.0],
    ]
    assert record.serves.tolist() == [0, 0, 1, 2, 3]
    assert record.needs.tolist() == [3, 3, 2, 1, 0]
    assert record.success.tolist() == [
        [0.3, 0.0, 0.0, 0.0, 0.0],
        [0.1, 0.0, 0.0, 0.0, 0.0],
        [0.0, -0.3, 0.0, 0.0, -0.3],
        [0.0, 0.0, -0.3, 0.0, 0.0],
        [-0.05, 0.0, 0.0, 0.5, -0.2],
    ]
    assert record.failure.tolist() == [
        [-0.1, 0.0, 0.0, 0.0, 0.0],
        [-0.1, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.1, 0.0, 0.0, 0.1],
        [0.0] * 5,
        [0.0, 0.1, 0.0, 0.0, 0.0],
    ]


def test_a_behaviour_whose_affordance_no_object_has_is_refused():
    with pytest.raises(ValueError, match="behaviours") as told:
        parameters(Mind(), ("grasp", "shelters", "interact"))
    assert str(told.value) == (
        'behaviours.shelter.needs = "shelter": no object of this world affords it;'
        ' did you mean "shelters"?'
    )

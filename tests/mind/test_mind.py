import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.files.settings import SettingsError
from animat.mind.affordance import weight_count
from animat.mind.mind import Behaviour, Drive, Learning, Mind, VariableChange
from animat.mind.networks import Networks
from animat.mind.physiology import PHYSIOLOGIES, Variable

HUNGER = {"hunger": {"a": {"nutrition": 1.0}}}
EAT = {"eat": {"serves": "hunger", "needs": "grasp"}}


def problems(**settings):
    """What a user is told of settings, a line each."""
    with pytest.raises(SettingsError) as refused:
        Mind(**settings)
    return list(refused.value.problems)


def networks(behaviours=("eat", "shelter", "interact"), hidden=2):
    weights = np.zeros((len(behaviours), weight_count(2, hidden)))
    return Networks(tuple(behaviours), ("shape", "size"), hidden, weights)


def test_the_defaults_make_the_mind_of_the_paper():
    mind = Mind()
    assert mind.agent == "BLIND"
    assert mind.physiology == "excess"
    assert mind.mortal
    assert mind.resolved_variables() == PHYSIOLOGIES["excess"]
    assert list(mind.drives) == ["hunger", "fatigue", "curiosity"]
    assert list(mind.behaviours) == ["eat", "shelter", "interact"]
    assert mind.learning == Learning(
        hidden_units=2, biases=True, rate=0.5, cycles=10, threshold=0.05
    )


def test_settings_come_as_tables_or_as_objects():
    from_tables = Mind(
        variables={"nutrition": {"set_point": 0.8}},
        drives=HUNGER,
        behaviours=EAT,
        learning={"cycles": 3},
    )
    from_objects = Mind(
        variables={"nutrition": VariableChange(set_point=0.8)},
        drives={"hunger": Drive(a={"nutrition": 1.0})},
        behaviours={"eat": Behaviour(serves="hunger", needs="grasp")},
        learning=Learning(cycles=3),
    )
    assert from_tables == from_objects


def test_a_mind_does_not_change():
    with pytest.raises(SettingsError, match="frozen"):
        Mind().gate = "always"
    before = Mind().resolved_variables()
    Mind(variables={"nutrition": {"rate": 0.1}}).resolved_variables()
    assert Mind().resolved_variables() == before == PHYSIOLOGIES["excess"]


@pytest.mark.parametrize(
    ("setting", "value", "told"),
    [
        ("agent", "FA", 'must be one of "BLIND", "AF", "LEARNING", "ORACLE", "RANDOM"'),
        ("agent", "BLND", 'did you mean "BLIND"?'),
        ("physiology", "excesss", '"excess", "decay", "relax", "linear"; did you mean "excess"?'),
        ("lethal_margin", 0.5, "must be less than 0.5"),
        ("lethal_margin", -0.01, "must be greater than or equal to 0"),
        ("overflow", "clmp", 'must be one of "clamp", "lethal"; did you mean "clamp"?'),
        ("failed_act", "touch", 'must be one of "lethal", "clamp"'),
        ("success_effect", 1.5, "must be less than or equal to 1"),
        ("success_effect", -0.2, "must be greater than or equal to 0"),
        ("failure_effect", -0.2, "must be greater than or equal to 0"),
        ("death", "no", "must be true or false"),
        ("death", 1, "must be true or false"),
        ("error", "sign", 'must be one of "signed", "rectified", "absolute"'),
        ("drive_function", "deadband", '"deadband" is no drive function, nor FILE.py:NAME'),
        ("selector", "randm", 'is no selector, nor FILE.py:NAME; did you mean "random"?'),
        ("gate", "never", 'must be one of "positive", "always"'),
        ("likelihood_threshold", 1.1, "must be less than or equal to 1"),
        ("encounter_range", 0.0, "must be greater than 0"),
        ("encounter_range", 201.0, "must be less than or equal to 200"),
        ("contact_range", 5.0, "must be greater than or equal to 6"),
        ("interaction_steps", 0, "must be greater than or equal to 1"),
        ("interaction_steps", 2.5, "must be a whole number"),
        ("approach_steps", 0, "must be greater than or equal to 1"),
        ("leave_steps", -1, "must be greater than or equal to 0"),
        ("interaction_steps", 2**63, "must be less than or equal to 1000000000"),
        ("approach_steps", 2**63, "must be less than or equal to 1000000000"),
        ("leave_steps", 2**63, "must be less than or equal to 1000000000"),
        ("consumed", "yes", "must be true or false"),
        ("feature_noise", 2.0, "must be less than or equal to 1"),
        ("wander", "straight", "is no wander, nor FILE.py:NAME; known: curved"),
        ("cruise_speed", 11, "must be less than or equal to 10"),
        ("turn_speed", 0, "must be greater than or equal to 1"),
    ],
)
def test_a_value_that_is_not_allowed_is_told_with_its_key_and_what_is(setting, value, told):
    (line,) = problems(**{setting: value})
    shown = f'"{value}"' if isinstance(value, str) else str(value)
    assert line.startswith(f"key {setting} = {shown}: ")
    assert told in line


@pytest.mark.parametrize(
    ("setting", "value", "told"),
    [
        ("hidden_units", 0, "must be greater than or equal to 1"),
        ("hidden_units", 65, "must be less than or equal to 64"),
        ("biases", 1, "must be true or false"),
        ("rate", 0.0, "must be greater than 0"),
        ("cycles", 0, "must be greater than or equal to 1"),
        ("threshold", -0.1, "must be greater than or equal to 0"),
        ("estimator", "feedforward", 'is no estimator, nor FILE.py:NAME; did you mean "feed_f'),
        ("learner", "hebb", "is no learner, nor FILE.py:NAME; known: back_propagation"),
    ],
)
def test_impossible_learning_is_told_with_its_key(setting, value, told):
    (line,) = problems(learning={setting: value})
    assert line.startswith(f"key learning.{setting} = ")
    assert told in line


def test_unknown_keys_are_told_with_the_nearest_known_one():
    assert problems(phisiology="decay") == [
        'key phisiology: unknown key; did you mean "physiology"?'
    ]
    assert problems(learning={"cycle": 1}) == [
        'key learning.cycle: unknown key; did you mean "cycles"?'
    ]
    assert problems(variables={"nutrition": {"setpoint": 0.8}}) == [
        'key variables.nutrition.setpoint: unknown key; did you mean "set_point"?'
    ]


def test_variables_are_changed_one_setting_at_a_time():
    changes = {"set_point": 0.7, "start": 0.6, "rate": 2e-4, "lethal": False, "lethal_margin": 0.1}
    for name, value in changes.items():
        resolved = Mind(variables={"stamina": {name: value}}).resolved_variables()
        wanted = {**dict(PHYSIOLOGIES["excess"]["stamina"]), name: value}
        assert resolved["stamina"] == Variable(**wanted)
        assert list(resolved) == ["nutrition", "stamina", "restlessness"]
        assert resolved["nutrition"] == PHYSIOLOGIES["excess"]["nutrition"]
    zone = Mind(variables={"stamina": {"low": -1.0, "high": 2.0}}).resolved_variables()["stamina"]
    assert (zone.low, zone.high) == (-1.0, 2.0)


def test_the_law_of_a_variable_is_changed_and_its_kind_with_it():
    grows = Mind(physiology="linear", variables={"nutrition": {"law": "growth"}})
    assert not grows.resolved_variables()["nutrition"].is_deficit
    rises = Mind(variables={"nutrition": {"law": "linear", "kind": "excess"}})
    assert not rises.resolved_variables()["nutrition"].is_deficit
    slower = Mind(physiology="linear", variables={"nutrition": {"rate": 1e-5}})
    assert slower.resolved_variables()["nutrition"].is_deficit


def test_a_lethal_margin_moves_that_of_every_variable_that_has_one():
    for physiology in ("decay", "relax"):
        margins = Mind(physiology=physiology, lethal_margin=0.02).resolved_variables().values()
        assert {variable.lethal_margin for variable in margins} == {0.02}
    for physiology in ("excess", "linear"):
        none = Mind(physiology=physiology, lethal_margin=0.02).resolved_variables()
        assert none == PHYSIOLOGIES[physiology]
    own = Mind(
        physiology="decay", lethal_margin=0.02, variables={"stamina": {"lethal_margin": 0.03}}
    )
    assert [v.lethal_margin for v in own.resolved_variables().values()] == [0.02, 0.03, 0.02]


def test_every_impossible_variable_is_told_at_once():
    assert problems(
        variables={
            "nutrition": {"set_point": 1.2},
            "stamina": {"law": "linear"},
            "restlessness": {"start": 0.99, "law": "relax", "lethal_margin": 0.05},
            "nutritoin": {"rate": 1e-3},
            "water": {"law": "linear", "rate": 1e-3, "set_point": 0.5},
        }
    ) == [
        "variables.nutrition: set_point = 1.2 lies outside the viability zone [0.0, 1.0]",
        'variables.stamina: law = "linear" needs kind = "deficit" or "excess"',
        "variables.restlessness: start = 0.99 is lethal at once",
        "variables.nutritoin: a new variable must give law, rate and set_point;"
        ' did you mean "nutrition"?',
        'variables.water: law = "linear" needs kind = "deficit" or "excess"',
    ]
    assert problems(variables={"nutrition": {"rate": -1e-4}}) == [
        "key variables.nutrition.rate = -0.0001: must be greater than 0"
    ]


def test_every_impossible_combination_is_told_at_once():
    assert problems(
        drives={
            "hunger": {"a": {"nutritoin": 1.0}},
            "idle": {"a": {}},
            "fatigue": {"a": {"stamina": 1.0}, "b": {"stamnia": 1.0}},
            "curiosity": None,
        },
        behaviours={
            "eat": {"serves": "hungr", "needs": "grasp"},
            "rest": {
                "serves": "fatigue",
                "needs": "shelter",
                "success": {"stamia": 1.0},
                "failure": {"strength": 1.0},
            },
            "shelter": None,
            "interact": None,
        },
        contact_range=40.0,
    ) == [
        'drives.hunger watches "nutritoin", which is no variable; did you mean "nutrition"?',
        "drives.idle watches no variable",
        'drives.fatigue watches "stamnia", which is no variable; did you mean "stamina"?',
        'behaviours.eat.serves = "hungr" is no drive; did you mean "hunger"?',
        'behaviours.rest moves "stamia", which is no variable; did you mean "stamina"?',
        'behaviours.rest moves "strength", which is no variable;'
        " known: nutrition, stamina, restlessness",
        "contact_range = 40.0 is wider than encounter_range = 30.0",
    ]


def test_a_drive_may_watch_rates_alone():
    mind = Mind(drives={"hunger": {"a": {}, "b": {"nutrition": -1.0}}}, behaviours=EAT)
    assert (mind.drives["hunger"].a, mind.drives["hunger"].b) == ({}, {"nutrition": -1.0})


NO_DRIVES = dict.fromkeys(("hunger", "fatigue", "curiosity"))
NO_BEHAVIOURS = dict.fromkeys(("eat", "shelter", "interact"))


@pytest.mark.parametrize("nothing", [{"drives": NO_DRIVES}, {"behaviours": NO_BEHAVIOURS}])
def test_a_mind_without_drives_or_behaviours_is_refused(nothing):
    assert "a mind needs at least one drive and one behaviour" in problems(**nothing)


THIRST = {
    "variables": {"thirst": {"law": "growth", "rate": 1e-4, "set_point": 0.1}},
    "drives": {"thirsty": {"a": {"thirst": 1.0}}},
    "behaviours": {"drink": {"serves": "thirsty", "needs": "grasp"}},
}


def test_one_need_more_is_added_to_those_of_the_paper():
    mind = Mind(**THIRST)
    assert list(mind.resolved_variables()) == ["nutrition", "stamina", "restlessness", "thirst"]
    assert list(mind.drives) == ["hunger", "fatigue", "curiosity", "thirsty"]
    assert list(mind.behaviours) == ["eat", "shelter", "interact", "drink"]
    assert mind.drives["hunger"] == Mind().drives["hunger"]
    own = Mind(drives={"fatigue": {"a": {"stamina": 2.0}}})
    assert list(own.drives) == ["hunger", "fatigue", "curiosity"]
    assert own.drives["fatigue"].a == {"stamina": 2.0}


@pytest.mark.parametrize("gone", [None, False])
def test_a_need_of_the_paper_can_be_removed(gone):
    mind = Mind(
        variables={"restlessness": gone}, drives={"curiosity": gone}, behaviours={"interact": gone}
    )
    assert list(mind.resolved_variables()) == ["nutrition", "stamina"]
    assert (list(mind.drives), list(mind.behaviours)) == (["hunger", "fatigue"], ["eat", "shelter"])
    assert problems(drives={"curiosty": gone}) == [
        "key drives: curiosty = false: there is nothing of this name to remove;"
        ' did you mean "curiosity"?'
    ]
    assert problems(variables={"restlessness": gone}) == [
        'drives.curiosity watches "restlessness", which is no variable; known: nutrition, stamina'
    ]


@given(
    removed=st.sets(st.sampled_from(["hunger", "fatigue", "curiosity"]), max_size=2),
    added=st.permutations(["warm", "wet", "fatigue"]),
)
def test_a_mind_written_down_in_any_way_reads_back_as_itself(removed, added):
    given = {name: {"a": {"stamina": 1.0}} for name in added} | dict.fromkeys(removed)
    behaviours = dict.fromkeys(["eat", "shelter", "interact"]) | {
        "rest": {"serves": "warm", "needs": "shelter"}
    }
    mind = Mind(drives=given, behaviours=behaviours)
    assert removed.isdisjoint(mind.drives)
    for again in (
        Mind(**mind.model_dump()),
        Mind(**dict(mind)),
        Mind.model_validate_json(mind.model_dump_json()),
        Mind.model_validate_json(mind.model_dump_json(exclude_unset=True)),
    ):
        assert again == mind
        assert list(again.drives) == list(mind.drives)
        assert list(again.behaviours) == list(mind.behaviours)


def test_who_names_all_of_the_papers_orders_them():
    backwards = dict(reversed(Mind().drives.items()))
    assert list(Mind(drives=backwards).drives) == ["curiosity", "fatigue", "hunger"]


def test_a_mind_may_have_one_drive_or_many():
    small = Mind(drives=NO_DRIVES | HUNGER, behaviours=NO_BEHAVIOURS | EAT)
    assert list(small.drives) == ["hunger"]
    names = [f"v{n}" for n in range(12)]
    large = Mind(
        variables={name: {"law": "decay", "rate": 0.1, "set_point": 0.5} for name in names},
        drives={f"d{name}": {"a": dict.fromkeys(names, 1.0)} for name in names},
        behaviours={f"b{name}": {"serves": f"d{name}", "needs": "grasp"} for name in names},
    )
    assert len(large.resolved_variables()) == 15


@pytest.mark.parametrize(
    ("known", "told"),
    [
        (networks(("eat", "shelter")), "networks are for"),
        (networks(hidden=3), "networks have 3 hidden units, learning.hidden_units = 2"),
    ],
)
def test_networks_that_do_not_fit_the_mind_are_refused(known, told):
    (line,) = problems(agent="AF", networks=known)
    assert told in line


def test_networks_are_no_setting_to_write_down():
    mind = Mind(agent="AF", networks=networks())
    assert mind.networks == networks()
    assert "networks" not in mind.model_dump()
    assert "networks" not in repr(mind)


def test_the_number_of_weights_follows_from_features_and_hidden_units():
    assert Mind().weight_count(2) == 9
    assert Mind(learning={"hidden_units": 5}).weight_count(3) == 26


def law_one(value, low, high, rate, factor):
    return value - rate


def law_two(value, low, high, rate, factor):
    return value - 2 * rate


def test_one_law_of_ones_own_serves_all_variables_that_follow_one():
    own = {"law": law_one, "kind": "deficit"}
    mind = Mind(variables={"nutrition": own, "stamina": own})
    assert mind.functions().law(0.5, 0.0, 1.0, 0.25, 0.9) == 0.25
    assert problems(variables={"nutrition": own, "stamina": {**own, "law": law_two}}) == [
        "variables nutrition, stamina follow different laws of your own;"
        " one function must serve them all"
    ]

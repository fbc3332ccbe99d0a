import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.mind.functions import unused_law
from animat.mind.homeostasis import first_outside, metabolise, settle
from animat.mind.mind import Mind
from animat.mind.parameters import parameters
from animat.numerics.compiled import compiled

AFFORDANCES = ("grasp", "shelter", "interact")
DEFICIT, EXCESS = 0, 1  # nutrition and stamina of the linear physiology
LAWS = ("decay", "relax", "growth", "fall", "rise")


def mind_with(law, **variable):
    """Parameters of a mind whose nutrition follows a law; the others hardly move."""
    if law in {"fall", "rise"}:
        variable["kind"] = "deficit" if law == "fall" else "excess"
    name = "linear" if law in {"fall", "rise"} else law
    still = {"rate": 1e-9}
    mind = Mind(
        variables={
            "nutrition": {"law": name, **variable},
            "stamina": still,
            "restlessness": still,
        }
    )
    return parameters(mind, AFFORDANCES)


@compiled
def drift(values, mind, steps):
    """Let the values drift; return how many steps they stayed in their zones."""
    for step in range(steps):
        metabolise(values, mind, unused_law)
        if first_outside(values, mind) >= 0:
            return step
    return steps


def closed_form(law, start, low, high, rate, steps):
    return {
        "decay": lambda: low + (start - low) * math.exp(-rate * steps),
        "relax": lambda: high - (high - start) * math.exp(-rate * steps),
        "growth": lambda: low + (start - low) * math.exp(rate * steps),
        "fall": lambda: start - rate * (high - low) * steps,
        "rise": lambda: start + rate * (high - low) * steps,
    }[law]()


def steps_in_zone(law, start, low, high, rate):
    """How many steps the closed form stays in the zone, as a real number."""
    return {
        "decay": lambda: math.inf,
        "relax": lambda: math.inf,
        "growth": lambda: math.log((high - low) / (start - low)) / rate,
        "fall": lambda: (start - low) / (high - low) / rate,
        "rise": lambda: (high - start) / (high - low) / rate,
    }[law]()


@pytest.mark.parametrize(
    ("law", "start", "rate"),
    [
        ("decay", 0.9, 1e-4),
        ("decay", 0.5, 6e-4),
        ("relax", 0.1, 1e-4),
        ("relax", 0.5, 1e-6),
        ("growth", 0.5, 6e-7),
        ("growth", 1e-30, 6.9e-5),
        ("fall", 0.9, 8e-7),
        ("rise", 0.1, 8e-7),
    ],
)
def test_a_million_steps_follow_the_closed_form(law, start, rate):
    record = mind_with(law, start=start, rate=rate)
    values = np.array(record.start)
    assert drift(values, record, 1_000_000) == 1_000_000
    assert values[0] == pytest.approx(closed_form(law, start, 0.0, 1.0, rate, 10**6), rel=1e-9)


@given(
    law=st.sampled_from(LAWS),
    low=st.floats(-1.0, 1.0),
    width=st.floats(0.5, 3.0),
    share=st.floats(0.05, 0.95),
    rate=st.floats(1e-5, 0.5),
    patience=st.integers(1, 1_000_000),
)
def test_laws_follow_their_closed_forms_in_any_zone(law, low, width, share, rate, patience):
    high = low + width
    start = low + share * width
    record = mind_with(law, low=low, high=high, start=start, set_point=start, rate=rate)
    steps = math.floor(min(patience, steps_in_zone(law, start, low, high, rate)))
    values = np.array(record.start)
    assert drift(values, record, steps) in {steps - 1, steps}
    exact = closed_form(law, start, low, high, rate, steps)
    assert values[0] == pytest.approx(exact, rel=1e-9, abs=1e-9 * max(abs(low), abs(high)))


@pytest.mark.parametrize("rate", [1e-4, 1e-3, 0.3])
@pytest.mark.parametrize("law", ["growth", "fall", "rise"])
def test_laws_that_reach_a_bound_cross_it_when_the_closed_form_does(law, rate):
    record = mind_with(law, start=0.37055, set_point=0.5, rate=rate)
    values = np.array(record.start)
    assert drift(values, record, 10**6) == math.floor(steps_in_zone(law, 0.37055, 0.0, 1.0, rate))
    assert first_outside(values, record) == 0
    assert (values[0] < 0.0) == (law == "fall")


@pytest.mark.parametrize("law", ["decay", "relax"])
def test_laws_that_only_near_a_bound_never_kill(law):
    record = mind_with(law, start=0.5, rate=1e-3)
    values = np.array(record.start)
    assert drift(values, record, 10**6) == 10**6
    assert 0.0 <= values[0] <= 1.0


@pytest.mark.parametrize(("law", "bound"), [("decay", 0.05), ("relax", 0.95)])
def test_a_lethal_margin_kills_where_it_is_reached(law, bound):
    record = mind_with(law, start=0.5, rate=1e-3, lethal_margin=0.05)
    values = np.array(record.start)
    reached = math.log(0.5 / 0.05) / 1e-3
    assert drift(values, record, 10**6) == math.floor(reached)
    inside = math.nextafter(bound, 0.5)
    outside = math.nextafter(bound, round(bound))
    for value, dead in ((inside, False), (bound, True), (outside, True)):
        values[0] = value
        assert (first_outside(values, record) == 0) == dead


def record_of(**mind):
    return parameters(Mind(physiology="linear", **mind), AFFORDANCES)


def settled(record, variable, value):
    """Where an act that leads to `value` leaves a variable, and whether it kills."""
    values = np.full(3, 0.5)
    values_after = values.copy()
    values_after[variable] = value
    settle(values, values_after, record)
    others = np.delete(values, variable)
    assert (others == 0.5).all()
    return values[variable], first_outside(values, record) == variable


@pytest.mark.parametrize("variable", [DEFICIT, EXCESS])
@pytest.mark.parametrize("failed_act", ["lethal", "clamp"])
@pytest.mark.parametrize("overflow", ["clamp", "lethal"])
def test_an_act_carries_a_variable_as_far_as_the_settings_let_it(overflow, failed_act, variable):
    record = record_of(overflow=overflow, failed_act=failed_act)
    satisfied, needy = (1.2, -0.2) if variable == DEFICIT else (-0.2, 1.2)
    for value, setting in ((satisfied, overflow), (needy, failed_act)):
        held = min(max(value, 0.0), 1.0)
        assert settled(record, variable, value) == (
            (value, True) if setting == "lethal" else (held, False)
        )
    assert settled(record, variable, 0.7) == (0.7, False)
    assert settled(record, variable, 0.0) == (0.0, False)
    assert settled(record, variable, 1.0) == (1.0, False)


@pytest.mark.parametrize("failed_act", ["lethal", "clamp"])
@pytest.mark.parametrize(("variable", "margin"), [(DEFICIT, 0.05), (EXCESS, 0.95)])
def test_a_failed_act_touches_the_lethal_margin_and_lets_the_drift_kill(
    variable, margin, failed_act
):
    name = ("nutrition", "stamina")[variable]
    record = record_of(failed_act=failed_act, variables={name: {"lethal_margin": 0.05}})
    needy = -0.2 if variable == DEFICIT else 1.2
    satisfied = 1.2 if variable == DEFICIT else -0.2
    assert settled(record, variable, satisfied) == (min(max(satisfied, 0.0), 1.0), False)
    if failed_act == "lethal":
        assert settled(record, variable, needy) == (needy, True)
        assert settled(record, variable, margin) == (margin, True)
        return
    touched = math.nextafter(margin, 0.5)
    assert settled(record, variable, needy) == (touched, False)
    values = np.full(3, 0.5)
    values[variable] = touched
    metabolise(values, record, unused_law)
    assert first_outside(values, record) == variable


@pytest.mark.parametrize("side", [-0.3, 1.3])
@pytest.mark.parametrize("variable", [DEFICIT, EXCESS])
def test_a_variable_that_is_not_lethal_stops_at_its_bounds(variable, side):
    name = ("nutrition", "stamina")[variable]
    spared = {name: {"lethal": False, "lethal_margin": 0.05, "rate": 0.3}}
    record = record_of(overflow="lethal", failed_act="lethal", variables=spared)
    assert settled(record, variable, side) == (min(max(side, 0.0), 1.0), False)
    other = 1 - variable
    assert settled(record, other, side) == (side, True)
    values = np.array([0.5, 0.5, 0.5])
    for _ in range(10):
        metabolise(values, record, unused_law)
    assert values[variable] == (0.0 if variable == DEFICIT else 1.0)
    assert first_outside(values, record) == -1


@pytest.mark.parametrize("mind", [{"agent": "LEARNING"}, {"death": False}])
def test_who_cannot_die_is_held_at_every_bound(mind):
    everything = {name: {"rate": 0.3} for name in ("nutrition", "stamina", "restlessness")}
    record = record_of(overflow="lethal", variables=everything, **mind)
    for variable in (DEFICIT, EXCESS):
        assert settled(record, variable, 9.0) == (1.0, False)
        assert settled(record, variable, -9.0) == (0.0, False)
    values = np.full(3, 0.5)
    assert drift(values, record, 1000) == 1000
    np.testing.assert_array_equal(values, [0.0, 1.0, 1.0])


def test_the_first_variable_outside_is_told():
    record = record_of()
    assert first_outside(np.array([0.5, 0.5, 0.5]), record) == -1
    assert first_outside(np.array([0.5, -0.1, 1.1]), record) == 1
    assert first_outside(np.array([1.1, -0.1, 0.5]), record) == 0


def test_a_law_of_ones_own_is_obeyed():
    @compiled
    def halve(value, low, high, rate, factor):
        return low + (value - low) / 2 + rate + 0 * factor * high

    mind = Mind(variables={"nutrition": {"law": halve.py_func, "kind": "deficit", "rate": 0.01}})
    record = parameters(mind, AFFORDANCES)
    values = np.array([0.4, 0.5, 0.5])
    metabolise(values, record, halve)
    assert values[0] == 0.2 + 0.01
    assert values[1] == 0.5 / record.factor[1]

"""Every setting does what it says: changed, the life changes in the way it should.

Each test lives a short life with and without a change and looks at the one thing the setting is
for. `test_every_setting_is_tested` holds the list against the settings there are.
"""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from animat.life.life import live
from animat.mind.mind import Behaviour, Drive, Learning, Mind, VariableChange
from animat.mind.networks import Networks
from animat.robot.khepera import Khepera, Sensor
from animat.world.arena import Arena
from animat.world.layout import Layout, Placement
from animat.world.objects import TABLE_1
from animat.world.world import World

STEPS = 3_000
CALM = {"motor_noise": False, "infrared_noise": False}


@pytest.fixture(scope="module")
def lived(small, columns):
    """Live a short life without death, and return its columns; equal settings give equal lives."""

    def lived(world=small, robot=None, steps=STEPS, **settings):
        settings = {"death": False, **settings}
        life = live(Mind(**settings), world, robot=robot, seed=4, steps=steps, record="all")
        return columns(life) | {"life": life}

    return lived


@pytest.fixture(scope="module")
def usual(lived):
    return lived()


def differs(one, other):
    return not one["life"].trace.equals(other["life"].trace)


def happened(c, event):
    return np.array([event in text.split() for text in c["event"]])


def before_any_outcome(c):
    """The steps until the first act ends, at least thirty."""
    ended = np.flatnonzero(c["reward"])
    first = int(ended[0]) + 1 if len(ended) else len(c["step"])
    assert first > 30
    return slice(0, first)


def drifted(c, variable, at_step):
    """Tell whether a variable was where a law would have it, until the first act ended."""
    until = before_any_outcome(c)
    assert np.abs(c[variable][until] - at_step(c["step"][until] + 1)).max() < 1e-12


def jumps(c, variable, behaviour, reward):
    """How far outcomes of a behaviour moved a variable that hardly drifts; none met a bound."""
    t = np.flatnonzero((c["reward"][:-1] == reward) & (c["behaviour"][:-1] == behaviour))
    t = t[(c[variable][t] > 0.25) & (c[variable][t] < 0.95)]
    assert len(t) > 0
    return c[variable][t + 1] - c[variable][t]


# --- that none is forgotten -------------------------------------------------------------------


def test_every_setting_is_tested():
    text = Path(__file__).read_text(encoding="utf-8")
    for model in (Mind, Learning, VariableChange, Drive, Behaviour, Khepera):
        for setting in model.model_fields:
            tested = re.search(rf"def test_{model.__name__.lower()}_{setting}\b", text)
            assert tested, f"{model.__name__}.{setting} has no test here"


def test_equal_settings_give_equal_lives(lived, usual):
    assert lived()["life"].trace.equals(usual["life"].trace)


# --- the variables ----------------------------------------------------------------------------


def test_variablechange_law(lived):
    c = lived(variables={"nutrition": {"law": "linear", "kind": "deficit"}})
    drifted(c, "nutrition", lambda n: 0.5 - 1e-4 * n)
    drifted(lived(), "nutrition", lambda n: 0.5 * np.exp(-1e-4 * n))


def test_variablechange_rate(lived):
    c = lived(variables={"nutrition": {"rate": 3e-4}})
    drifted(c, "nutrition", lambda n: 0.5 * np.exp(-3e-4 * n))


def test_variablechange_set_point(lived):
    c = lived(variables={"nutrition": {"set_point": 0.7}})
    assert np.allclose(c["hunger"], 0.7 - c["nutrition"], atol=1e-15)


def test_variablechange_start(lived):
    c = lived(variables={"stamina": {"start": 0.3}})
    drifted(c, "stamina", lambda n: 0.3 * np.exp(1e-4 * n))


def test_variablechange_low(lived):
    c = lived(variables={"nutrition": {"low": -1.0}})
    drifted(c, "nutrition", lambda n: -1.0 + 1.5 * np.exp(-1e-4 * n))


def test_variablechange_high(lived):
    c = lived(variables={"stamina": {"law": "relax", "high": 2.0}})
    drifted(c, "stamina", lambda n: 2.0 - 1.5 * np.exp(-1e-4 * n))


def test_variablechange_kind(lived):
    falling, rising = (
        lived(variables={"stamina": {"law": "linear", "kind": kind, "rate": 1e-4}})
        for kind in ("deficit", "excess")
    )
    drifted(falling, "stamina", lambda n: 0.5 - 1e-4 * n)
    drifted(rising, "stamina", lambda n: 0.5 + 1e-4 * n)
    assert np.allclose(falling["fatigue"], 0.2 - falling["stamina"])
    assert np.allclose(rising["fatigue"], rising["stamina"] - 0.2)


def test_variablechange_lethal(lived, caring_for):
    change = {"law": "linear", "kind": "excess", "rate": 0.01}
    settings = {"death": True, "success_effect": 0.0, "failure_effect": 0.0}
    mortal = lived(**settings, variables=caring_for("restlessness", **change))
    immortal = lived(**settings, variables=caring_for("restlessness", **change, lethal=False))
    assert mortal["life"].death == "restlessness high, metabolism"
    assert len(immortal["step"]) == STEPS


def test_variablechange_lethal_margin(lived, caring_for):
    for margin, steps in ((0.1, 40), (0.2, 30)):
        change = {"law": "linear", "kind": "excess", "rate": 0.01, "lethal_margin": margin}
        variables = caring_for("restlessness", **change)
        c = lived(death=True, variables=variables, success_effect=0.0, failure_effect=0.0)
        assert len(c["step"]) in (steps, steps + 1)  # 0.5 + 0.01 n is rounded
        assert c["restlessness"][-1] >= 1.0 - margin > c["restlessness"][-2]


# --- drives and behaviours --------------------------------------------------------------------

DRIVES = {
    "hunger": {"a": {"nutrition": 1.0}},
    "fatigue": {"a": {"stamina": 1.0}},
    "curiosity": {"a": {"restlessness": 1.0}},
}


def test_drive_a(lived):
    drives = DRIVES | {"hunger": {"a": {"nutrition": 2.0, "stamina": 0.5}}}
    c = lived(drives=drives)
    wanted = 2.0 * (0.9 - c["nutrition"]) + 0.5 * (c["stamina"] - 0.2)
    assert np.allclose(c["hunger"], wanted, atol=1e-14)


def test_drive_b(lived):
    drives = DRIVES | {"hunger": {"a": {"nutrition": 1.0}, "b": {"nutrition": 500.0}}}
    c = lived(drives=drives)
    rate = np.diff(c["nutrition"], prepend=0.5)
    assert np.allclose(c["hunger"], 0.9 - c["nutrition"] + 500.0 * rate, atol=1e-12)
    eaten = np.flatnonzero((c["behaviour"] == "eat") & (c["reward"] == 1))
    assert len(eaten) == 0 or (c["hunger"][eaten + 1] > 50).all()  # a meal is a rate too


BEHAVIOURS = {
    "eat": {"serves": "hunger", "needs": "grasp"},
    "shelter": {"serves": "fatigue", "needs": "shelter"},
    "interact": {"serves": "curiosity", "needs": "interact"},
}


def acts(c):
    """(behaviour, object type, reward, winning drive at the encounter) of every act."""
    ended = np.flatnonzero(c["reward"])
    met = np.flatnonzero(happened(c, "encounter"))
    for t in ended:
        start = met[met < t][-1]
        yield c["behaviour"][t], c["object"][t], int(c["reward"][t]), c["winning_drive"][start]


def test_behaviour_serves(lived, usual):
    crossed = BEHAVIOURS | {
        "eat": {"serves": "curiosity", "needs": "grasp"},
        "interact": {"serves": "hunger", "needs": "interact"},
    }
    by_drive = {"hunger": "interact", "curiosity": "eat", "fatigue": "shelter"}
    told = list(acts(lived(behaviours=crossed)))
    assert told
    assert all(behaviour == by_drive[drive] for behaviour, _, _, drive in told)
    assert any(behaviour == "interact" for behaviour, *_ in acts(usual))


def test_behaviour_needs(lived):
    needs = BEHAVIOURS | {"interact": {"serves": "curiosity", "needs": "grasp"}}
    told = [one for one in acts(lived(behaviours=needs)) if one[0] == "interact"]
    assert {reward for *_, reward, _ in told} == {1, -1}
    assert all((reward == 1) == (kind in ("TS", "CS")) for _, kind, reward, _ in told)


SLOW = {
    name: {"rate": 1e-9, "start": start}
    for name, start in (("nutrition", 0.5), ("stamina", 0.5), ("restlessness", 0.9))
}


def test_behaviour_success(lived):
    effects = {"nutrition": 0.05, "stamina": -0.03, "restlessness": 0.01}
    behaviours = BEHAVIOURS | {"interact": BEHAVIOURS["interact"] | {"success": effects}}
    c = lived(behaviours=behaviours, variables=SLOW, steps=1_000)
    assert np.allclose(jumps(c, "nutrition", "interact", 1), 0.05, atol=1e-6)
    assert np.allclose(
        jumps(c, "stamina", "interact", 1), 0.03, atol=1e-6
    )  # away from satisfaction
    assert np.allclose(jumps(c, "restlessness", "interact", 1), -0.01, atol=1e-6)


def test_behaviour_failure(lived, affording):
    effects = {"nutrition": -0.05, "stamina": 0.03, "restlessness": -0.01}
    behaviours = BEHAVIOURS | {"interact": BEHAVIOURS["interact"] | {"failure": effects}}
    c = lived(world=affording(0.0), behaviours=behaviours, variables=SLOW, steps=1_000)
    assert np.allclose(jumps(c, "nutrition", "interact", -1), -0.05, atol=1e-6)
    assert np.allclose(jumps(c, "stamina", "interact", -1), -0.03, atol=1e-6)
    assert np.allclose(jumps(c, "restlessness", "interact", -1), 0.01, atol=1e-6)


# --- the mind ---------------------------------------------------------------------------------


def test_mind_agent(lived, usual):
    knowing = lived(agent="ORACLE")
    assert happened(knowing, "disregarded").any()
    assert not happened(usual, "disregarded").any()


@pytest.mark.parametrize("name", ["excess", "decay", "relax", "linear"])
def test_mind_physiology(name, lived):
    c = lived(physiology=name, steps=400)
    after = {
        "excess": (0.5 * math.exp(-1e-4), 0.5 * math.exp(1e-4), 0.5 * math.exp(1e-3)),
        "decay": (0.5 * math.exp(-1e-4), 0.5 * math.exp(-1e-4), 0.5 * math.exp(-1e-3)),
        "relax": (0.5 * math.exp(-1e-4), 1 - 0.5 * math.exp(-1e-4), 1 - 0.5 * math.exp(-1e-3)),
        "linear": (0.5 - 1e-4, 0.5 + 1e-4, 0.5 + 1e-3),
    }[name]
    first = [c[variable][0] for variable in ("nutrition", "stamina", "restlessness")]
    assert first == pytest.approx(after, rel=1e-13)


def test_mind_variables(lived):
    c = lived(variables={"restlessness": {"start": 0.2}})
    drifted(c, "restlessness", lambda n: 0.2 * np.exp(1e-3 * n))


def test_mind_lethal_margin(lived):
    variables = {"restlessness": {"rate": 0.01}}
    for margin in (0.05, 0.2):
        c = lived(
            physiology="decay",
            variables=variables,
            lethal_margin=margin,
            death=True,
            success_effect=0.0,
            failure_effect=0.0,
        )
        assert len(c["step"]) == math.ceil(math.log(0.5 / margin) / 0.01)
        assert c["restlessness"][-1] <= margin < c["restlessness"][-2]


def test_mind_overflow(lived, affording, caring_for):
    variables = caring_for("nutrition", start=0.85, rate=1e-7)
    settings = {"world": affording(1.0), "variables": variables, "death": True}
    held, lethal = (lived(**settings, overflow=reading) for reading in ("clamp", "lethal"))
    assert held["nutrition"].max() == pytest.approx(1.0, abs=1e-6)
    assert not held["life"].dead
    assert lethal["life"].death == "nutrition high, success"


def test_mind_failed_act(lived, affording, caring_for):
    variables = caring_for("nutrition", start=0.1, rate=1e-7)
    settings = {"world": affording(0.0), "variables": variables, "death": True}
    held, lethal = (lived(**settings, failed_act=reading) for reading in ("clamp", "lethal"))
    assert lethal["life"].death == "nutrition low, failure"
    assert held["nutrition"].min() == 0.0
    assert not held["life"].dead


@pytest.mark.parametrize("effect", [0.2, 0.07])
def test_mind_success_effect(effect, lived):
    c = lived(success_effect=effect, variables=SLOW, steps=1_000)
    assert np.allclose(jumps(c, "restlessness", "interact", 1), -effect, atol=1e-6)


@pytest.mark.parametrize("effect", [0.2, 0.07])
def test_mind_failure_effect(effect, lived, affording, caring_for):
    variables = caring_for("nutrition", start=0.8, rate=1e-9)
    c = lived(world=affording(0.0), failure_effect=effect, variables=variables, steps=1_000)
    assert np.allclose(jumps(c, "nutrition", "eat", -1), -effect, atol=1e-6)


def test_mind_death(lived):
    variables = {"restlessness": {"rate": 0.05}}
    assert lived(variables=variables, success_effect=0.0, death=True)["life"].dead
    assert not lived(variables=variables, success_effect=0.0, death=False)["life"].dead


@pytest.mark.parametrize(
    ("reading", "function"),
    [("signed", lambda e: e), ("rectified", lambda e: np.maximum(e, 0.0)), ("absolute", np.abs)],
)
def test_mind_error(reading, function, lived):
    variables = {"nutrition": {"start": 0.95}, "stamina": {"start": 0.1}}
    c = lived(error=reading, variables=variables)
    assert (0.9 - c["nutrition"]).min() < 0 < (0.9 - c["nutrition"]).max() + 0.1
    assert np.allclose(c["hunger"], function(0.9 - c["nutrition"]), atol=1e-14)
    assert np.allclose(c["fatigue"], function(c["stamina"] - 0.2), atol=1e-14)
    assert np.allclose(c["curiosity"], function(c["restlessness"] - 0.1), atol=1e-14)


def likely(**likelihoods):
    """Networks that say the same of every object."""
    weights = np.zeros((3, 9))
    for b, behaviour in enumerate(BEHAVIOURS):
        chance = likelihoods.get(behaviour, 0.5)
        weights[b, 6] = math.log(chance / (1.0 - chance))
    return Networks(tuple(BEHAVIOURS), ("shape", "size"), 2, weights)


def test_mind_selector(lived, usual):
    networks = likely(eat=0.9, shelter=0.2, interact=0.01)
    usually = lived(networks=networks)
    c = lived(selector="affordance_times_drive", networks=networks)
    drives = np.column_stack([c["hunger"], c["fatigue"], c["curiosity"]])
    best = (drives * np.array([0.9, 0.2, 0.01])).argmax(axis=1)
    met = np.flatnonzero(happened(c, "encounter"))
    chosen = [behaviour for behaviour, *_ in acts(c)]
    wanted = [list(BEHAVIOURS)[best[t]] for t in met[: len(chosen)]]
    assert chosen == wanted
    assert chosen != [behaviour for behaviour, *_ in acts(usually)]
    serves = {kind["serves"]: name for name, kind in BEHAVIOURS.items()}
    assert all(behaviour == serves[drive] for behaviour, _, _, drive in acts(usual))
    random = lived(selector="random", steps=6_000)
    assert {behaviour for behaviour, *_ in acts(random)} == set(BEHAVIOURS)
    assert any(behaviour != serves[drive] for behaviour, _, _, drive in acts(random))


def test_mind_gate(lived):
    content = {
        "nutrition": {"start": 0.95, "rate": 1e-9},
        "stamina": {"start": 0.1, "rate": 1e-9},
        "restlessness": {"start": 0.05, "rate": 1e-9},
    }
    assert not happened(lived(variables=content), "encounter").any()
    assert happened(lived(variables=content, gate="always"), "encounter").any()


def test_mind_likelihood_threshold(lived):
    networks = likely(eat=0.6, shelter=0.6, interact=0.6)
    for threshold, disregards in ((0.59, False), (0.61, True)):
        c = lived(agent="AF", networks=networks, likelihood_threshold=threshold)
        assert happened(c, "encounter").any()
        assert happened(c, "disregarded").any() == disregards


def distances(c, site):
    """How far (mm) the object at a site is from the centre of the robot in every row."""
    raster = c["life"].setting.raster
    rows = (c["y"] / raster.resolution + raster.border).astype(int)
    places = (c["x"] / raster.resolution + raster.border).astype(int)
    here = raster.near_site[rows, places] == site[:, None]
    return np.where(here, raster.near_distance[rows, places], np.inf).min(axis=1)


@pytest.mark.parametrize("reach", [30.0, 60.0])
def test_mind_encounter_range(reach, lived):
    c = lived(encounter_range=reach, steps=6_000)
    met = np.flatnonzero(happened(c, "encounter"))
    met = met[met > 0]
    away = distances(c, c["site"])[met]
    assert away.max() <= 27.5 + reach
    assert away.max() > 27.5 + reach - 4.0  # a step is 2.5 mm long


@pytest.mark.parametrize("contact", [10.0, 20.0])
def test_mind_contact_range(contact, lived):
    c = lived(contact_range=contact, steps=6_000)
    reached = np.flatnonzero(happened(c, "reached"))
    away = distances(c, c["site"])[reached + 1]
    assert away.max() <= 27.5 + contact
    assert away.max() > 27.5 + contact - 4.0


def lengths(c, doing):
    """How long each run of a behaviour was, the last aside."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], (c["behaviour"] == doing) * 1, [0]])))
    return [last - first for first, last in zip(edges[::2], edges[1::2], strict=True)][:-1]


@pytest.mark.parametrize("steps", [20, 33])
def test_mind_interaction_steps(steps, lived):
    assert set(lengths(lived(interaction_steps=steps), "interact")) == {steps}


@pytest.mark.parametrize("steps", [3, 5])
def test_mind_approach_steps(steps, lived):
    c = lived(approach_steps=steps)
    assert set(lengths(c, "approach")) == {steps}
    assert happened(c, "unreached").sum() >= len(lengths(c, "approach"))


@pytest.mark.parametrize("steps", [4, 11])
def test_mind_leave_steps(steps, lived):
    assert max(lengths(lived(leave_steps=steps), "leave")) == steps


def test_mind_consumed(lived, spared):
    persisting = lived(world=spared, steps=10_000)
    consuming = lived(world=spared, steps=10_000, consumed=True)
    assert consuming["site"].max() >= spared.n_objects > persisting["site"].max()


@pytest.mark.parametrize("noise", [0.0, 0.4])
def test_mind_feature_noise(noise, lived, trained):
    c = lived(agent="AF", networks=trained, feature_noise=noise, gate="always", steps=8_000)
    met = np.flatnonzero(happened(c, "encounter"))
    said = {}
    for t in met:
        told = (c["object"][t], c["winning_drive"][t])
        behaviour = {"hunger": "eat", "fatigue": "shelter", "curiosity": "interact"}[told[1]]
        said.setdefault(told, set()).add(c[f"likelihood_{behaviour}"][t])
    assert sum(map(len, said.values())) > len(said) if noise else len(said) > 3
    for (kind, drive), likelihoods in said.items():
        if not noise:
            assert len(likelihoods) == 1, (kind, drive)


@pytest.mark.parametrize("speed", [5, 3])
def test_mind_cruise_speed(speed, lived):
    c = lived(cruise_speed=speed)
    ahead = c["left"] + c["right"] > 0
    assert ahead.mean() > 0.5
    assert set((c["left"] + c["right"])[ahead]) == {2 * speed}


@pytest.mark.parametrize("speed", [5, 2])
def test_mind_turn_speed(speed, lived):
    c = lived(turn_speed=speed)
    turning = (c["left"] == -c["right"]) & (c["left"] != 0)
    assert set(np.abs(c["left"][turning])) == {speed}


def test_mind_learning(lived):
    c = lived(agent="LEARNING", learning={"threshold": 0.3})
    assert not happened(c, "trained").any()
    assert happened(lived(agent="LEARNING"), "trained").any()


def test_mind_networks(lived):
    for networks in (likely(interact=0.8), likely(interact=0.9)):
        c = lived(agent="AF", networks=networks)
        wanted = networks.likelihoods({"shape": 0.0, "size": 0.0})["interact"]
        assert c["likelihood_interact"].max() == pytest.approx(wanted)


# --- learning ---------------------------------------------------------------------------------


def first_lesson(c, step_by_step):
    """The state before and after the first training of a life."""
    life = c["life"]
    before = None
    for state, _ in step_by_step(life.mind, life.world, STEPS, seed=4):
        if state.trainings == 1:
            return before, state
        before = state
    raise AssertionError("it never trained")


def taught(weights, features, target, rate, cycles, biases):
    """Back-propagation through a 2-2-1 network, in NumPy."""
    hidden_weights = weights[:6].reshape(2, 3).copy()
    output_weights = weights[6:].copy()
    inputs = np.concatenate([[1.0], features])
    mask = 1.0 if biases else 0.0
    for _ in range(cycles):
        hidden = 1 / (1 + np.exp(-hidden_weights @ inputs))
        output = 1 / (1 + np.exp(-(output_weights[0] + output_weights[1:] @ hidden)))
        delta = (target - output) * output * (1 - output)
        back = delta * output_weights[1:] * hidden * (1 - hidden)
        hidden_weights += rate * np.outer(back, inputs * [mask, 1.0, 1.0])
        output_weights += rate * delta * np.concatenate([[mask], hidden])
    return np.concatenate([hidden_weights.ravel(), output_weights])


def lesson_follows(c, step_by_step, rate=0.5, cycles=10, biases=True):
    before, after = first_lesson(c, step_by_step)
    b = before.behaviour
    target = 1.0 if after.reward == 1 else 0.0
    wanted = taught(before.weights[b], after.features, target, rate, cycles, biases)
    assert np.abs(after.weights[b] - wanted).max() < 1e-13
    return before


def test_learning_rate(lived, step_by_step):
    for rate in (0.5, 0.2):
        c = lived(agent="LEARNING", learning={"rate": rate})
        lesson_follows(c, step_by_step, rate=rate)


def test_learning_cycles(lived, step_by_step):
    for cycles in (10, 3):
        c = lived(agent="LEARNING", learning={"cycles": cycles})
        lesson_follows(c, step_by_step, cycles=cycles)


def test_learning_biases(lived, step_by_step):
    places = [0, 3, 6]
    for biases in (True, False):
        c = lived(agent="LEARNING", learning={"biases": biases})
        before = lesson_follows(c, step_by_step, biases=biases)
        assert (before.weights[:, places] != 0.0).all() == biases
        assert (c["life"].state.weights[:, places] != 0.0).any() == biases


@pytest.mark.parametrize(("threshold", "learns"), [(0.19, True), (0.21, False)])
def test_learning_threshold(threshold, learns, lived):
    c = lived(agent="LEARNING", learning={"threshold": threshold}, variables=SLOW)
    assert (c["reward"] != 0).any()
    assert happened(c, "trained").any() == learns


# --- a mind of another size, and of the user's own functions ----------------------------------


@pytest.fixture(scope="module")
def larger(lived):
    """Four variables, drives and behaviours, and three hidden units."""
    return lived(
        agent="LEARNING",
        variables={"warmth": {"law": "linear", "kind": "deficit", "rate": 2e-4, "set_point": 0.9}},
        drives=DRIVES | {"chill": {"a": {"warmth": 3.0}}},
        behaviours=BEHAVIOURS | {"bask": {"serves": "chill", "needs": "shelter"}},
        learning={"hidden_units": 3},
        steps=4_000,
    )


def test_mind_drives(larger):
    assert np.allclose(larger["chill"], 3.0 * (0.9 - larger["warmth"]))
    assert "chill" in larger["winning_drive"]


def test_mind_behaviours(larger):
    told = [one for one in acts(larger) if one[0] == "bask"]
    assert told
    assert all((reward == 1) == (kind in ("TL", "CL")) for _, kind, reward, _ in told)
    assert all(drive == "chill" for *_, drive in told)
    assert len(larger["life"].networks.behaviours) == 4


def test_learning_hidden_units(larger):
    networks = larger["life"].networks
    assert networks.weights.shape == (4, 3 * 3 + 4)
    features = np.array([1.0, 0.0])
    told = networks.likelihoods({"shape": 1.0, "size": 0.0})
    for b, behaviour in enumerate(networks.behaviours):
        units = networks.weights[b, :9].reshape(3, 3)
        hidden = 1 / (1 + np.exp(-(units[:, 0] + units[:, 1:] @ features)))
        output = networks.weights[b, 9] + networks.weights[b, 10:] @ hidden
        assert told[behaviour] == pytest.approx(1 / (1 + np.exp(-output)), rel=1e-13)


def still(value, low, high, rate, factor):
    return value + rate


def fixed(values, changes, set_points, senses, a, b, out):
    for d in range(len(out)):
        out[d] = 0.25 + 0.125 * d


def second(drives, likelihoods, serves, luck):
    return 1


def sure(features, weights, hidden):
    return 0.625 + weights[0]


def note(features, weights, hidden, target, rate, cycles, biases):
    weights[0] = 0.0625
    weights[1] += 1.0


def circle(readings, aheads, sides, memory, luck_a, luck_b, speed, turn):
    memory[0] += 1.0
    return 4.0, 6.0


@pytest.fixture(scope="module")
def own(lived):
    """A mind made of the user's own functions only."""
    rising = {"law": still, "kind": "excess"}
    return lived(
        agent="LEARNING",
        variables={"stamina": rising, "nutrition": {"law": still, "kind": "deficit"}},
        drive_function=fixed,
        selector=second,
        wander=circle,
        learning={"estimator": sure, "learner": note, "threshold": 0.0},
        encounter_range=150.0,
        steps=6_000,
    )


def test_a_law_of_ones_own_is_followed(own):
    drifted(own, "stamina", lambda n: 0.5 + 1e-4 * n)
    drifted(own, "nutrition", lambda n: 0.5 + 1e-4 * n)
    drifted(own, "restlessness", lambda n: 0.5 * np.exp(1e-3 * n))


def test_mind_drive_function(own):
    for drive, value in (("hunger", 0.25), ("fatigue", 0.375), ("curiosity", 0.5)):
        assert (own[drive] == value).all()
    assert set(own["winning_drive"]) == {"curiosity"}


def test_a_selector_of_ones_own_chooses(own):
    told = {behaviour for behaviour, *_ in acts(own)}
    assert told == {"shelter"}


def test_mind_wander(own, usual):
    searching = own["behaviour"] == "wander"
    assert set(own["left"][searching]) == {4}
    assert set(own["right"][searching]) == {6}
    assert own["life"].state.memory[0] == searching.sum()
    assert len(set(usual["left"])) > 3


def test_learning_estimator(own):
    weights = own["life"].setting.begin(4, np.zeros(1, np.uint64))[0]["weights"][0]
    met = np.flatnonzero(happened(own, "encounter"))
    assert own["likelihood_shelter"][met[0]] == 0.625 + weights[1, 0]


def test_learning_learner(lived, affording):
    """The drives of `fixed` never vary, so this one learns by drives that do."""
    c = lived(
        agent="LEARNING",
        drive_function=echo,
        selector=second,
        wander=circle,
        variables={"stamina": {"law": still, "kind": "excess"}},
        learning={"estimator": sure, "learner": note},
        encounter_range=150.0,
        steps=6_000,
    )
    trained = int(happened(c, "trained").sum())
    birth = c["life"].setting.begin(4, np.zeros(1, np.uint64))[0]["weights"][0]
    end = c["life"].state.weights
    assert trained > 0
    assert end[1, 0] == 0.0625
    assert end[1, 1] == pytest.approx(birth[1, 1] + trained)
    assert np.array_equal(end[[0, 2]], birth[[0, 2]])


def echo(values, changes, set_points, senses, a, b, out):
    for d in range(len(out)):
        out[d] = values[d]


# --- the robot --------------------------------------------------------------------------------


@pytest.mark.parametrize("radius", [27.5, 20.0])
def test_khepera_radius(radius, lived):
    c = lived(robot=Khepera(radius=radius, wheel_base=40.0), steps=6_000)
    met = np.flatnonzero(happened(c, "encounter"))
    met = met[met > 0]
    assert radius + 30.0 - 4.0 < distances(c, c["site"])[met].max() <= radius + 30.0


def turned(c):
    return (np.diff(c["heading"]) + math.pi) % math.tau - math.pi


def free(c):
    """The steps after which the robot stands where its motors led it."""
    return ~happened(c, "blocked")[:-1]


@pytest.mark.parametrize("base", [50.0, 53.0])
def test_khepera_wheel_base(base, lived):
    c = lived(robot=Khepera(wheel_base=base, **CALM))
    commanded = 0.5 * (c["right"] - c["left"])[:-1] / base
    assert np.abs(turned(c) - commanded)[free(c)].max() < 1e-12
    assert np.abs(commanded).max() > 0.0


def gone(c):
    return np.hypot(np.diff(c["x"]), np.diff(c["y"]))


@pytest.mark.parametrize("length", [0.5, 0.8])
def test_khepera_step_mm(length, lived):
    c = lived(robot=Khepera(step_mm=length, **CALM))
    ahead = (c["left"] + c["right"] == 10)[:-1] & free(c)
    assert np.abs(gone(c)[ahead] - 5.0 * length).max() < 1e-12


@pytest.mark.parametrize("most", [10, 3])
def test_khepera_max_motor(most, lived):
    c = lived(robot=Khepera(max_motor=most, **CALM))
    straight = (c["left"] == 5) & (c["right"] == 5)
    way = gone(c)[straight[:-1] & free(c)]
    assert np.abs(way - 0.5 * min(5, most)).max() < 1e-12


def test_khepera_motor_noise(lived, usual):
    c = lived(robot=Khepera(motor_noise=False))
    for told, spread in ((c, 0.0), (usual, 0.1)):
        straight = (told["left"] == 5) & (told["right"] == 5)
        way = gone(told)[straight[:-1] & free(told)]
        assert 0.8 * spread <= np.abs(way / 2.5 - 1.0).max() <= spread + 1e-12


@pytest.mark.parametrize("spread", [0.10, 0.30])
def test_khepera_position_noise(spread, lived):
    c = lived(robot=Khepera(position_noise=spread))
    straight = (c["left"] == 5) & (c["right"] == 5)
    way = gone(c)[straight[:-1] & free(c)] / 2.5
    assert 0.8 * spread < np.abs(way - 1.0).max() <= spread + 1e-12


@pytest.mark.parametrize("spread", [0.05, 0.20])
def test_khepera_turn_noise(spread, lived):
    c = lived(robot=Khepera(turn_noise=spread))
    turning = (np.abs(c["left"] - c["right"]) == 10)[:-1] & free(c)
    share = np.abs(turned(c))[turning] / 0.1
    assert 0.9 * spread < np.abs(share - 1.0).max() <= spread + 1e-12


@pytest.mark.parametrize("ring", [30.0, 40.0])
def test_khepera_ring_radius(ring, lived):
    """A robot that does not see keeps its ring free of walls, and comes close to them."""
    blind = tuple(Sensor(x=0.0, y=0.0, direction=180.0) for _ in range(8))
    empty = World.random({}, arena=Arena(width=560.0, height=560.0))
    c = lived(world=empty, robot=Khepera(ring_radius=ring, sensors=blind))
    walls = np.minimum.reduce([c["x"] - 22, 538 - c["x"], c["y"] - 26, 536 - c["y"]])
    assert happened(c, "blocked").any()
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
    assert differs(usual, lived(robot=Khepera(infrared="linear")))


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


# --- the world --------------------------------------------------------------------------------


def world_of(types=TABLE_1, names=("TS", "TL", "CS", "CL"), **settings):
    return World.random(
        dict.fromkeys(names, 1),
        seed=1,
        arena=Arena(width=560.0, height=560.0),
        types=types,
        **settings,
    )


def with_changed(**changes):
    return tuple(kind.model_copy(update=changes) for kind in TABLE_1)


def test_world_features(lived, trained):
    same = with_changed(features={"shape": 0.0, "size": 0.0})
    c = lived(world=world_of(same), agent="AF", networks=trained, steps=6_000)
    said = {c["likelihood_eat"].max(), c["likelihood_eat"][-1]} - {0.0}
    wanted = trained.likelihoods({"shape": 0.0, "size": 0.0})["eat"]
    assert list(said) == pytest.approx([wanted])
    met = set(c["object"]) - {None}
    assert len(met) > 1


@pytest.mark.parametrize("probability", [0.0, 0.5, 1.0])
def test_world_affords(probability, lived, affording):
    c = lived(world=affording(probability), gate="always", steps=20_000)
    rewards = c["reward"][c["reward"] != 0]
    assert len(rewards) > 50
    share = (rewards == 1).mean()
    spread = 4 * math.sqrt(probability * (1 - probability) / len(rewards))
    assert abs(share - probability) <= spread


def alone(kind, x=280.0, y=280.0, angle=0.0, **changes):
    types = with_changed(**changes) if changes else TABLE_1
    layout = Layout(
        placements=(Placement(type=kind, x=x, y=y, angle=angle),),
        types=types,
        arena=Arena(width=560.0, height=560.0),
    )
    return World(layout=layout, name="alone")


@pytest.mark.parametrize(
    ("world", "least", "most"),
    [
        (alone("CS"), 19.0, 19.0 * math.sqrt(2)),
        (alone("CS", size_mm=60.0), 30.0, 30.0 * math.sqrt(2)),
        (alone("CS", shape="octagon", size_mm=60.0), 30.0, 30.0 / math.cos(math.pi / 8)),
    ],
    ids=["as it is", "size", "shape"],
)
def test_world_shape_and_size(world, least, most, lived):
    """How far the centre of the object is when it is met tells how large it is."""
    c = lived(world=world, steps=20_000)
    met = np.flatnonzero(happened(c, "encounter"))
    met = met[met > 0]
    assert len(met) > 8
    away = np.hypot(c["x"][met] - 280.0, c["y"][met] - 280.0)
    assert least + 57.5 - 5.0 <= away.min()
    assert away.max() <= most + 57.5 + 2.0


def test_world_places(lived):
    for x, y in ((200.0, 300.0), (350.0, 260.0)):
        c = lived(world=alone("CL", x=x, y=y))
        met = np.flatnonzero(happened(c, "encounter"))
        assert np.hypot(c["x"][met] - x, c["y"][met] - y).max() < 54.2 + 57.5 + 2.0


def test_world_counts(lived):
    c = lived(world=world_of(names=("TS", "CS")), steps=6_000)
    assert set(c["object"]) == {"TS", "CS", None}


def test_world_arena(lived):
    wide = World.random({"TS": 1}, seed=1, arena=Arena(width=900.0, height=400.0))
    c = lived(world=wide, steps=10_000)
    assert 700.0 < c["x"].max() < 878.0
    assert c["y"].max() < 376.0


def test_world_resolution(lived):
    """Where the world is drawn finer, an encounter begins nearer to its range."""
    far = {}
    for resolution in (1.0, 8.0):
        world = World(layout=alone("CL").layout, resolution=resolution)
        c = lived(world=world, steps=10_000)
        met = np.flatnonzero(happened(c, "encounter"))
        met = met[met > 0]
        gap = octagon_distance(c["x"][met] - 280.0, c["y"][met] - 280.0)
        far[resolution] = np.abs(gap - 57.5).max()
    assert far[1.0] < 2.5 * 1.1 + 1.0
    assert far[8.0] > far[1.0]


def octagon_distance(x, y):
    """How far (mm) points are from an octagon 100 mm across flats at the origin."""
    import shapely

    [polygon] = alone("CL", 280.0, 280.0).polygons()
    return shapely.distance(shapely.points(x, y), shapely.Polygon(polygon - 280.0))

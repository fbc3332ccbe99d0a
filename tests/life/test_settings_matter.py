"""Every setting of a mind does what it says: changed, the life changes in the way it should.

Each test lives a short life with and without a change and looks at the one thing the setting is
for. The tests of other settings stand beside this file; `test_every_setting_is_tested` holds them
all against the settings there are.
"""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from animat.mind.mind import Behaviour, Drive, Learning, Mind, VariableChange
from animat.mind.networks import Networks
from animat.robot.khepera import Khepera


def test_every_setting_is_tested():
    files = Path(__file__).parent.glob("test_*.py")
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    for model in (Mind, Learning, VariableChange, Drive, Behaviour, Khepera):
        for setting in model.model_fields:
            tested = re.search(rf"def test_{model.__name__.lower()}_{setting}\b", text)
            assert tested, f"{model.__name__}.{setting} has no test"


def test_equal_settings_give_equal_lives(lived, usual):
    assert lived().life.trace.equals(usual.life.trace)


BEHAVIOURS = {
    "eat": {"serves": "hunger", "needs": "grasp"},
    "shelter": {"serves": "fatigue", "needs": "shelter"},
    "interact": {"serves": "curiosity", "needs": "interact"},
}

SLOW = {
    name: {"rate": 1e-9, "start": start}
    for name, start in (("nutrition", 0.5), ("stamina", 0.5), ("restlessness", 0.9))
}


def test_mind_agent(lived, usual):
    knowing = lived(agent="ORACLE")
    assert knowing.happened("disregarded").any()
    assert not usual.happened("disregarded").any()


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
    c.drifted("restlessness", lambda n: 0.2 * np.exp(1e-3 * n))


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
    assert not held.life.dead
    assert lethal.life.death == "nutrition high, success"


def test_mind_failed_act(lived, affording, caring_for):
    variables = caring_for("nutrition", start=0.1, rate=1e-7)
    settings = {"world": affording(0.0), "variables": variables, "death": True}
    held, lethal = (lived(**settings, failed_act=reading) for reading in ("clamp", "lethal"))
    assert lethal.life.death == "nutrition low, failure"
    assert held["nutrition"].min() == 0.0
    assert not held.life.dead


@pytest.mark.parametrize("effect", [0.2, 0.07])
def test_mind_success_effect(effect, lived):
    c = lived(success_effect=effect, variables=SLOW, steps=1_000)
    assert np.allclose(c.jumps("restlessness", "interact", 1), -effect, atol=1e-6)


@pytest.mark.parametrize("effect", [0.2, 0.07])
def test_mind_failure_effect(effect, lived, affording, caring_for):
    variables = caring_for("nutrition", start=0.8, rate=1e-9)
    c = lived(world=affording(0.0), failure_effect=effect, variables=variables, steps=1_000)
    assert np.allclose(c.jumps("nutrition", "eat", -1), -effect, atol=1e-6)


def test_mind_death(lived):
    variables = {"restlessness": {"rate": 0.05}}
    assert lived(variables=variables, success_effect=0.0, death=True).life.dead
    assert not lived(variables=variables, success_effect=0.0, death=False).life.dead


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
    met = np.flatnonzero(c.happened("encounter"))
    chosen = [behaviour for behaviour, *_ in c.acts()]
    wanted = [list(BEHAVIOURS)[best[t]] for t in met[: len(chosen)]]
    assert chosen == wanted
    assert chosen != [behaviour for behaviour, *_ in usually.acts()]
    serves = {kind["serves"]: name for name, kind in BEHAVIOURS.items()}
    assert all(behaviour == serves[drive] for behaviour, _, _, drive in usual.acts())
    random = lived(selector="random", steps=6_000)
    assert {behaviour for behaviour, *_ in random.acts()} == set(BEHAVIOURS)
    assert any(behaviour != serves[drive] for behaviour, _, _, drive in random.acts())


def test_mind_gate(lived):
    content = {
        "nutrition": {"start": 0.95, "rate": 1e-9},
        "stamina": {"start": 0.1, "rate": 1e-9},
        "restlessness": {"start": 0.05, "rate": 1e-9},
    }
    assert not lived(variables=content).happened("encounter").any()
    assert lived(variables=content, gate="always").happened("encounter").any()


def test_mind_likelihood_threshold(lived):
    networks = likely(eat=0.6, shelter=0.6, interact=0.6)
    for threshold, disregards in ((0.59, False), (0.61, True)):
        c = lived(agent="AF", networks=networks, likelihood_threshold=threshold)
        assert c.happened("encounter").any()
        assert c.happened("disregarded").any() == disregards


@pytest.mark.parametrize("reach", [30.0, 60.0])
def test_mind_encounter_range(reach, lived):
    c = lived(encounter_range=reach, steps=6_000)
    met = np.flatnonzero(c.happened("encounter"))
    met = met[met > 0]
    away = c.distances()[met]
    assert away.max() <= 27.5 + reach
    assert away.max() > 27.5 + reach - 4.0  # a step is 2.5 mm long


@pytest.mark.parametrize("contact", [10.0, 20.0])
def test_mind_contact_range(contact, lived):
    c = lived(contact_range=contact, steps=6_000)
    reached = np.flatnonzero(c.happened("reached"))
    away = c.distances()[reached + 1]
    assert away.max() <= 27.5 + contact
    assert away.max() > 27.5 + contact - 4.0


@pytest.mark.parametrize("steps", [20, 33])
def test_mind_interaction_steps(steps, lived):
    assert set(lived(interaction_steps=steps).lengths("interact")) == {steps}


@pytest.mark.parametrize("steps", [3, 5])
def test_mind_approach_steps(steps, lived):
    c = lived(approach_steps=steps)
    assert set(c.lengths("approach")) == {steps}
    assert c.happened("unreached").sum() >= len(c.lengths("approach"))


@pytest.mark.parametrize("steps", [4, 11])
def test_mind_leave_steps(steps, lived):
    assert max(lived(leave_steps=steps).lengths("leave")) == steps


def test_mind_consumed(lived, spared):
    persisting = lived(world=spared, steps=10_000)
    consuming = lived(world=spared, steps=10_000, consumed=True)
    assert consuming["site"].max() >= spared.n_objects > persisting["site"].max()


@pytest.mark.parametrize("noise", [0.0, 0.4])
def test_mind_feature_noise(noise, lived, trained):
    c = lived(agent="AF", networks=trained, feature_noise=noise, gate="always", steps=8_000)
    met = np.flatnonzero(c.happened("encounter"))
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
    assert not c.happened("trained").any()
    assert lived(agent="LEARNING").happened("trained").any()


def test_mind_networks(lived):
    for networks in (likely(interact=0.8), likely(interact=0.9)):
        c = lived(agent="AF", networks=networks)
        wanted = networks.likelihoods({"shape": 0.0, "size": 0.0})["interact"]
        assert np.nanmax(c["likelihood_interact"]) == pytest.approx(wanted)

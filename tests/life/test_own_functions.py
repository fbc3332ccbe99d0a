"""A mind of another size, and a mind made of the user's own functions."""

import numpy as np
import pytest

from animat.life.digest import digest
from animat.life.life import live
from animat.mind.behaviours import curved_wander
from animat.mind.mind import Mind
from animat.world.arena import Arena
from animat.world.world import World

ALL_THERE = np.ones(1, np.uint8)

DRIVES = {
    "hunger": {"a": {"nutrition": 1.0}},
    "fatigue": {"a": {"stamina": 1.0}},
    "curiosity": {"a": {"restlessness": 1.0}},
}

BEHAVIOURS = {
    "eat": {"serves": "hunger", "needs": "grasp"},
    "shelter": {"serves": "fatigue", "needs": "shelter"},
    "interact": {"serves": "curiosity", "needs": "interact"},
}


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
    told = [one for one in larger.acts() if one[0] == "bask"]
    assert told
    assert all((reward == 1) == (kind in ("TL", "CL")) for _, kind, reward, _ in told)
    assert all(drive == "chill" for *_, drive in told)
    assert len(larger.life.networks.behaviours) == 4


def test_learning_hidden_units(larger):
    networks = larger.life.networks
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


def echo(values, changes, set_points, senses, a, b, out):
    for d in range(len(out)):
        out[d] = values[d]


def second(drives, likelihoods, serves, u, memory):
    return 1


def sure(features, weights, hidden):
    return 0.625 + weights[0]


def note(features, weights, hidden, target, rate, cycles, biases):
    weights[0] = 0.0625
    weights[1] += 1.0


def circle(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    memory[0] += 1.0
    return 4.0, 6.0


@pytest.fixture(scope="module")
def own(lived):
    """A mind made of the user's own functions only."""
    rising = {"law": still, "kind": "excess"}
    return lived(
        agent="LEARNING",
        variables={"stamina": rising, "nutrition": {"law": still, "kind": "deficit"}},
        drive_function=echo,
        selector=second,
        wander=circle,
        learning={"estimator": sure, "learner": note, "threshold": 0.0},
        encounter_range=150.0,
        steps=6_000,
    )


def test_a_law_of_ones_own_is_followed(own):
    own.drifted("stamina", lambda n: 0.5 + 1e-4 * n)
    own.drifted("nutrition", lambda n: 0.5 + 1e-4 * n)
    own.drifted("restlessness", lambda n: 0.5 * np.exp(1e-3 * n))


def test_mind_drive_function(own):
    drives = {"hunger": "nutrition", "fatigue": "stamina", "curiosity": "restlessness"}
    for drive, variable in drives.items():
        assert (own[drive] == own[variable]).all()
    strongest = np.argmax([own[drive] for drive in drives], axis=0)
    assert (own["winning_drive"] == np.array(list(drives))[strongest]).all()


def test_a_selector_of_ones_own_chooses(own):
    told = {behaviour for behaviour, *_ in own.acts()}
    assert told == {"shelter"}


def test_mind_wander(own, usual):
    searching = own["behaviour"] == "wander"
    assert set(own["left"][searching]) == {4}
    assert set(own["right"][searching]) == {6}
    assert own.life.state.memory[0] == searching.sum()
    assert len(set(usual["left"])) > 3


def test_learning_estimator(own):
    weights = own.life.setting.begin(4, np.zeros(1, np.uint64))[0]["weights"][0]
    met = np.flatnonzero(own.happened("encounter"))
    assert own["likelihood_shelter"][met[0]] == 0.625 + weights[1, 0]


def test_learning_learner(own):
    trained = int(own.happened("trained").sum())
    birth = own.life.setting.begin(4, np.zeros(1, np.uint64))[0]["weights"][0]
    end = own.life.state.weights
    assert trained > 0
    assert end[1, 0] == 0.0625
    assert end[1, 1] == pytest.approx(birth[1, 1] + trained)
    assert np.array_equal(end[[0, 2]], birth[[0, 2]])


def test_the_search_of_ours_does_the_same_whatever_is_read_in_the_dark(spared):
    ours, own = (
        live(Mind(death=False, **given), spared, seed=4, steps=20_000).state
        for given in ({}, {"wander": curved_wander})
    )
    assert digest(ours, ALL_THERE) == digest(own, ALL_THERE)


def reader(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    for reading in readings:
        if reading > memory[0]:
            memory[0] = reading
    return 0, 0


def test_a_controller_of_one_s_own_reads_the_noise_of_the_dark():
    wide = World.random({"TS": 0}, arena=Arena(width=5_000.0, height=5_000.0))
    state = live(Mind(death=False, wander=reader), wide, seed=4, steps=200).state
    assert state.memory[0] == 6

"""The five agents: what each does with the objects it meets, told from its trace."""

import numpy as np
import pytest

from animat.life.life import live
from animat.life.scenario import LifeError, bring_together
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.numerics.streams import SELECTION, uniforms
from animat.world.objects import TABLE_1

STEPS = 12_000
SERVES = {"hunger": "eat", "fatigue": "shelter", "curiosity": "interact"}
BEHAVIOURS = tuple(SERVES.values())
FEATURES = {kind.name: kind.features for kind in TABLE_1}
AFFORDS = {
    "eat": {"TS", "CS"},
    "shelter": {"TL", "CL"},
    "interact": {"TS", "TL", "CS", "CL"},
}

NEEDY = {"restlessness": {"law": "linear", "kind": "excess", "rate": 2e-4}}
"""A restlessness that grows no faster than it is served, so that all three drives get to win."""


def lived(agent, world, **settings):
    settings = {"death": False, "variables": NEEDY, **settings}
    return live(Mind(agent=agent, **settings), world, seed=2, steps=STEPS, record="all")


def encounters(c):
    """(step, object type, winning drive, behaviour acted out or None) of every encounter."""
    met = np.flatnonzero(c.happened("encounter"))
    for t, until in zip(met, [*met[1:], len(c["step"])], strict=True):
        acted = [doing for doing in c["behaviour"][t:until] if doing in BEHAVIOURS]
        yield int(t), c["object"][t], c["winning_drive"][t], (acted or [None])[0]


def complete(c):
    """Encounters that a life did not end in the middle of."""
    return [told for told in encounters(c) if told[0] < STEPS - 200]


def test_blind_acts_on_whatever_it_meets(small, columns):
    life = lived("BLIND", small)
    c = columns(life)
    told = complete(c)
    assert {drive for _, _, drive, _ in told} == set(SERVES)
    gave_up = life.state.unreached
    assert sum(acted is None for *_, acted in told) <= gave_up
    assert all(acted in (SERVES[drive], None) for _, _, drive, acted in told)
    assert life.state.disregarded == life.state.trainings == 0
    pairs = {(acted, kind) for _, kind, _, acted in told}
    assert any(kind not in AFFORDS[acted] for acted, kind in pairs if acted)
    assert np.array_equal(life.state.weights, born(life).weights)


def born(life):
    states, _ = bring_together(life.mind, life.world).begin(2, np.zeros(1, np.uint64))
    return states[0]


def test_af_acts_only_where_its_networks_see_a_chance(small, columns, trained):
    life = lived("AF", small, networks=trained)
    c = columns(life)
    told = complete(c)
    assert len(told) > 20
    disregarded = c.happened("disregarded")
    for t, kind, drive, acted in told:
        likelihood = trained.likelihoods(FEATURES[kind])[SERVES[drive]]
        assert c[f"likelihood_{SERVES[drive]}"][t] == pytest.approx(likelihood, rel=1e-12)
        assert disregarded[t] == (likelihood < 0.5)
        if disregarded[t]:
            assert acted is None
            assert c["behaviour"][t] == "leave"
        else:
            assert acted in (SERVES[drive], None)
    assert 0 < disregarded.sum() < len(told)
    assert life.state.acts == life.state.successes > 0  # what it learnt is right
    assert np.array_equal(life.state.weights, trained.weights)
    assert life.state.trainings == 0


def test_af_needs_networks(small):
    with pytest.raises(LifeError, match="AF needs trained networks"):
        live(Mind(agent="AF"), small, steps=10)


def test_af_does_not_take_networks_of_other_features(small):
    strange = Networks(BEHAVIOURS, ("colour", "size"), 2, np.zeros((3, 9)))
    with pytest.raises(LifeError, match="colour"):
        live(Mind(agent="AF", networks=strange), small, steps=10)


def test_learning_is_blind_and_trains_as_it_lives(small, columns):
    life = live(Mind(agent="LEARNING", variables=NEEDY), small, seed=2, steps=STEPS, record="all")
    blind = lived("BLIND", small)
    c, b = columns(life), columns(blind)
    assert not life.dead  # no death unless asked for
    for name in ("x", "y", "heading", "nutrition", "stamina", "restlessness", "behaviour"):
        assert np.array_equal(c[name], b[name]), name  # it lives as BLIND does
    assert life.state.trainings == life.state.acts > 0
    assert np.array_equal(c.happened("trained"), c["reward"] != 0)
    assert not np.array_equal(life.state.weights, blind.state.weights)
    assert blind.state.trainings == 0
    assert life.state.disregarded == 0


def test_learning_starts_optimistic_and_ends_knowing_table_1(trained, small):
    untrained = born(lived("LEARNING", small)).weights
    assert ((untrained >= 0.0) & (untrained < 1.0)).all()
    hopes = Networks(BEHAVIOURS, ("shape", "size"), 2, untrained)
    for kind, features in FEATURES.items():
        assert min(hopes.likelihoods(features).values()) > 0.5
        for behaviour, likelihood in trained.likelihoods(features).items():
            assert (likelihood > 0.5) == (kind in AFFORDS[behaviour]), (kind, behaviour)


def test_oracle_knows_table_1(small, columns):
    life = lived("ORACLE", small)
    c = columns(life)
    told = complete(c)
    disregarded = c.happened("disregarded")
    for t, kind, drive, _ in told:
        afforded = kind in AFFORDS[SERVES[drive]]
        assert disregarded[t] == (not afforded)
        assert c[f"likelihood_{SERVES[drive]}"][t] == float(afforded)
    assert 0 < disregarded.sum() < len(told)
    assert life.state.acts == life.state.successes > 0


def test_random_picks_any_behaviour_whatever_the_drives(small, columns):
    life = lived("RANDOM", small)
    c = columns(life)
    told = complete(c)
    assert len(told) > 40
    for t, _, _, acted in told:
        u = uniforms(np.uint64(2), np.uint64(0), SELECTION, t)[0]
        assert acted in (BEHAVIOURS[int(3 * u)], None)
    picked = [acted for *_, acted in told if acted]
    assert all(picked.count(behaviour) > len(picked) / 6 for behaviour in BEHAVIOURS)
    assert any(acted != SERVES[drive] for _, _, drive, acted in told if acted)
    assert life.state.disregarded == 0


def test_only_a_learning_robot_is_spared_death_by_default(small, trained, caring_for):
    variables = caring_for("restlessness", rate=0.01)
    for agent in ("BLIND", "AF", "ORACLE", "RANDOM", "LEARNING"):
        settings = {
            "agent": agent,
            "variables": variables,
            "success_effect": 0.0,
            "networks": trained if agent == "AF" else None,
        }
        assert live(Mind(**settings), small, steps=500).dead == (agent != "LEARNING")
        assert live(Mind(**settings, death=True), small, steps=500).dead
        assert not live(Mind(**settings, death=False), small, steps=500).dead


@pytest.mark.parametrize("seed", range(4))
def test_blind_and_af_of_one_seed_live_alike_until_one_judges_otherwise(
    seed, small, columns, trained
):
    settings = {"death": False, "variables": NEEDY}
    blind, af = (
        columns(live(Mind(**settings, **own), small, seed=seed, steps=STEPS, record="all"))
        for own in ({"agent": "BLIND"}, {"agent": "AF", "networks": trained})
    )
    parting = np.flatnonzero(af.happened("disregarded"))[0]
    told = [name for name in blind if not name.startswith("likelihood")]
    for name in told:
        assert np.array_equal(blind[name][:parting], af[name][:parting]), name
    same = ("x", "y", "heading", "hunger", "winning_drive", "site", "object")
    for name in same:
        assert blind[name][parting] == af[name][parting]
    assert (blind["behaviour"][parting], af["behaviour"][parting]) == ("approach", "leave")


@pytest.mark.parametrize("agent", ["BLIND", "AF", "LEARNING", "ORACLE", "RANDOM"])
def test_every_agent_starts_where_the_others_of_its_seed_do(agent, small, trained):
    networks = trained if agent == "AF" else None
    setting = bring_together(Mind(agent=agent, networks=networks), small)
    blind = bring_together(Mind(), small)
    lives = np.arange(50, dtype=np.uint64)
    states, others = setting.begin(9, lives)[0], blind.begin(9, lives)[0]
    for name in ("x", "y", "heading"):
        assert np.array_equal(states[name], others[name])
        assert len(set(states[name].tolist())) == 50
    assert np.abs(states["heading"]).max() <= np.pi
    if agent != "AF":
        assert np.array_equal(states["weights"], others["weights"])

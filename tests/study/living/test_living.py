"""Lives lived together: as if alone, and those that fail leave the others as they are."""

from __future__ import annotations

from threading import Event

import numpy as np
import pytest

from animat.life.life import live
from animat.life.lives import live_on, live_states
from animat.life.setting import LifeError, bring_together
from animat.mind.mind import Mind
from animat.study.living import living as module
from animat.study.living.living import EPISODES, Company, StoppedError
from animat.world.world import World

STEPS, SEED = 2_500, 3
LIVES = np.arange(12, dtype=np.uint64)

LAW = """
def law(value, low, high, rate, factor):
    if value < 0.4905:
        return (value - value) / (value - value)
    return low + (value - low) * factor
"""
RAISES, NO_NUMBER = 2, 3
"""Turning speeds at which the controller fails in one way or the other."""


@pytest.fixture
def failing(tmp_path, lost):
    """Return the setting of lives of which some fail in one way."""
    own = tmp_path / "own.py"
    own.write_text(lost)

    def setting(how=RAISES):
        return bring_together(Mind(wander=f"{own}:walk", turn_speed=how), World.abundant())

    return setting


@pytest.fixture
def law(tmp_path):
    """The setting of lives of which some come to what is no number by a law."""
    own = tmp_path / "law.py"
    own.write_text(LAW)
    variable = {"law": f"{own}:law", "kind": "deficit", "lethal": False}
    return bring_together(Mind(variables={"nutrition": variable}), World.abundant())


def company(**settings):
    mind = Mind(**settings)
    return Company(bring_together(mind, World.abundant()), SEED, STEPS)


def test_they_end_as_lives_that_are_simply_lived():
    own = company()
    watched = own.live(LIVES)
    plain = live_states(own.setting, SEED, LIVES, STEPS)
    assert watched.states.tobytes() == plain.tobytes()
    assert watched.errors == [None] * 12
    assert watched.curve is None
    assert watched.earlier == []


@pytest.mark.parametrize("every", [1, 700, 10_000])
def test_how_often_they_are_looked_at_does_not_matter(every, monkeypatch):
    steps = 90 if every == 1 else STEPS
    own = Company(bring_together(Mind(), World.abundant()), SEED, steps)
    plain = live_states(own.setting, SEED, LIVES, steps)
    monkeypatch.setattr(module, "LOOK_EVERY", every)
    assert own.live(LIVES).states.tobytes() == plain.tobytes()


@pytest.mark.parametrize("how", [RAISES, NO_NUMBER])
def test_one_that_fails_leaves_the_others_as_they_are(how, failing):
    setting = failing(how)
    watched = Company(setting, SEED, STEPS).live(LIVES)
    failed = [n for n in range(12) if watched.errors[n]]
    assert 2 < len(failed) < 10
    for n in range(12):
        if n not in failed:
            alone = live_states(setting, SEED, LIVES[n : n + 1], STEPS)
            assert watched.states[n].tobytes() == alone[0].tobytes()


def test_an_error_is_told_with_its_step(failing):
    setting = failing()
    for n, error in enumerate(Company(setting, SEED, STEPS).live(LIVES).errors):
        if error is None:
            continue
        told, _, step = error.rpartition(", in step ")
        assert told == "ValueError: lost"
        states, present = setting.begin(SEED, LIVES[n : n + 1])
        live_on(setting, SEED, LIVES[n : n + 1], states, present, int(step))
        with pytest.raises(ValueError, match="lost"):
            live_on(setting, SEED, LIVES[n : n + 1], states, present, int(step) + 1)


def test_what_is_no_number_is_told_since_its_first_step(failing, law):
    for setting, names in (
        (failing(NO_NUMBER), {"drive_sum"}),
        (law, {"values", "drives", "drive_sum"}),
    ):
        errors = Company(setting, SEED, STEPS).live(LIVES).errors
        assert any(errors)
        for n, error in enumerate(errors):
            if error is None:
                continue
            told, _, step = error.partition(" not finite since step ")
            assert set(told.split(", ")) == names
            states, present = setting.begin(SEED, LIVES[n : n + 1])
            live_on(setting, SEED, LIVES[n : n + 1], states, present, int(step))
            assert np.isfinite(states["drive_sum"]).all()
            live_on(setting, SEED, LIVES[n : n + 1], states, present, int(step) + 1)
            assert not np.isfinite(states["drive_sum"]).any()


def test_the_error_is_the_same_in_any_company_and_whenever_they_are_looked_at(failing, monkeypatch):
    setting = failing(NO_NUMBER)
    together = Company(setting, SEED, STEPS).live(LIVES).errors
    alone = [Company(setting, SEED, STEPS).live(LIVES[n : n + 1]).errors[0] for n in range(12)]
    assert together == alone
    monkeypatch.setattr(module, "LOOK_EVERY", 300)
    assert Company(setting, SEED, STEPS).live(LIVES).errors == together


def test_no_life_that_failed_counts_as_dead(failing):
    watched = Company(failing(NO_NUMBER), SEED, STEPS).live(LIVES)
    failed = np.array([error is not None for error in watched.errors])
    assert not watched.states["dead"][failed].any()
    assert watched.states["dead"][~failed].any()


def test_a_life_that_cannot_begin_has_an_error_too(monkeypatch):
    own = company()
    begin = type(own.setting).begin

    def begins(self, seed, lives, weights=None):
        if 5 in lives:
            raise LifeError("no room for 5")
        return begin(self, seed, lives, weights)

    monkeypatch.setattr(type(own.setting), "begin", begins)
    watched = own.live(LIVES)
    assert watched.errors == [None] * 5 + ["LifeError: no room for 5"] + [None] * 6
    assert len(watched.states) == 12


def test_a_curve_is_what_networks_say_after_each_episode():
    setting = bring_together(Mind(agent="LEARNING"), World.abundant())
    watched = Company(setting, SEED, STEPS, curve=True).live(LIVES[:2])
    assert watched.curve is not None
    assert watched.curve.shape == (2, EPISODES + 1, 3, 4)
    for n in range(2):
        for until in (1, 500, 1_000, STEPS):
            life = live(setting.mind, setting.world, seed=SEED, life=n, steps=until)
            for b, name in enumerate(setting.mind.behaviours):
                episode = life.summary[f"acts_{name}"]
                for t, kind in enumerate(setting.world.types):
                    said = life.networks.likelihoods(kind.features)[name]
                    assert watched.curve[n, episode, b, t] == pytest.approx(said, rel=1e-12)


def test_snapshots_are_states_before_the_end():
    own = Company(bring_together(Mind(death=False), World.abundant()), SEED, 25_000, back=12_000)
    watched = own.live(LIVES[:2])
    assert [states["step"].tolist() for states, _ in watched.earlier] == [
        [0, 0],
        [10_000, 10_000],
        [20_000, 20_000],
    ]
    states, present = watched.earlier[1]
    live_on(own.setting, SEED, LIVES[:2], states, present, 25_000)
    assert states.tobytes() == watched.states.tobytes()


def test_they_stop_when_they_are_told_to():
    stop = Event()
    own = Company(bring_together(Mind(), World.abundant()), SEED, STEPS, stop=stop)
    assert own.live(LIVES).errors == [None] * 12
    stop.set()
    with pytest.raises(StoppedError):
        own.live(LIVES)


def test_want_of_memory_is_no_fault_of_a_life(monkeypatch):
    def none_left(*_):
        raise MemoryError

    monkeypatch.setattr(module, "live_on", none_left)
    with pytest.raises(MemoryError):
        company().live(LIVES)

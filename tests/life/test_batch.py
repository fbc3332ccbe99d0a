"""Lives lived together: as if alone, and those that fail leave the others as they are."""

from __future__ import annotations

import re
from threading import Event

import numpy as np
import pytest

from animat.life import batch as module
from animat.life.batch import EPISODES, Batch, StoppedError, advance
from animat.life.failure import FailedLifeError
from animat.life.life import live
from animat.life.scenario import LifeError, Setting, bring_together
from animat.mind.mind import Mind
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


def batch(**settings):
    mind = Mind(**settings)
    return Batch(bring_together(mind, World.abundant()), SEED, STEPS)


def advanced(setting, lives, steps):
    """Return the states of lives that are simply advanced."""
    states, present = setting.begin(SEED, lives)
    advance(setting, SEED, lives, states, present, steps)
    return states


def test_they_end_as_lives_that_are_simply_advanced():
    own = batch()
    result = own.run(LIVES)
    plain = advanced(own.setting, LIVES, STEPS)
    assert result.states.tobytes() == plain.tobytes()
    assert result.errors == [None] * 12
    assert result.curve is None
    assert result.earlier == []


@pytest.mark.parametrize("every", [1, 700, 10_000])
def test_how_often_they_are_looked_at_does_not_matter(every, monkeypatch):
    steps = 90 if every == 1 else STEPS
    own = Batch(bring_together(Mind(), World.abundant()), SEED, steps)
    plain = advanced(own.setting, LIVES, steps)
    monkeypatch.setattr(module, "LOOK_EVERY", every)
    assert own.run(LIVES).states.tobytes() == plain.tobytes()


@pytest.mark.parametrize("how", [RAISES, NO_NUMBER])
def test_one_that_fails_leaves_the_others_as_they_are(how, failing):
    setting = failing(how)
    result = Batch(setting, SEED, STEPS).run(LIVES)
    failed = [n for n in range(12) if result.errors[n]]
    assert 2 < len(failed) < 10
    for n in range(12):
        if n not in failed:
            alone = advanced(setting, LIVES[n : n + 1], STEPS)
            assert result.states[n].tobytes() == alone[0].tobytes()


def test_an_error_is_told_with_its_step(failing):
    setting = failing()
    for n, error in enumerate(Batch(setting, SEED, STEPS).run(LIVES).errors):
        if error is None:
            continue
        told, _, step = error.rpartition(", in step ")
        assert told == "wander: walk raised ValueError: lost"
        states, present = setting.begin(SEED, LIVES[n : n + 1])
        advance(setting, SEED, LIVES[n : n + 1], states, present, int(step))
        with pytest.raises(ValueError, match="lost"):
            advance(setting, SEED, LIVES[n : n + 1], states, present, int(step) + 1)


def test_what_is_no_number_is_told_with_its_step(failing, law):
    for setting, told in (
        (failing(NO_NUMBER), "wander: walk returned (5, nan), the motors take -10 to 10"),
        (law, "law: law returned a value that is not finite"),
    ):
        errors = Batch(setting, SEED, STEPS).run(LIVES).errors
        assert any(errors)
        for n, error in enumerate(errors):
            if error is None:
                continue
            said, _, step = error.rpartition(", in step ")
            assert said == told
            assert not advanced(setting, LIVES[n : n + 1], int(step))["failure"][0]
            assert advanced(setting, LIVES[n : n + 1], int(step) + 1)["failure"][0]


@pytest.mark.parametrize(
    ("coefficient", "carried"), [(1.6e308, ["drive_sum"]), (1.632e308, ["drives", "drive_sum"])]
)
def test_a_number_that_built_in_functions_carry_to_infinity_is_told_since_its_step(
    coefficient, carried
):
    """Coefficients beyond all reason, as a study may try them.

    With the smaller one the sum of a drive is beyond all numbers before the drive itself is.
    """
    huge = {"a": dict.fromkeys(("nutrition", "stamina", "restlessness"), coefficient)}
    mind = Mind(drives={**dict(Mind().drives), "hunger": huge}, death=False)
    setting = bring_together(mind, World.abundant())
    errors = Batch(setting, SEED, STEPS).run(LIVES[:2]).errors
    for n, error in enumerate(errors):
        assert error is not None
        names, _, step = error.rpartition(" not finite since step ")
        assert names == ", ".join(carried)
        assert int(step) > 0
        before, after = (advanced(setting, LIVES[n : n + 1], int(step) + more) for more in (0, 1))
        for name in ("drives", "drive_sum"):
            assert np.isfinite(before[name]).all()
            assert np.isfinite(after[name]).all() == (name not in carried)
        with pytest.raises(FailedLifeError, match=re.escape(error)):
            live(mind, World.abundant(), seed=SEED, life=n, steps=STEPS)


def test_the_error_is_the_same_in_any_batch_and_whenever_they_are_looked_at(failing, monkeypatch):
    setting = failing(NO_NUMBER)
    together = Batch(setting, SEED, STEPS).run(LIVES).errors
    alone = [Batch(setting, SEED, STEPS).run(LIVES[n : n + 1]).errors[0] for n in range(12)]
    assert together == alone
    monkeypatch.setattr(module, "LOOK_EVERY", 300)
    assert Batch(setting, SEED, STEPS).run(LIVES).errors == together


def test_no_life_that_failed_counts_as_dead(failing):
    result = Batch(failing(NO_NUMBER), SEED, STEPS).run(LIVES)
    failed = np.array([error is not None for error in result.errors])
    assert not result.states["dead"][failed].any()
    assert result.states["dead"][~failed].any()


def test_a_life_that_cannot_begin_has_an_error_too(monkeypatch):
    own = batch()
    begin = type(own.setting).begin

    def begins(self, seed, lives, weights=None):
        if 5 in lives:
            raise LifeError("no room for 5")
        return begin(self, seed, lives, weights)

    monkeypatch.setattr(type(own.setting), "begin", begins)
    result = own.run(LIVES)
    assert result.errors == [None] * 5 + ["no room for 5"] + [None] * 6
    assert len(result.states) == 12


def test_a_curve_is_what_networks_say_after_each_episode():
    setting = bring_together(Mind(agent="LEARNING"), World.abundant())
    result = Batch(setting, SEED, STEPS, curve=True).run(LIVES[:2])
    assert result.curve is not None
    assert result.curve.shape == (2, EPISODES + 1, 3, 4)
    for n in range(2):
        for until in (1, 500, 1_000, STEPS):
            life = live(setting.mind, setting.world, seed=SEED, life=n, steps=until)
            for b, name in enumerate(setting.mind.behaviours):
                episode = life.summary[f"acts_{name}"]
                for t, kind in enumerate(setting.world.types):
                    said = life.networks.likelihoods(kind.features)[name]
                    assert result.curve[n, episode, b, t] == pytest.approx(said, rel=1e-12)


def test_snapshots_are_states_before_the_end():
    own = Batch(bring_together(Mind(death=False), World.abundant()), SEED, 25_000, back=12_000)
    result = own.run(LIVES[:2])
    assert [states["step"].tolist() for states, _ in result.earlier] == [
        [0, 0],
        [10_000, 10_000],
        [20_000, 20_000],
    ]
    states, present = result.earlier[1]
    advance(own.setting, SEED, LIVES[:2], states, present, 25_000)
    assert states.tobytes() == result.states.tobytes()


def test_they_stop_when_they_are_told_to():
    stop = Event()
    own = Batch(bring_together(Mind(), World.abundant()), SEED, STEPS, stop=stop)
    assert own.run(LIVES).errors == [None] * 12
    stop.set()
    with pytest.raises(StoppedError):
        own.run(LIVES)


def test_want_of_memory_is_no_fault_of_a_life(monkeypatch):
    def none_left(*_):
        raise MemoryError

    monkeypatch.setattr(Setting, "begin", none_left)
    with pytest.raises(MemoryError):
        batch().run(LIVES)

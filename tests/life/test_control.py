"""Whoever decides in the mind's place gets the simulator's own lives, and its acts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from animat.life.batch import advance
from animat.life.control import advance_to_choice, command, rebirth, take_choice
from animat.life.digest import digest
from animat.life.scenario import LifeError, Setting, bring_together
from animat.life.state import DISREGARDED, ENCOUNTERED, FAILED, REACHED, SUCCEEDED
from animat.mind.behaviours import ACT, WANDER
from animat.mind.mind import Mind
from animat.mind.selection import winner_take_all
from animat.world.world import World

SEED, STEPS = 3, 4_000
LIVES = np.arange(40, dtype=np.uint64)


@pytest.fixture(scope="module")
def world() -> World:
    return World.random({"TS": 2, "TL": 2, "CS": 2, "CL": 2}, seed=11)


def ends(setting: Setting, states, present) -> list[str]:
    return [digest(*each) for each in zip(states, present, strict=True)]


def chosen_outside(setting: Setting, choose, steps: int = STEPS):
    """Simulate lives up to `steps`, every behaviour chosen by a function of a state."""
    states, present = setting.begin(SEED, LIVES)
    here = setting, SEED, LIVES, states, present
    choices = 0
    while (due := advance_to_choice(*here, steps)).any():
        choices += due.sum()
        taken = [choose(states[n]) if due[n] else -9 for n in range(len(LIVES))]
        take_choice(*here, np.array(taken, np.int64), due)
        assert not due.any()
    return states, present, choices


@pytest.mark.parametrize("agent", ["BLIND", "LEARNING", "ORACLE"])
def test_winner_take_all_made_outside_gives_the_same_lives_to_the_bit(agent, world):
    setting = bring_together(Mind(agent=agent), world)
    serves = setting.mind_parameters.serves
    nothing = np.zeros(0)

    def outside(state) -> int:
        return winner_take_all(state.drives, nothing, serves, 0.0, nothing)

    states, present, choices = chosen_outside(setting, outside)
    inside, there = setting.begin(SEED, LIVES)
    advance(setting, SEED, LIVES, inside, there, STEPS)
    assert choices > len(LIVES)
    assert ends(setting, states, present) == ends(setting, inside, there)


def test_disregarding_all_is_never_to_act(world):
    setting = bring_together(Mind(), world)
    states, _, choices = chosen_outside(setting, lambda _: len(setting.mind.behaviours), 1_000)
    assert choices == states["disregarded"].sum() == states["encounters"].sum() > 0
    assert not states["acts"].any()
    last = states["event"] & DISREGARDED != 0
    assert (states["event"][last] & ENCOUNTERED != 0).all()


def test_a_choice_of_nothing_meets_the_object_again_in_the_next_step(world):
    setting = bring_together(Mind(), world)
    states, present = setting.begin(SEED, LIVES)
    here = setting, SEED, LIVES, states, present
    due = advance_to_choice(*here, STEPS)
    assert due.any()
    before = states["step"].copy()
    take_choice(*here, np.full(len(LIVES), -1), due.copy())
    assert (states["step"] - before == due).all()
    assert not states["encounters"].any()


def test_a_choice_that_is_no_behaviour_fails_its_life_only(world):
    setting = bring_together(Mind(), world)
    states, present = setting.begin(SEED, LIVES)
    here = setting, SEED, LIVES, states, present
    due = advance_to_choice(*here, STEPS)
    first = int(np.flatnonzero(due)[0])
    choices = np.full(len(LIVES), -1)
    choices[first] = 99
    take_choice(*here, choices, due)
    assert np.flatnonzero(states["failure"]).tolist() == [first]


def test_commands_are_driven_and_acts_begin_in_contact_and_end(world):
    """A robot that goes ahead, turns where it is blocked, and tries to act all the time."""
    setting = bring_together(Mind(death=False), world)
    states, present = setting.begin(SEED, LIVES)
    here = setting, SEED, LIVES, states, present
    motors = np.full((len(LIVES), 2), 5)
    acts = LIVES.astype(np.int64) % len(setting.mind.behaviours)
    duration = setting.mind.interaction_steps
    acting, turning = np.zeros(len(LIVES), int), np.zeros(len(LIVES), int)
    begun = 0
    for _ in range(STEPS):
        motors[:, 0] = np.where(turning > 0, -3, 5)
        motors[:, 1] = np.where(turning > 0, 3, 5)
        before = states.copy()
        command(*here, motors, acts)
        began = states["event"] & REACHED != 0
        begun += began.sum()
        assert (states["behaviour"][began] == acts[began]).all()
        acting[before["mode"] == ACT] += 1
        ended = states["event"] & (SUCCEEDED | FAILED) != 0
        assert (acting[ended] == duration - 1).all()
        acting[ended] = 0
        stands = (states["mode"] == ACT) | ended
        assert (states["left"] == np.where(stands, 0, motors[:, 0])).all()
        assert (states["x"][stands] == before["x"][stands]).all()
        turning = np.where(states["event"] & 64 != 0, 20, turning - 1)
    assert begun > 20
    assert states["acts"].sum() in (begun, *range(begun - len(LIVES), begun))
    assert states["successes"].sum() > 0
    assert (states["step"] == STEPS).all()


def test_without_acts_a_robot_that_stands_is_where_it_was(world):
    setting = bring_together(Mind(death=False), world)
    states, present = setting.begin(SEED, LIVES)
    before = states.copy()
    for _ in range(100):
        command(
            setting, SEED, LIVES, states, present,
            np.zeros((len(LIVES), 2), np.int64), np.full(len(LIVES), -1),
        )  # fmt: skip
    assert (states["x"] == before["x"]).all()
    assert (states["mode"] == WANDER).all()
    assert (states["values"] != before["values"]).any()


def test_rebirth_begins_the_lives_of_some_rows(world):
    setting = bring_together(Mind(agent="LEARNING"), world)
    states, present = setting.begin(SEED, LIVES)
    advance(setting, SEED, LIVES, states, present, 500)
    kept = states.copy()
    others = LIVES.copy()
    rows = np.array([3, 17])
    others[rows] = [100, 101]
    rebirth(setting, SEED, others, states, present, rows)
    fresh, _ = setting.begin(SEED, others[rows])
    assert states[rows].tobytes() == fresh.tobytes()
    rest = np.delete(np.arange(len(LIVES)), rows)
    assert states[rest].tobytes() == kept[rest].tobytes()


def wrong(life: tuple) -> Iterator[tuple]:
    """The arguments of a life, one of them as a kernel would misread it."""
    setting, seed, lives, states, present = life
    yield setting, -1, lives, states, present
    yield setting, "1", lives, states, present
    yield setting, seed, lives.astype(np.int64), states, present
    yield setting, seed, lives[:-1], states, present
    yield setting, seed, lives, states[:-1], present
    yield setting, seed, lives, states[::-1], present
    yield setting, seed, lives, states["x"].copy(), present
    yield setting, seed, lives, states, present[:, :-1]
    yield setting, seed, lives, states, present.astype(bool)
    yield setting, seed, lives, states, np.asfortranarray(present)
    yield setting, seed, list(lives), states, present
    yield None, seed, lives, states, present


def test_what_a_kernel_would_misread_is_refused(world):
    setting = bring_together(Mind(), world)
    life = setting, SEED, LIVES, *setting.begin(SEED, LIVES)
    before = life[3].copy()
    number = len(LIVES)
    due, whole = np.ones(number, np.uint8), np.zeros(number, np.int64)
    for given in wrong(life):
        for call in (
            lambda given=given: advance_to_choice(*given, 10),
            lambda given=given: take_choice(*given, whole, due),
            lambda given=given: command(*given, np.zeros((number, 2), np.int64), whole),
            lambda given=given: rebirth(*given, np.array([0])),
        ):
            with pytest.raises(LifeError):
                call()
    for bad in (np.array([-1]), np.array([number]), np.array([0.0]), [0]):
        with pytest.raises(LifeError, match="rows: must be"):
            rebirth(*life, bad)
    for bad in (due.astype(bool), due[1:], whole, None):
        with pytest.raises(LifeError, match="due: must be"):
            take_choice(*life, whole, bad)
    for bad in (whole.astype(np.int32), whole[1:], whole.astype(float), [0] * number):
        with pytest.raises(LifeError, match="choices: must be"):
            take_choice(*life, bad, due)
        with pytest.raises(LifeError, match="acts: must be"):
            command(*life, np.zeros((number, 2), np.int64), bad)
    with pytest.raises(LifeError, match="motors: must be"):
        command(*life, np.zeros((2, number), np.int64).T, whole)
    assert life[3].tobytes() == before.tobytes()


def test_a_step_that_waits_for_a_choice_is_not_begun_again(world):
    setting = bring_together(Mind(), world)
    here = setting, SEED, LIVES, *setting.begin(SEED, LIVES)
    due = advance_to_choice(*here, STEPS)
    some = due.copy()
    some[int(np.flatnonzero(due)[-1])] = 0
    take_choice(*here, np.zeros(len(LIVES), np.int64), some)
    for call in (
        lambda: advance_to_choice(*here, STEPS),
        lambda: command(*here, np.zeros((len(LIVES), 2), np.int64), np.full(len(LIVES), -1)),
    ):
        with pytest.raises(LifeError, match=r"states: row \d+ waits for its choice"):
            call()

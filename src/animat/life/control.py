"""Deciding in the mind's place, from Python: which behaviour, or the motor commands themselves.

    due = advance_to_choice(setting, seed, lives, states, present, until)
    take_choice(setting, seed, lives, states, present, choices, due)

simulates L lives, and stops inside the step in which a life has met an object and a behaviour has
to be chosen; what is chosen from `states["drives"]` and `states["estimates"]` as the mind would
have chosen it leads to the same life, to the last bit. `command` takes the motor commands of one
step; encounters and acts stay those of the simulator. `rebirth` begins other lives in some rows.

States and present objects are those of `Setting.begin`, and are changed in place.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from animat.life import kernels
from animat.life.scenario import Setting
from animat.numerics.layout import raw


def advance_to_choice(
    setting: Setting,
    seed: int,
    lives: NDArray[np.uint64],
    states: NDArray[np.void],
    present: NDArray[np.uint8],
    until: int,
) -> NDArray[np.uint8]:
    """Advance L lives until a choice is due, or each has `until` steps or is dead.

    Returns `due` [L], 1 for a life that waits for its choice and 0 for one that has ended.
    """
    due = np.zeros(len(lives), np.uint8)
    call = kernels.advance_to_choice.of(setting.counts, setting.functions)
    call(raw(states), present, lives, *setting.constants, seed, until, due)
    return due


def take_choice(
    setting: Setting,
    seed: int,
    lives: NDArray[np.uint64],
    states: NDArray[np.void],
    present: NDArray[np.uint8],
    choices: NDArray[np.int64],
    due: NDArray[np.uint8],
) -> None:
    """End the step of those lives that are `due` [L], with the behaviours chosen: `choices` [L].

    A choice of B disregards the object, and -1 goes on as if none had been met; any other that is
    no behaviour fails the life, as one of a custom selector does.
    """
    call = kernels.take_choice.of(setting.counts, setting.functions)
    call(raw(states), present, lives, *setting.constants, seed, choices, due)


def command(
    setting: Setting,
    seed: int,
    lives: NDArray[np.uint64],
    states: NDArray[np.void],
    present: NDArray[np.uint8],
    motors: NDArray[np.int64],
    acts: NDArray[np.int64],
) -> None:
    """Advance L lives by one step with the motor commands `motors` [L, 2], in motor units.

    `acts` [L] are behaviours to begin where an object is in contact and faced, -1 for none. While
    an act is under way the robot stands, whatever it is told.
    """
    call = kernels.command.of(setting.counts, setting.functions)
    call(raw(states), present, lives, *setting.constants, seed, motors, acts)


def rebirth(
    setting: Setting,
    seed: int,
    lives: NDArray[np.uint64],
    states: NDArray[np.void],
    present: NDArray[np.uint8],
    rows: NDArray[np.int64],
) -> None:
    """Begin the lives `lives` [L] anew in the given rows, and leave the others as they are.

    Raises LifeError where the world has no room to start.
    """
    born, there = setting.begin(seed, lives[rows])
    states[rows], present[rows] = born, there

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

from typing import Any

import numpy as np
from numpy.typing import NDArray

from animat.files.arguments import MOST_63, MOST_64, instance, whole
from animat.life import kernels
from animat.life.scenario import LifeError, Setting
from animat.life.state import NO_SITE, state_dtype
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

    Returns `due` [L], 1 for a life that waits for its choice and 0 for one that has ended. Raises
    LifeError for what is not as described.
    """
    seed = _checked(setting, seed, lives, states, present)
    until = whole("until", until, 0, MOST_63, LifeError)
    _none_waits(states)
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
    no behaviour fails the life, as one of a custom selector does. Raises LifeError for arrays that
    are not as described.
    """
    seed = _checked(setting, seed, lives, states, present)
    _array("choices", choices, np.int64, (len(lives),))
    _array("due", due, np.uint8, (len(lives),))
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
    an act is under way the robot stands, whatever it is told. Commands beyond what the motors take
    are cut to that. Raises LifeError for arrays that are not as described.
    """
    seed = _checked(setting, seed, lives, states, present)
    _none_waits(states)
    _array("motors", motors, np.int64, (len(lives), 2))
    _array("acts", acts, np.int64, (len(lives),))
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

    Raises LifeError where the world has no room to start, and for arrays that are not as described.
    """
    seed = _checked(setting, seed, lives, states, present)
    _array("rows", rows, np.int64, None)
    if len(rows) and not 0 <= int(rows.min()) <= int(rows.max()) < len(lives):
        raise LifeError(f"rows: must be 0 to {len(lives) - 1}")
    born, there = setting.begin(seed, lives[rows])
    states[rows], present[rows] = born, there


def _checked(
    setting: Setting,
    seed: int,
    lives: NDArray[np.uint64],
    states: NDArray[np.void],
    present: NDArray[np.uint8],
) -> int:
    """Return the seed. Raises LifeError for what a kernel would misread: it checks nothing."""
    instance("setting", setting, Setting, LifeError)
    _array("lives", lives, np.uint64, None)
    number = len(lives)
    _array("states", states, state_dtype(setting.counts), (number,))
    _array("present", present, np.uint8, (number, max(1, setting.world.n_sites)))
    return whole("seed", seed, 0, MOST_64, LifeError)


def _none_waits(states: NDArray[np.void]) -> None:
    """Raise LifeError where a life is inside a step, which would be simulated twice."""
    waiting = np.flatnonzero((states["met"] != NO_SITE) & ~states["dead"])
    if len(waiting):
        raise LifeError(f"states: row {waiting[0]} waits for its choice; take_choice comes first")


def _array(name: str, value: Any, dtype: Any, shape: tuple[int, ...] | None) -> None:
    good = isinstance(value, np.ndarray) and value.dtype == dtype and value.flags.c_contiguous
    if good and (value.ndim == 1 if shape is None else value.shape == shape):
        return
    fields = np.dtype(dtype).names
    said = f"of {np.dtype(dtype)}" if fields is None else "of states of this setting"
    length = "" if shape is None else f" and of shape {list(shape)}"
    raise LifeError(f"{name}: must be a contiguous NumPy array {said}{length}")

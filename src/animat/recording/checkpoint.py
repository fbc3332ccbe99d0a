"""A moment of a life as it is kept in a file: bytes and a digest."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from animat.life.digest import SCRATCH, digest
from animat.life.life import Moment, birth
from animat.life.scenario import LifeError, Setting

Fields = tuple[tuple[str, str, tuple[int, ...]], ...]
"""Name, type and shape of each field that is kept, in the order of their bytes."""


class Kept(NamedTuple):
    """The fields of a state one after another, which sites hold an object, and their digest."""

    state: bytes
    present: bytes
    digest: str


def fields_of(state: np.dtype) -> Fields:
    """Return what is kept of states of a layout: all but what holds nothing from step to step."""
    return tuple(
        (name, state[name].base.newbyteorder("<").str, state[name].shape)
        for name in state.names or ()
        if name not in SCRATCH
    )


def check_fields(fields: Fields, state: np.dtype) -> None:
    """Refuse fields that are not those of states of a layout, in any order. Raises LifeError."""
    if unlike := set(fields) ^ set(fields_of(state)):
        others = ", ".join(sorted({name for name, *_ in unlike}))
        raise LifeError(f"its states are not those of this animat: they differ in {others}")


def keep(moment: Moment, fields: Fields) -> Kept:
    """Return a moment as it is kept."""
    state = np.zeros(1, np.dtype(list(fields)))
    for name, *_ in fields:
        state[name] = moment.states[name]
    return Kept(state.tobytes(), moment.present[0].tobytes(), moment.digest)


def opened(kept: Kept, fields: Fields) -> tuple[NDArray[np.void], NDArray[np.uint8]]:
    """Return the fields [1] of a state and the present objects [S]. Raises LifeError."""
    layout = np.dtype(list(fields))
    if len(kept.state) != layout.itemsize:
        raise LifeError(f"a state has {layout.itemsize} bytes, this one {len(kept.state)}")
    return np.frombuffer(kept.state, layout), np.frombuffer(kept.present, np.uint8)


def restored(kept: Kept, fields: Fields, setting: Setting, seed: int, index: int) -> Moment:
    """Return the moment that was kept.

    Raises LifeError where it is no moment of such a life, or does not fit its digest.
    """
    moment = birth(setting, seed, index)
    check_fields(fields, moment.states.dtype)
    state, present = opened(kept, fields)
    if len(present) != moment.present.shape[1]:
        raise LifeError(
            f"it tells of {len(present)} sites, its world has {moment.present.shape[1]}"
        )
    for name in state.dtype.names or ():
        moment.states[name] = state[name]
    moment.present[0] = present
    if digest(moment.state, moment.present[0]) != kept.digest:
        raise LifeError(f"the state kept before step {moment.step} does not fit its digest")
    return moment

"""The state of a life: one record that holds everything that changes as it is lived.

A life is a pure function of its settings, seed and index; its state after any step is this record
and, beside it, which sites hold an object (`present` [S]). Written down, it can be gone on from;
hashed, it can be compared.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import types

from animat.numerics.layout import Field, Layout

ABANDONED = 8
"""How many objects at once a robot remembers having left and not yet lost sight of."""

NO_SITE = -1

ENCOUNTERED, REACHED, SUCCEEDED, FAILED, DISREGARDED, UNREACHED, BLOCKED, TRAINED, DIED = (
    1 << bit for bit in range(9)
)
"""What happened in a step, as bits of `event`."""

EVENTS = (
    "encounter",
    "reached",
    "success",
    "failure",
    "disregarded",
    "unreached",
    "blocked",
    "trained",
    "death",
)
"""The names of the bits of `event`, the lowest first."""

LOW, HIGH = range(2)


REAL, WHOLE = np.float64, np.int64

STATE = Layout(
    "state",
    (
        # body
        Field("x", REAL),  # mm
        Field("y", REAL),  # mm
        Field("heading", REAL),  # rad
        Field("left", WHOLE),  # motor commands of this step
        Field("right", WHOLE),
        Field("readings", WHOLE, ("N",)),  # infrared, this step
        # needs
        Field("values", REAL, ("V",)),
        Field("previous", REAL, ("V",)),  # at the last step's drives
        Field("changes", REAL, ("V",)),  # since then
        Field("drives", REAL, ("D",)),
        # what it is doing
        Field("mode", WHOLE),
        Field("mode_steps", WHOLE),
        Field("behaviour", WHOLE),
        Field("site", WHOLE),
        Field("met", WHOLE),  # the object met, until a behaviour is chosen
        Field("abandoned", WHOLE, (ABANDONED,)),
        Field("memory", REAL, (4,)),  # of the wander controller
        Field("choice_memory", REAL, (4,)),  # of the selector
        # what it knows
        Field("features", REAL, ("F",)),  # of the object met, as perceived
        Field("estimates", REAL, ("B",)),  # of the object met
        Field("likelihoods", REAL, ("B",)),  # when last chosen; not a number before
        Field("weights", REAL, ("B", "W")),
        # this step
        Field("reward", WHOLE),
        Field("event", WHOLE),
        # the life so far
        Field("step", WHOLE),  # steps lived
        Field("dead", np.bool_),
        Field("death_variable", WHOLE),
        Field("death_side", WHOLE),
        Field("death_cause", WHOLE),
        Field("encounters", WHOLE),
        Field("acts", WHOLE),
        Field("successes", WHOLE),
        Field("disregarded", WHOLE),
        Field("unreached", WHOLE),
        Field("blocked", WHOLE),
        Field("trainings", WHOLE),
        Field("drive_sum", REAL),  # over the steps, of the mean of the drives
        Field("acts_by_behaviour", WHOLE, ("B",)),
        Field("successes_by_behaviour", WHOLE, ("B",)),
        # room to work in; holds nothing from one step to the next
        Field("hidden", REAL, ("H",)),
        Field("values_after", REAL, ("V",)),
        Field("drives_after", REAL, ("D",)),
        Field("changes_after", REAL, ("V",)),
        # of custom functions: see animat.life.failure
        Field("asked", WHOLE),  # the role that was called last
        Field("failure", WHOLE),  # the role that ended the life
        Field("given", REAL, (2,)),  # what it gave
    ),
)
"""A state: V variables, D drives, B behaviours, N sensors; F features, H hidden units, W weights a
network."""

state_at = STATE.at

INDICES = types.Array(types.uint64, 1, "C")
PRESENT = types.Array(types.uint8, 2, "C")
"""What a kernel is given beside states [L]: the indices of the lives [L], and which sites hold an
object [L, S]."""


class Counts(NamedTuple):
    """What the shapes of the records of lives are made of.

    V variables, D drives, B behaviours, N sensors; F features, H hidden units and W weights of a
    network.
    """

    V: int
    D: int
    B: int
    N: int
    F: int
    H: int
    W: int


@cache
def state_dtype(counts: Counts) -> np.dtype:
    """Return NumPy's type of the states of these counts, the same object each time."""
    return STATE.dtype(counts._asdict())

"""The state of a life: one record that holds everything that changes as it is lived.

A life is a pure function of its settings, seed and index; its state after any step is this record
and, beside it, which sites hold an object (`present` [S]). Written down, it can be gone on from;
hashed, it can be compared.
"""

from __future__ import annotations

import numpy as np

from animat.robot.khepera import SENSORS

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


def state_dtype(
    variables: int, drives: int, behaviours: int, features: int, hidden: int, weights: int
) -> np.dtype:
    """Return the layout of a state.

    V variables, D drives, B behaviours, F features, H hidden units and W weights a network.
    """
    real, whole = np.float64, np.int64
    return np.dtype(
        (
            np.record,
            [
                # body
                ("x", real),  # mm
                ("y", real),  # mm
                ("heading", real),  # rad
                ("left", whole),  # motor commands of this step
                ("right", whole),
                ("readings", whole, (SENSORS,)),  # infrared, this step
                # needs
                ("values", real, (variables,)),
                ("previous", real, (variables,)),  # at the last step's drives
                ("changes", real, (variables,)),  # since then
                ("drives", real, (drives,)),
                # what it is doing
                ("mode", whole),
                ("mode_steps", whole),
                ("behaviour", whole),
                ("site", whole),
                ("abandoned", whole, (ABANDONED,)),
                ("memory", real, (4,)),  # of the wander controller
                # what it knows
                ("features", real, (features,)),  # of the object met, as perceived
                ("estimates", real, (behaviours,)),  # of the object met
                ("likelihoods", real, (behaviours,)),  # when last chosen; not a number before
                ("weights", real, (behaviours, weights)),
                # this step
                ("reward", whole),
                ("event", whole),
                # the life so far
                ("step", whole),  # steps lived
                ("dead", np.bool_),
                ("death_variable", whole),
                ("death_side", whole),
                ("death_cause", whole),
                ("encounters", whole),
                ("acts", whole),
                ("successes", whole),
                ("disregarded", whole),
                ("unreached", whole),
                ("blocked", whole),
                ("trainings", whole),
                ("drive_sum", real),  # over the steps, of the mean of the drives
                ("acts_by_behaviour", whole, (behaviours,)),
                ("successes_by_behaviour", whole, (behaviours,)),
                # room to work in; holds nothing from one step to the next
                ("hidden", real, (hidden,)),
                ("aftermath", real, (variables,)),
                ("drives_after", real, (drives,)),
                ("changes_after", real, (variables,)),
                # of custom functions: see animat.life.failure
                ("asked", whole),  # the role that was called last
                ("failure", whole),  # the role that ended the life
                ("given", real, (2,)),  # what it gave
            ],
        ),
        align=True,
    )

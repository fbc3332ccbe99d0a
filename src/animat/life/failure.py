"""How a life fails: a custom function raises, or gives what no life can go on with."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from animat.life.scenario import LifeError, Setting
from animat.mind.functions import Functions
from animat.numerics.compiled import compiled
from animat.numerics.slots import any_custom

LAW, DRIVES, SELECTOR, ESTIMATOR, LEARNER, WANDER = range(1, 7)
"""The roles of custom functions as `asked` and `failure` of a state know them; 0 is none."""

CARRIED = (
    *("x", "y", "heading"),
    *("values", "drives", "drive_sum"),
    *("estimates", "weights"),
)
"""What of a state must be finite. The memory of a wander controller is its own affair, and the
likelihoods are estimates, not a number before they were asked."""


class FailedLifeError(LifeError):
    """A life failed: a custom function raised, or a number is not finite any more."""


@compiled
def asks(state, role):
    """Note that the function of a role is called next, should it raise; built-in ones cannot."""
    if any_custom():
        state.asked = role


@compiled
def fail(state, role, one, other):
    """End a life in which the custom function of a role gave `one` and `other`, or did nothing."""
    if state.failure == 0:
        state.failure = role
        state.given[0] = one
        state.given[1] = other
    state.dead = True


def failure_of(setting: Setting, state: np.record) -> str | None:
    """Return why the life failed in its last step, on one line; None if it did not."""
    if not state.failure:
        return None
    one, other = state.given
    limit = int(setting.robot_parameters.max_motor)
    last = len(setting.mind.behaviours) - 1
    what = {
        LAW: "returned a value that is not finite",
        DRIVES: "left a drive that is not finite",
        SELECTOR: f"returned {one:.0f}, allowed are -1 (none) and 0 to {last}",
        ESTIMATOR: "returned a likelihood that is not finite",
        LEARNER: "left a weight that is not finite",
        WANDER: f"returned ({one:g}, {other:g}), the motors take -{limit} to {limit}",
    }[int(state.failure)]
    return f"{_function(setting, int(state.failure))} {what}, in step {int(state.step) - 1}"


def raised(setting: Setting, state: np.record, error: Exception) -> str:
    """Return what the custom function that was called last raised, on one line."""
    told = " ".join(f"{type(error).__name__}: {error}".split()).removesuffix(":")
    if state.asked:
        told = f"{_function(setting, int(state.asked))} raised {told}"
    return f"{told}, in step {int(state.step)}"


def unknown(setting: Setting, state: np.record) -> str:
    """Return that what networks say of objects not met either cannot be had, on one line."""
    what = "raised or returned a likelihood that is not finite, asked of all object types"
    return f"{_function(setting, ESTIMATOR)} {what} after step {int(state.step) - 1}"


def _function(setting: Setting, role: int) -> str:
    name = Functions._fields[role - 1]
    return f"{name}: {getattr(setting.functions, name).__name__}"


def not_finite(states: NDArray[np.void]) -> NDArray[np.bool_]:
    """Tell which of L lives carry a number that is not finite."""
    found = np.zeros(len(states), bool)
    for name in CARRIED:
        # A sum costs a fraction of a look at each, and is not finite if one of them is not.
        with np.errstate(over="ignore", invalid="ignore"):
            total = np.add.reduce(states[name], axis=None)
        if not math.isfinite(total):
            finite = np.isfinite(states[name])
            found |= ~finite.all(axis=tuple(range(1, finite.ndim)))
    return found


def carried_not_finite(states: NDArray[np.void]) -> str:
    """Return which fields of a life hold what is not finite."""
    return ", ".join(name for name in CARRIED if not np.isfinite(states[name]).all())

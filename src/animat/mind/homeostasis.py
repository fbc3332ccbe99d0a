"""Homeostatic variables: how they drift by themselves, and how an act moves them.

A variable V lives in its viability zone [low, high] and follows a law, once per step. A law is a
function `law(value, low, high, rate, factor) -> value`, where `rate` is per step and `factor` is
exp(-rate), made beforehand so that no step needs an exponential. The laws solve the equations of
the paper exactly over a step; there is no Euler error to grow over a life.

Equation 1 of the paper is printed as growth and equation 2 as its decay; both are laws here.
"""

from __future__ import annotations

import math
from typing import Any

from animat.numerics.compiled import compiled

DECAY, RELAX, GROWTH, LINEAR_FALL, LINEAR_RISE, CUSTOM_LAW = range(6)

LAWS: dict[Any, int] = {
    "decay": DECAY,
    "relax": RELAX,
    "growth": GROWTH,
    "linear": LINEAR_FALL,
}
"""The code of each built-in law, by its name; `linear` falls or rises with the kind."""

ALIVE, METABOLISM, SUCCESS, FAILURE = range(4)
"""What took a variable out of its viability zone."""


@compiled
def decay(value, low, high, rate, factor):
    """Fall towards `low` and never reach it (equation 2, from any start)."""
    return low + (value - low) * factor


@compiled
def relax(value, low, high, rate, factor):
    """Rise towards `high` and never reach it."""
    return high - (high - value) * factor


@compiled
def growth(value, low, high, rate, factor):
    """Rise away from `low`, past `high` in finite time (equation 1 as printed)."""
    return low + (value - low) / factor


@compiled
def linear_fall(value, low, high, rate, factor):
    """Fall by the same amount each step."""
    return value - rate * (high - low)


@compiled
def linear_rise(value, low, high, rate, factor):
    """Rise by the same amount each step."""
    return value + rate * (high - low)


@compiled
def obey(law, value, low, high, rate, factor, custom):
    """Apply the law of the given code; `custom` is the user's own function.

    What a custom law returns is not a number where it is not finite: no bound holds that back.
    """
    if law == DECAY:
        return decay(value, low, high, rate, factor)
    if law == GROWTH:
        return growth(value, low, high, rate, factor)
    if law == RELAX:
        return relax(value, low, high, rate, factor)
    if law == LINEAR_FALL:
        return linear_fall(value, low, high, rate, factor)
    if law == LINEAR_RISE:
        return linear_rise(value, low, high, rate, factor)
    value = custom(value, low, high, rate, factor)
    return value if math.isfinite(value) else math.nan


@compiled
def metabolise(values, mind, custom):
    """Let every variable [V] follow its law for one step, in place."""
    for v in range(len(values)):
        value = obey(
            mind.law[v],
            values[v],
            mind.low[v],
            mind.high[v],
            mind.rate[v],
            mind.factor[v],
            custom,
        )
        values[v] = min(max(value, mind.drift_floor[v]), mind.drift_ceiling[v])


@compiled
def settle(values, values_after, mind):
    """Take over the values [V] an act leads to, `values_after` [V], held back at the bounds.

    How far an act may carry a variable is a setting of each side: `overflow` for the satisfied
    side, `failed_act` for the other.
    """
    for v in range(len(values)):
        values[v] = min(max(values_after[v], mind.act_floor[v]), mind.act_ceiling[v])


@compiled
def first_outside(values, mind):
    """Return the first variable outside its viability zone, or -1."""
    for v in range(len(values)):
        if values[v] < mind.dies_below[v] or values[v] > mind.dies_above[v]:
            return v
    return -1

"""Selection of behaviour: which behaviour the drives call for when an object is met.

A selector has the signature `select(drives, likelihoods, serves, u, memory) -> behaviour`: `drives`
[D]; `likelihoods` [B], what the mind believes of the object met; `serves` [B], the drive each
behaviour serves; `u`, a uniform in [0, 1) of this step; `memory` [4], the selector's own, zero at
birth. It returns the index of a behaviour, or -1 for none. Any other number fails the life.
"""

from __future__ import annotations

from typing import Any

from animat.mind.drives import strongest
from animat.numerics.compiled import compiled

WINNER_TAKE_ALL, AFFORDANCE_TIMES_DRIVE, RANDOM, CUSTOM_SELECTOR = range(4)

SELECTORS: dict[Any, int] = {
    "winner_take_all": WINNER_TAKE_ALL,
    "affordance_times_drive": AFFORDANCE_TIMES_DRIVE,
    "random": RANDOM,
}
"""The code of each built-in selector, by its name."""


@compiled
def winner_take_all(drives, likelihoods, serves, u, memory):
    """Return the first behaviour that serves the strongest drive (the paper's arbitration)."""
    winner = strongest(drives)
    for behaviour in range(len(serves)):
        if serves[behaviour] == winner:
            return behaviour
    return -1


@compiled
def affordance_times_drive(drives, likelihoods, serves, u, memory):
    """Return the behaviour with the largest product of drive and likelihood (2010)."""
    best = 0
    for behaviour in range(1, len(serves)):
        if (
            drives[serves[behaviour]] * likelihoods[behaviour]
            > drives[serves[best]] * likelihoods[best]
        ):
            best = behaviour
    return best


@compiled
def random(drives, likelihoods, serves, u, memory):
    """Return any behaviour, each equally likely."""
    return int(u * len(serves))


@compiled
def select(selector, drives, likelihoods, serves, u, memory, custom):
    """Choose by the selector of the given code; `custom` is the user's own function."""
    if selector == WINNER_TAKE_ALL:
        return winner_take_all(drives, likelihoods, serves, u, memory)
    if selector == AFFORDANCE_TIMES_DRIVE:
        return affordance_times_drive(drives, likelihoods, serves, u, memory)
    if selector == RANDOM:
        return random(drives, likelihoods, serves, u, memory)
    return custom(drives, likelihoods, serves, u, memory)

"""The smallest sets of readings with which a claim holds nearly everywhere.

A set says of some readings which values they may have; the others are free. It is found in one
sample of universes, where it may owe its share to chance, and confirmed in another.
"""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.claims import Verdict, above
from animat.statistics.estimates import LEVEL, Estimate, share
from animat.statistics.lives import column
from animat.statistics.readings import MOST_UNIVERSES, Readings, codes, some_of
from animat.statistics.universes import holds

NEARLY_ALL = 0.95
"""The share of universes in which a claim is to hold."""

MOST_READINGS = 5
"""How many readings a set fixes at most; with more, too few universes are left to judge by."""

SURELY = 0.85
"""What the share is to exceed even if the set, the best of so many, owes it to chance."""

SUPPORT = 40
"""Universes that must be left, however few sets there are."""

BEAM = 5_000
"""Sets of each size that are extended; every pair and triple of usual designs is tried."""


class Condition(NamedTuple):
    """A reading and the values it may have."""

    reading: str
    values: tuple[str, ...]


class SufficientSet(NamedTuple):
    """A set of conditions, and in what share of so many universes that meet it the claim holds."""

    claim: str
    conditions: tuple[Condition, ...]
    universes: int
    share: Estimate


class Confirmation(NamedTuple):
    """What fresh universes say of a set; the verdict is on a share above `NEARLY_ALL`."""

    found: SufficientSet
    universes: int
    share: Estimate
    verdict: Verdict


def sufficient_set(universes: pa.Table, readings: Readings, claim: str) -> SufficientSet | None:
    """The set of fewest conditions with which `claim` holds in `NEARLY_ALL` universes.

    With the best of very many sets that may be chance. So its share must also exceed `SURELY` by a
    test that counts all sets of its size (Bonferroni). Of several of one size the one whose share
    is surest: Wilson's interval begins highest. None if no set of `MOST_READINGS` or fewer does it.
    """
    universes = some_of(universes, MOST_UNIVERSES)
    good_in = holds(universes, claim)
    if _enough(good_in.sum(), np.array(len(good_in)), 1):
        return SufficientSet(claim, (), len(good_in), share(int(good_in.sum()), len(good_in)))
    conditions, met, of = _literals(codes(universes, readings), readings)
    tried = _sets_of_each_size(of)
    sets = np.arange(len(conditions))[:, None]
    for size in range(1, min(MOST_READINGS, len(readings)) + 1):
        masks = np.all(met[sets], axis=1)
        total = masks.sum(axis=1)
        enough = total >= SUPPORT
        sets, masks, total = sets[enough], masks[enough], total[enough]
        if not len(sets):
            return None
        good = (masks & good_in).sum(axis=1)
        enough = _enough(good, total, tried[size])
        if np.any(enough):
            return _surest(claim, conditions, sets[enough], good[enough], total[enough])
        best = np.lexsort((-total, -good / total))[:BEAM]
        if size < min(MOST_READINGS, len(readings)):
            sets = _extended(sets[best], masks[best], met, of, good_in)
    return None


def confirm(found: SufficientSet, universes: pa.Table) -> Confirmation:
    """Judge a set by universes that meet it and that it was not found in."""
    meets = np.ones(universes.num_rows, dtype=bool)
    for reading, values in found.conditions:
        meets &= np.isin(column(universes, reading).astype(str), values)
    good_in = holds(universes, found.claim)[meets]
    estimate = share(int(good_in.sum()), len(good_in))
    return Confirmation(found, len(good_in), estimate, above(estimate, NEARLY_ALL))


def _enough(good: NDArray, total: NDArray, tried: float) -> NDArray[np.bool_]:
    """Whether a claim that holds in `good` [K] of `total` universes does so nearly everywhere.

    `tried` is how many sets it might have been the best of.
    """
    chance = tried * stats.binom.sf(good - 1, total, SURELY)
    return (total >= SUPPORT) & (good >= NEARLY_ALL * total) & (chance <= 1.0 - LEVEL)


def _sets_of_each_size(of: NDArray[np.int64]) -> list[float]:
    """How many sets there are of each size, from none on: a condition each on so many readings.

    `of` [L] is the reading of each condition. They are the coefficients of a product of (1 + n x).
    """
    sets = np.ones(1)
    for conditions in np.bincount(of):
        sets = np.convolve(sets, [1.0, conditions])
    return sets.tolist()


def _literals(
    code: NDArray[np.int64], readings: Readings
) -> tuple[list[Condition], NDArray[np.bool_], NDArray[np.int64]]:
    """Every condition on one reading, the universes that meet it [L, U], and its reading [L]."""
    conditions, met, of = [], [], []
    for place, (name, values) in enumerate(readings.items()):
        for size in range(len(values) - 1, 0, -1):
            for chosen in combinations(range(len(values)), size):
                conditions.append(Condition(name, tuple(values[c] for c in chosen)))
                met.append(np.isin(code[:, place], chosen))
                of.append(place)
    return conditions, np.array(met), np.array(of)


def _extended(
    sets: NDArray[np.int64],
    masks: NDArray[np.bool_],
    met: NDArray[np.bool_],
    of: NDArray[np.int64],
    good_in: NDArray[np.bool_],
) -> NDArray[np.int64]:
    """The best sets [K, size + 1] that have one condition more, on a reading not yet used."""
    # float32 counts universes exactly up to 16 million, and multiplies fast.
    every = met.T.astype(np.float32)
    total = masks.astype(np.float32) @ every
    good = (masks & good_in).astype(np.float32) @ every
    used = (of[sets][:, :, None] == of).any(axis=1)
    total[used] = 0.0
    row, literal = np.nonzero(total >= SUPPORT)
    order = np.lexsort((-total[row, literal], -(good / np.maximum(total, 1.0))[row, literal]))
    # A set comes once for each of its conditions, so twice the beam and more is looked at.
    order = order[: BEAM * (sets.shape[1] + 1)]
    longer = np.sort(np.column_stack([sets[row[order]], literal[order]]), axis=1)
    _, first = np.unique(longer, axis=0, return_index=True)
    return longer[np.sort(first)[:BEAM]]


def _surest(
    claim: str,
    conditions: list[Condition],
    sets: NDArray[np.int64],
    good: NDArray[np.int64],
    total: NDArray[np.int64],
) -> SufficientSet:
    estimates = [share(int(g), int(t)) for g, t in zip(good, total, strict=True)]
    k = max(range(len(estimates)), key=lambda k: (estimates[k].low, -k))
    chosen = tuple(conditions[c] for c in sets[k])
    return SufficientSet(claim, chosen, int(total[k]), estimates[k])

"""Tests of lifespans: the stratified log-rank test, and Hotelling's of several means.

`scipy.stats.logrank` compares two groups without strata; with those it agrees. Stratified, lives
are compared only with lives of the same combination, so that what the other factors do drops out.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats


class Significance(NamedTuple):
    """What a test gave: its name, its statistic, its degrees of freedom (0: it has none), and p."""

    name: str
    statistic: float
    freedom: int
    p: float


def stratified_logrank(
    steps: NDArray[np.float64],
    died: NDArray[np.bool_],
    group: NDArray[np.int64],
    stratum: NDArray[np.int64],
) -> Significance:
    """Do the groups of n lives end alike within each stratum? All arrays are [n].

    `steps` is how long a life was watched, `died` whether it ended then. Where no death can tell
    groups apart, the statistic is 0 and p is 1.
    """
    name = "stratified log-rank" if len(np.unique(stratum)) > 1 else "log-rank"
    groups = np.unique(group)
    order = np.lexsort((steps, stratum))
    steps, died, stratum = steps[order], died[order], stratum[order]
    member = (group[order][:, None] == groups).astype(np.float64)
    first = np.flatnonzero(
        np.concatenate([[True], (np.diff(stratum) != 0) | (np.diff(steps) != 0)])[: len(steps)]
    )
    if not died.any():
        return Significance(name, 0.0, 0, 1.0)
    deaths = np.add.reduceat(member * died[:, None], first)
    at_risk = _at_risk(member, stratum, first)
    risk, dead = at_risk.sum(axis=1), deaths.sum(axis=1)
    telling = (dead > 0) & (risk > 1)
    deaths, at_risk, risk, dead = (each[telling] for each in (deaths, at_risk, risk, dead))
    share = at_risk / risk[:, None]
    surplus = (deaths - share * dead[:, None]).sum(axis=0)
    weight = dead * (risk - dead) / (risk - 1)
    spread = np.diag((weight[:, None] * share).sum(axis=0)) - share.T @ (weight[:, None] * share)
    sizes, axes = np.linalg.eigh(spread)
    # Groups that were never at risk together leave directions in which nothing is compared.
    compared = sizes > 1e-9 * sizes.max(initial=0.0)
    freedom = int(compared.sum())
    if freedom == 0:
        return Significance(name, 0.0, 0, 1.0)
    statistic = float(((surplus @ axes[:, compared]) ** 2 / sizes[compared]).sum())
    return Significance(name, statistic, freedom, float(stats.chi2.sf(statistic, freedom)))


def _at_risk(
    member: NDArray[np.float64], stratum: NDArray[np.int64], first: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Lives [t, k] of each group and the same stratum that are still watched at each time."""
    after = np.zeros((len(member) + 1, member.shape[1]))
    after[:-1] = member[::-1].cumsum(axis=0)[::-1]
    end = np.searchsorted(stratum, stratum[first], side="right")
    return after[first] - after[end]


NAME = "Hotelling"

ROUNDING = 1e-9
"""Smaller numbers are what is left of 0 after rounding."""


def hotelling(values: NDArray[np.float64], pulls: NDArray[np.float64]) -> Significance:
    """The T² test that `values` [m] are all 0; with one of them it is Student's t test.

    `pulls` [s, m] is how much each of s independent units moves the values away from their truth:
    for the mean of a column, its entries less the mean, over s. Values and pulls are around 1 in
    size. p is unknown with fewer than m + 1 units. What does not vary between units is left out;
    if it is not 0, p is that of the sign test, all units having the same sign.
    """
    units, m = pulls.shape
    if units <= m:
        return Significance(NAME, float("nan"), 0, float("nan"))
    spread = np.sqrt((pulls**2).sum(axis=0))
    varies = spread > ROUNDING
    certain = bool((np.abs(values[~varies]) > ROUNDING).any())
    scaled, alike = values[varies] / spread[varies], pulls[:, varies] / spread[varies]
    sizes, axes = np.linalg.eigh(alike.T @ alike)
    turned, kept = scaled @ axes, sizes > ROUNDING
    certain |= bool((np.abs(turned[~kept]) > np.sqrt(ROUNDING)).any())
    freedom = int(kept.sum())
    if certain:
        return Significance(NAME, float("inf"), freedom, 2.0 ** (1 - units))
    if freedom == 0:
        return Significance(NAME, 0.0, 0, 1.0)
    statistic = float((turned[kept] ** 2 / sizes[kept]).sum()) * (units - 1) / units
    f = statistic * (units - freedom) / (freedom * (units - 1))
    return Significance(NAME, statistic, freedom, float(stats.f.sf(f, freedom, units - freedom)))

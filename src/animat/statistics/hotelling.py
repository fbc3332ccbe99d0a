"""Hotelling's test: do several means that are measured together differ from 0?"""

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.logrank import Significance

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

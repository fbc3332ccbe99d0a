"""Effect sizes: how much longer one group lives than another, and how surely one life outlasts."""

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.estimates import LEVEL, Estimate
from animat.statistics.resampling import Sets


def cliffs_delta(
    one: NDArray[np.float64], one_sets: Sets, other: NDArray[np.float64], other_sets: Sets
) -> Estimate:
    """Cliff's delta of `one` [n] against `other` [m], in [-1, 1], with its interval.

    The chance that a life of `one` outlasts a life of `other`, less the chance of the contrary;
    lives cut at the same cap tie. It is the rank-biserial correlation of the Mann-Whitney test.
    The interval is DeLong's, by the share of the other group that each life outlasts, on Fisher's
    scale, lives of one set counting as one. Both groups share one numbering of sets; neither may
    be empty.
    """
    wins = _outlasted(one, other)
    losses = 1.0 - _outlasted(other, one)
    chance = float(wins.mean())
    delta = 2.0 * chance - 1.0
    count = one_sets.count
    pull = np.bincount(one_sets.codes, wins - chance, count) / len(one)
    pull += np.bincount(other_sets.codes, losses - chance, count) / len(other)
    used = np.unique(np.concatenate([one_sets.codes, other_sets.codes]))
    if len(used) < 2:
        return Estimate(delta, float("nan"), float("nan"))
    if abs(delta) == 1.0:
        return Estimate(delta, delta, delta)
    error = 2.0 * np.sqrt(len(used)) * pull[used].std(ddof=1) / (1.0 - delta**2)
    half = stats.norm.ppf((1 + LEVEL) / 2) * error
    low, high = np.tanh(np.arctanh(delta) + np.array([-half, half]))
    return Estimate(delta, float(low), float(high))


def _outlasted(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    """The share of `other` that each of `one` [n] outlasts, ties counting half."""
    ordered = np.sort(other)
    below = np.searchsorted(ordered, one, side="left")
    upto = np.searchsorted(ordered, one, side="right")
    return (below + upto) / (2 * len(ordered))

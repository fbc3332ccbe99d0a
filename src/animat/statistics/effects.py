"""Effect sizes: how much longer one group lives than another, and how surely one life outlasts."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.estimates import LEVEL, RESAMPLES, Estimate
from animat.statistics.resampling import Sets, codes_of, mean_over, share_over


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


class PairedEffects(NamedTuple):
    """What `pairs` pairs of lives tell of a level against another.

    `difference` is the mean of the differences in steps. `outlives` is the share of pairs in
    which the first life is the longer one, `ties` the share in which both are cut at the same
    step: at the cap, where it is not known which is longer. `rank_biserial` is in [-1, 1].
    """

    pairs: int
    difference: Estimate
    outlives: Estimate
    ties: float
    rank_biserial: Estimate


def paired_effects(
    steps: NDArray[np.float64],
    one: NDArray[np.bool_],
    pair: NDArray[np.int64],
    sets: Sets,
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> PairedEffects | None:
    """Compare the lives in `one` with the others, pair by pair; None if there is no pair.

    All arrays are [n]. `steps` are lifespans cut at a cap up to which every life was watched;
    `pair` are codes; lives without a partner are left out, and several of one level in a pair count
    by their mean. All lives of a pair are in one set.
    """
    codes = codes_of(pair)
    ours, theirs = np.bincount(codes, one), np.bincount(codes, ~one)
    whole = (ours > 0) & (theirs > 0)
    if not whole.any():
        return None
    above, below = np.bincount(codes, steps * one), np.bincount(codes, steps * ~one)
    difference = above[whole] / ours[whole] - below[whole] / theirs[whole]
    first = np.unique(codes, return_index=True)[1]
    drawn = sets.take(first[whole])
    return PairedEffects(
        int(whole.sum()),
        mean_over(difference, drawn, seed=seed, resamples=resamples),
        share_over(difference > 0, drawn),
        float((difference == 0).mean()),
        rank_biserial(difference, drawn),
    )


def rank_biserial(difference: NDArray[np.float64], sets: Sets) -> Estimate:
    """The matched-pairs rank-biserial correlation of `difference` [n], with its interval.

    The ranks of the positive differences less those of the negative ones, over all ranks
    (Kerby 2014). Ties are ranked and count for neither side, as by Pratt, so that lives that both
    reach the cap draw it towards 0. It is the mean sign of d_i + d_j over i <= j; the interval
    takes the share of signs that each set contributes, on Fisher's scale. It is unknown where all
    sets agree.
    """
    n = len(difference)
    ordered = np.sort(difference)
    above = n - np.searchsorted(ordered, -difference, side="right")
    below = np.searchsorted(ordered, -difference, side="left")
    signs = (above - below) / n
    total = n * signs.sum() + np.sign(difference).sum()
    value = float(total / (n * (n + 1)))
    used, codes = np.unique(sets.codes, return_inverse=True)
    pull = 2.0 * np.bincount(codes, signs - signs.mean(), len(used)) / n
    if abs(value) == 1.0 or not pull.any():
        return Estimate(value, float("nan"), float("nan"))
    error = np.sqrt(len(used)) * pull.std(ddof=1) / (1.0 - value**2)
    half = stats.norm.ppf((1 + LEVEL) / 2) * error
    low, high = np.tanh(np.arctanh(value) + np.array([-half, half]))
    return Estimate(value, float(low), float(high))

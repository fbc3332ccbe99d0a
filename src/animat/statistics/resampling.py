"""Estimates from lives that hang together: which lives are resampled as one, and what follows.

Lives of one number in different cases share their random numbers; lives of one case share its
settings. A bootstrap that drew each life alone would be too sure, or not sure
enough. So sets of lives are drawn: what is fixed by the design stays in each draw as it was.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.estimates import LEVEL, RESAMPLES, UNKNOWN, Estimate, of_means

SETS_AT_LEAST = 20
"""Fewer sets than this tell little of how much they differ."""

BOOTSTRAPPED_AT_MOST = 1_000
"""More sets than this are not drawn one by one: their means are drawn from the normal law."""

LIVES = (
    "sets of lives, one life of every case in each, as lives of one number share their random"
    " numbers"
)
COMBINATIONS = "combinations of the other factors, each with all its lives"
CASES = "cases, each with all its lives"


class Sets(NamedTuple):
    """Which set each of n lives is in, `codes` [n] below `count`; `what` says what a set is."""

    codes: NDArray[np.int64]
    count: int
    what: str

    def take(self, rows: NDArray) -> "Sets":
        """The sets of the chosen lives; their number stays."""
        return self._replace(codes=self.codes[rows])


def paired(seed: NDArray, life: NDArray, case: NDArray[np.int64]) -> bool:
    """Whether lives of different cases share their random numbers: a seed and index in common."""
    drawn = codes_of(seed, life)
    return len(np.unique(drawn)) < len(np.unique(codes_of(case, drawn)))


def numbers(seed: NDArray, life: NDArray, case: NDArray[np.int64]) -> NDArray[np.int64]:
    """The number of each of n lives: equal for lives that share their random numbers.

    Where every case has random numbers of its own, the first life of each has number 0, and so on:
    independent lives may be put together in any way. All arrays are [n].
    """
    drawn = codes_of(seed, life)
    if paired(seed, life, case):
        return drawn
    lived, place = np.unique(codes_of(case, drawn), return_inverse=True)
    first = np.zeros(len(lived), dtype=case.dtype)
    first[place] = case
    return (place - np.searchsorted(first, case)).astype(np.int64)


def codes_of(*columns: NDArray) -> NDArray[np.int64]:
    """A code [n] from 0 on for each different row of `columns`, in the rows' order."""
    codes = np.zeros(len(columns[0]), dtype=np.int64)
    for each in columns:
        place = np.unique(each, return_inverse=True)[1].astype(np.int64)
        pairs = codes * (place.max(initial=0) + 1) + place
        codes = np.unique(pairs, return_inverse=True)[1].astype(np.int64)
    return codes


def sets_of(
    number: NDArray[np.int64],
    case: NDArray[np.int64],
    combination: NDArray[np.int64] | None,
) -> Sets:
    """The sets in which n lives are resampled. All arrays are [n].

    `combination` is that of the other factors where levels of a factor are compared within it, and
    None where the levels were lived in other combinations each. Then the cases themselves are a
    sample, and they are drawn. Else the design is fixed and lives are drawn, unless there are too
    few of them.
    """
    by_number = _set(number, LIVES)
    others = _set(case, CASES) if combination is None else _set(combination, COMBINATIONS)
    if combination is not None and by_number.count >= SETS_AT_LEAST:
        return by_number
    return others if others.count >= min(SETS_AT_LEAST, by_number.count) else by_number


def mean_over(
    values: NDArray[np.float64], sets: Sets, *, seed: int = 0, resamples: int = RESAMPLES
) -> Estimate:
    """Mean of `values` [n], NaN left out, with its interval; unknown if there is none."""
    return ratio_over(values, np.ones(len(values)), sets, seed=seed, resamples=resamples)


def ratio_over(
    above: NDArray[np.float64],
    below: NDArray[np.float64],
    sets: Sets,
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> Estimate:
    """Sum of `above` [n] over sum of `below` [n], lives with a NaN left out.

    Unknown if nothing is below.
    """
    known = ~(np.isnan(above) | np.isnan(below)) & (below != 0)
    if not known.any():
        return UNKNOWN
    totals = _totals([above[known], below[known]], sets.take(known))
    return _of(totals, np.divide, seed, resamples)


def quotient_over(
    above: NDArray[np.float64],
    above_sets: Sets,
    below: NDArray[np.float64],
    below_sets: Sets,
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> Estimate:
    """Mean of `above` over mean of `below`, sets that both share drawn together."""
    one = [above, np.ones(len(above))]
    other = [below, np.ones(len(below))]
    joint = Sets(np.concatenate([above_sets.codes, below_sets.codes]), above_sets.count, "")
    filled = [np.concatenate([each, np.zeros(len(below))]) for each in one]
    filled += [np.concatenate([np.zeros(len(above)), each]) for each in other]
    totals = _totals(filled, joint)
    if not totals[0].any() or not totals[2].any():
        return UNKNOWN
    return _of(totals, lambda a, n, b, m: (a / n) / (b / m), seed, resamples)


def share_over(hits: NDArray[np.bool_], sets: Sets) -> Estimate:
    """The share of `hits` [n], at least one, with Wilson's interval.

    The interval counts as many independent hits and misses as would make the share vary as much
    as it does between sets (Korn and Graubard 1998): all n where every set has one, never more,
    and one from each set where nothing varies.
    """
    used, codes = np.unique(sets.codes, return_inverse=True)
    n, count, value = len(hits), len(used), float(hits.mean())
    if count < 2:
        return Estimate(value, float("nan"), float("nan"))
    surplus = np.bincount(codes, hits - value, count)
    variance = float(surplus @ surplus) / n**2
    n = min(n, value * (1 - value) / variance) if variance > 0 else count
    z2 = stats.norm.ppf((1 + LEVEL) / 2) ** 2
    middle = (value + z2 / (2 * n)) / (1 + z2 / n)
    half = np.sqrt(z2 * (value * (1 - value) / n + z2 / (4 * n**2))) / (1 + z2 / n)
    return Estimate(value, max(0.0, float(middle - half)), min(1.0, float(middle + half)))


def median_over(
    steps: NDArray[np.float64], cap: float, sets: Sets, *, seed: int = 0, resamples: int = RESAMPLES
) -> Estimate:
    """The step that half the lives or fewer outlive, infinite from `cap` on, where watching ended.

    The ends of its interval are where 2.5 % and 97.5 % of the resampled medians lie: a resampled
    median is at most t if half of the resampled lives ended by t.
    """
    codes, count = np.unique(sets.codes, return_inverse=True)[1], len(np.unique(sets.codes))
    lives = np.bincount(codes, minlength=count).astype(np.float64)
    times = np.unique(steps)
    tail = (1 - LEVEL) / 2
    weights = None
    if 2 <= count <= BOOTSTRAPPED_AT_MOST:
        rng = np.random.default_rng(seed)
        weights = rng.multinomial(count, np.full(count, 1 / count), resamples).astype(np.float64)

    def chance(time: float) -> float:
        """How likely half of the resampled lives have ended by `time`."""
        surplus = np.bincount(codes, steps <= time, count) - lives / 2
        if weights is not None:
            return float((weights @ surplus >= 0).mean())
        spread = np.sqrt(count) * surplus.std(ddof=1) if count > 1 else 0.0
        return float(stats.norm.cdf(surplus.sum() / spread) if spread else surplus.sum() >= 0)

    def first(reached) -> float:
        low, high = 0, len(times) - 1
        while low < high:
            middle = (low + high) // 2
            low, high = (low, middle) if reached(times[middle]) else (middle + 1, high)
        return float(times[low]) if times[low] < cap else float("inf")

    value = first(lambda time: (steps <= time).sum() >= len(steps) / 2)
    if count < 2:
        return Estimate(value, float("nan"), float("nan"))
    return Estimate(
        value, first(lambda t: chance(t) >= tail), first(lambda t: chance(t) >= 1 - tail)
    )


def _of(
    totals: Sequence[NDArray[np.float64]],
    function: Callable[..., NDArray[np.float64]],
    seed: int,
    resamples: int,
) -> Estimate:
    """A function of the means of `totals`, arrays [s]; a single set tells nothing of its spread."""
    count = len(totals[0])
    if count < 2:
        value = function(*(float(each.mean()) for each in totals))
        return Estimate(float(value), float("nan"), float("nan"))
    if count <= BOOTSTRAPPED_AT_MOST:
        return of_means(totals, function, seed=seed, resamples=resamples)
    samples = np.stack(totals)
    means = samples.mean(axis=1)
    spread = np.atleast_2d(np.cov(samples)) / count
    rng = np.random.default_rng(seed)
    drawn = rng.multivariate_normal(means, spread, resamples, check_valid="ignore", method="eigh")
    low, high = np.quantile(function(*drawn.T), ((1 - LEVEL) / 2, (1 + LEVEL) / 2))
    return Estimate(float(function(*means)), float(low), float(high))


def _totals(values: Sequence[NDArray[np.float64]], sets: Sets) -> list[NDArray[np.float64]]:
    """The sums [s] of each of `values` [n] over the sets in which there is any life."""
    used, codes = np.unique(sets.codes, return_inverse=True)
    return [np.bincount(codes, each, len(used)).astype(np.float64) for each in values]


def _set(codes: NDArray[np.int64], what: str) -> Sets:
    used, dense = np.unique(codes, return_inverse=True)
    return Sets(dense.astype(np.int64), len(used), what)

"""Estimates with intervals: what the report says of a sample, and how sure it is.

There is one bootstrap, of functions of means: one sample alone, or many at once, a row each, that
are resampled alike. It is `scipy.stats.bootstrap`; shares have Wilson's interval
(`scipy.stats.binomtest`). Every function takes its own seed, so that a report made twice from one
table is the same report.

Of whole numbers, such as lifespans, a row has the interval it would have alone, to the last digit.
Of other numbers it may differ where very few values are resampled: BCa counts the resamples that
equal the sample, and whether a sum in another order is equal is then a matter of rounding.
"""

import warnings
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats

LEVEL = 0.95
"""Confidence level of every interval in the report."""

RESAMPLES = 3_999
"""Bootstrap resamples: the ends of a 95 % interval move by some 2 % of its width by chance."""

BCA_LIMIT = 2_000
"""Largest sample that gets the BCa interval. It leaves out each value once, which costs the square
of their number, and its correction shrinks with the root of it; beyond, percentiles."""

NUMBERS = 4_000_000
"""How many numbers are held at once: resamples times values, or rows times resamples."""

OfMeans = Callable[..., NDArray[np.float64]]
"""A function of the mean of each sample, arrays of one shape, that returns one of that shape."""


class Estimate(NamedTuple):
    """A value with its confidence interval; NaN where nothing can be said."""

    value: float
    low: float
    high: float


class Estimates(NamedTuple):
    """Values with their confidence intervals, arrays [R], a row each."""

    value: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]

    def at(self, row: int) -> Estimate:
        """The estimate of a row."""
        return Estimate(float(self.value[row]), float(self.low[row]), float(self.high[row]))


UNKNOWN = Estimate(float("nan"), float("nan"), float("nan"))


def share(count: int, total: int) -> Estimate:
    """`count` of `total` as a share in [0, 1] with Wilson's interval; unknown if `total` is 0."""
    if total == 0:
        return UNKNOWN
    interval = stats.binomtest(count, total).proportion_ci(LEVEL, method="wilson")
    return Estimate(count / total, float(interval.low), float(interval.high))


def mean(values: NDArray[np.float64], *, seed: int = 0, resamples: int = RESAMPLES) -> Estimate:
    """Mean of `values` [n] with its interval."""
    return of_means([values], lambda one: one, seed=seed, resamples=resamples)


def of_means(
    samples: Sequence[NDArray[np.float64]],
    function: OfMeans,
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> Estimate:
    """`function` of the means of `samples`, arrays [n], with its interval; as `rows_of_means`."""
    rows = [np.asarray(sample, dtype=np.float64)[None] for sample in samples]
    return rows_of_means(rows, function, seed=seed, resamples=resamples).at(0)


def rows_of_means(
    samples: Sequence[NDArray[np.float64]],
    function: OfMeans,
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> Estimates:
    """`function` of the means of every row of `samples`, with its bootstrap interval.

    `samples` are arrays [R, n]; entry k of each belongs together and is resampled together. The
    interval is BCa up to `BCA_LIMIT` values and percentiles beyond. Where nothing varies it has no
    width, of a single value it is unknown. Raises ValueError if n is 0.
    """
    rows, values = samples[0].shape
    if values == 0:
        raise ValueError("an estimate needs at least one value in every sample")
    value = np.asarray(function(*(sample.mean(axis=1) for sample in samples)), dtype=np.float64)
    if values == 1:
        return Estimates(value, np.full(rows, np.nan), np.full(rows, np.nan))
    low, high = value.copy(), value.copy()
    varies = np.any([np.ptp(sample, axis=1) > 0.0 for sample in samples], axis=0)

    def fill(chosen: NDArray[np.int64], method: str) -> None:
        if chosen.size:
            parts = [sample[chosen] for sample in samples]
            low[chosen], high[chosen] = _interval(parts, function, seed, resamples, method)

    at_once = max(1, NUMBERS // resamples)
    for first in range(0, rows, at_once):
        chosen = first + np.flatnonzero(varies[first : first + at_once])
        fill(chosen, "BCa" if values <= BCA_LIMIT else "percentile")
    # BCa has no answer when every resample lies on one side of the value.
    fill(np.flatnonzero(varies & ~(np.isfinite(low) & np.isfinite(high))), "percentile")
    return Estimates(value, low, high)


def _interval(
    samples: Sequence[NDArray[np.float64]],
    function: OfMeans,
    seed: int,
    resamples: int,
    method: str,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    values = samples[0].shape[1]

    def statistic(entries: NDArray[np.int64], axis: int = -1) -> NDArray[np.float64]:
        """For resamples given as places of entries, [..., n], the statistic [R, ...]."""
        return np.asarray(function(*_means(samples, entries)), dtype=np.float64)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", stats.DegenerateDataWarning)
        warnings.simplefilter("ignore", RuntimeWarning)
        result = stats.bootstrap(
            (np.arange(values),),
            statistic,
            vectorized=True,
            n_resamples=resamples,
            batch=max(1, NUMBERS // values),
            confidence_level=LEVEL,
            method=method,
            rng=np.random.default_rng(seed),
        )
    interval = result.confidence_interval
    return interval.low, interval.high


def _means(
    samples: Sequence[NDArray[np.float64]], entries: NDArray[np.int64]
) -> list[NDArray[np.float64]]:
    """The means [R, ...] of the entries at some places [..., n] of every row.

    Of many rows a resample is taken as how often it holds each entry, so that all means are a
    product of two matrices.
    """
    if len(samples[0]) * entries.size <= 2 * NUMBERS:
        return [np.take(sample, entries, axis=1).mean(axis=-1) for sample in samples]
    values = samples[0].shape[1]
    drawn = entries.reshape(-1, entries.shape[-1]).astype(np.int64)
    places = drawn + values * np.arange(len(drawn))[:, None]
    times = np.bincount(places.ravel(), minlength=values * len(drawn)).reshape(-1, values)
    shape = (len(samples[0]), *entries.shape[:-1])
    return [(sample @ times.T / drawn.shape[1]).reshape(shape) for sample in samples]

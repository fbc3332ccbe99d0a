"""Bootstrap intervals of many universes at once.

`estimates.bootstrapped` takes one sample at a time. Here a sample is a row, and scipy's bootstrap
goes over all rows with the same resamples: what it gives for each row alone. As everything told of
universes is made of means, a resample is taken as how often it holds each life, and the means of
all rows are a product of two matrices.

Of whole numbers, such as lifespans, intervals are the same to the last digits. Of other numbers
they may differ where very few values are resampled: BCa counts the resamples that equal the sample,
and whether a sum in another order is equal is then a matter of rounding.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.estimates import BCA_LIMIT, LEVEL, RESAMPLES, Estimate

NUMBERS = 4_000_000
"""How many numbers are held at once: rows times resamples."""

OfMeans = Callable[..., NDArray[np.float64]]


class Estimates(NamedTuple):
    """Values with their confidence intervals, arrays [R], a row each."""

    value: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]

    def at(self, row: int) -> Estimate:
        """The estimate of a row."""
        return Estimate(float(self.value[row]), float(self.low[row]), float(self.high[row]))


def bootstrapped_rows(
    samples: Sequence[NDArray[np.float64]],
    of_means: OfMeans,
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> Estimates:
    """`of_means(*means)` of every row, with the interval of `estimates.bootstrapped` for pairs.

    `samples` are arrays [R, n]; entry k of each belongs together and is resampled together.
    `of_means` takes the mean of each, arrays of any shape, and returns one of that shape. Raises
    ValueError if n is 0.
    """
    rows, values = samples[0].shape
    if values == 0:
        raise ValueError("an estimate needs at least one value in every sample")
    value = of_means(*(sample.mean(axis=1) for sample in samples))
    if values == 1:
        return Estimates(value, np.full(rows, np.nan), np.full(rows, np.nan))
    low, high = value.copy(), value.copy()
    varies = np.any([np.ptp(sample, axis=1) > 0.0 for sample in samples], axis=0)
    method = "BCa" if values <= BCA_LIMIT else "percentile"
    at_once = max(1, NUMBERS // resamples)
    for first in range(0, rows, at_once):
        chosen = first + np.flatnonzero(varies[first : first + at_once])
        if chosen.size:
            parts = [sample[chosen] for sample in samples]
            low[chosen], high[chosen] = _interval(parts, of_means, seed, resamples, method)
    # BCa has no answer when every resample lies on one side of the value.
    unknown = np.flatnonzero(varies & ~(np.isfinite(low) & np.isfinite(high)))
    if unknown.size:
        parts = [sample[unknown] for sample in samples]
        low[unknown], high[unknown] = _interval(parts, of_means, seed, resamples, "percentile")
    return Estimates(value, low, high)


def _interval(
    samples: Sequence[NDArray[np.float64]],
    of_means: OfMeans,
    seed: int,
    resamples: int,
    method: str,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    rows, values = samples[0].shape

    def statistic(entries: NDArray, axis: int = -1) -> NDArray[np.float64]:
        """For resamples given as numbers of entries, [..., n], the statistic [R, ...]."""
        drawn = entries.reshape(-1, entries.shape[-1]).astype(np.int64)
        places = drawn + values * np.arange(len(drawn))[:, None]
        times = np.bincount(places.ravel(), minlength=values * len(drawn)).reshape(-1, values)
        means = (sample @ times.T / drawn.shape[1] for sample in samples)
        return of_means(*means).reshape(rows, *entries.shape[:-1])

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", stats.DegenerateDataWarning)
        warnings.simplefilter("ignore", RuntimeWarning)
        result = stats.bootstrap(
            (np.arange(values),),
            statistic,
            vectorized=True,
            n_resamples=resamples,
            confidence_level=LEVEL,
            method=method,
            rng=np.random.default_rng(seed),
        )
    interval = result.confidence_interval
    return interval.low, interval.high

"""Bootstrap intervals of many universes at once.

`estimates.bootstrapped` takes one sample at a time. Here a sample is a row, and scipy's bootstrap
goes over all rows with the same resamples: to the bit what it gives for each row alone.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from animat.report.estimates import BCA_LIMIT, LEVEL, RESAMPLES, Estimate

NUMBERS = 4_000_000
"""How many numbers are held at once: rows times resamples times values."""


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
    statistic: Callable[..., NDArray[np.float64]],
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> Estimates:
    """`statistic(*samples, axis)` of every row, as `estimates.bootstrapped` has it for paired ones.

    `samples` are arrays [R, n]; entry k of each belongs together and is resampled together.
    Raises ValueError if n is 0.
    """
    rows, values = samples[0].shape
    if values == 0:
        raise ValueError("an estimate needs at least one value in every sample")
    value = statistic(*samples, axis=-1)
    low, high = value.copy(), value.copy()
    varies = np.any([np.ptp(sample, axis=1) > 0.0 for sample in samples], axis=0)
    method = "BCa" if values <= BCA_LIMIT else "percentile"
    at_once = max(1, NUMBERS // values**2)
    for first in range(0, rows, at_once):
        chosen = first + np.flatnonzero(varies[first : first + at_once])
        if not chosen.size:
            continue
        parts = [sample[chosen] for sample in samples]
        low[chosen], high[chosen] = _interval(parts, statistic, seed, resamples, method)
    # BCa has no answer when every resample lies on one side of the value.
    open_ = np.flatnonzero(varies & ~(np.isfinite(low) & np.isfinite(high)))
    if open_.size:
        parts = [sample[open_] for sample in samples]
        low[open_], high[open_] = _interval(parts, statistic, seed, resamples, "percentile")
    return Estimates(value, low, high)


def _interval(
    samples: Sequence[NDArray[np.float64]],
    statistic: Callable[..., NDArray[np.float64]],
    seed: int,
    resamples: int,
    method: str,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    rows, values = samples[0].shape
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", stats.DegenerateDataWarning)
        warnings.simplefilter("ignore", RuntimeWarning)
        result = stats.bootstrap(
            tuple(samples),
            statistic,
            paired=True,
            vectorized=True,
            axis=-1,
            n_resamples=resamples,
            batch=max(1, NUMBERS // (rows * values)),
            confidence_level=LEVEL,
            method=method,
            rng=np.random.default_rng(seed),
        )
    interval = result.confidence_interval
    return interval.low, interval.high

"""Estimates with intervals: what the report says of a sample, and how sure it is.

Bootstrap intervals come from `scipy.stats.bootstrap`, shares from Wilson's interval
(`scipy.stats.binomtest`). Every function takes its own seed, so that a report made twice
from one table is the same report.
"""

import warnings
from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats

LEVEL = 0.95
"""Confidence level of every interval in the report."""

RESAMPLES = 3_999
"""Bootstrap resamples: the ends of a 95 % interval move by some 2 % of its width by chance."""

BCA_LIMIT = 2_000
"""Largest sample that gets the BCa interval by default. It leaves out each life once, which costs
the square of their number, and its correction shrinks with the root of it; beyond, percentiles."""

_BATCH_NUMBERS = 4_000_000

Method = Literal["BCa", "percentile", "normal"]
"""`normal` draws the means of many values from the normal law that they follow then, instead of
the values: percentiles at no cost. It is never chosen by itself, and only for means of pairs."""


class Estimate(NamedTuple):
    """A value with its confidence interval; NaN where nothing can be said."""

    value: float
    low: float
    high: float


UNKNOWN = Estimate(float("nan"), float("nan"), float("nan"))


def share(count: int, total: int) -> Estimate:
    """`count` of `total` as a share in [0, 1] with Wilson's interval; unknown if `total` is 0."""
    if total == 0:
        return UNKNOWN
    interval = stats.binomtest(count, total).proportion_ci(LEVEL, method="wilson")
    return Estimate(count / total, float(interval.low), float(interval.high))


def bootstrapped(
    samples: Sequence[NDArray[np.float64]],
    statistic: Callable[..., NDArray[np.float64]],
    *,
    paired: bool = False,
    seed: int = 0,
    resamples: int = RESAMPLES,
    method: Method | None = None,
) -> Estimate:
    """`statistic(*samples, axis)` with its bootstrap interval.

    `samples` are arrays [n_i]; with `paired` all of one length, entry k of each belonging
    together, and resampled together. `method` None takes BCa up to `BCA_LIMIT` values and
    percentiles beyond. Samples in which nothing varies have an interval of no width, a single value
    has none that is known.
    Raises ValueError if a sample is empty.
    """
    if any(len(sample) == 0 for sample in samples):
        raise ValueError("an estimate needs at least one value in every sample")
    value = float(statistic(*samples, axis=-1))
    if min(len(sample) for sample in samples) < 2:
        return Estimate(value, float("nan"), float("nan"))
    if all(np.all(sample == sample[0]) for sample in samples):
        return Estimate(value, value, value)
    largest = max(len(sample) for sample in samples)
    chosen = method or ("BCa" if largest <= BCA_LIMIT else "percentile")
    interval = _interval(samples, statistic, paired, seed, resamples, chosen)
    if chosen == "BCa" and not np.all(np.isfinite(interval)):
        # BCa has no answer when every resample lies on one side of the value.
        interval = _interval(samples, statistic, paired, seed, resamples, "percentile")
    return Estimate(value, *interval)


def _interval(
    samples: Sequence[NDArray[np.float64]],
    statistic: Callable[..., NDArray[np.float64]],
    paired: bool,
    seed: int,
    resamples: int,
    method: Method,
) -> tuple[float, float]:
    largest = max(len(sample) for sample in samples)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", stats.DegenerateDataWarning)
        warnings.simplefilter("ignore", RuntimeWarning)
        result = stats.bootstrap(
            tuple(samples),
            statistic,
            paired=paired,
            vectorized=True,
            n_resamples=resamples,
            batch=max(1, _BATCH_NUMBERS // largest),
            confidence_level=LEVEL,
            method=method,
            rng=np.random.default_rng(seed),
        )
    interval = result.confidence_interval
    return float(interval.low), float(interval.high)


def of_means(
    samples: Sequence[NDArray[np.float64]],
    function: Callable[..., NDArray[np.float64]],
    *,
    paired: bool = False,
    seed: int = 0,
    resamples: int = RESAMPLES,
    method: Method | None = None,
) -> Estimate:
    """`function` of the means of `samples`, arrays [n_i], with its bootstrap interval.

    `function` takes a number, or an array of them, for each sample. `method` "normal" needs
    `paired`; else as in `bootstrapped`.
    """
    if method == "normal":
        return _of_normal_means(np.stack(samples), function, seed, resamples)
    if any(len(sample) == 0 for sample in samples):
        raise ValueError("an estimate needs at least one value in every sample")
    # What does not vary needs no drawing; of a single value it cannot be told.
    fixed = [
        sample[0] if len(sample) > 1 and np.all(sample == sample[0]) else None for sample in samples
    ]
    varying = [sample for sample, value in zip(samples, fixed, strict=True) if value is None]

    def statistic(*drawn: NDArray[np.float64], axis: int = -1) -> NDArray[np.float64]:
        means = iter(drawn)
        return function(
            *(np.mean(next(means), axis=axis) if value is None else value for value in fixed)
        )

    return bootstrapped(
        varying or samples[:1],
        statistic if varying else lambda one, axis: function(*fixed),
        paired=paired,
        seed=seed,
        resamples=resamples,
        method=method,
    )


def _of_normal_means(
    samples: NDArray[np.float64],
    function: Callable[..., NDArray[np.float64]],
    seed: int,
    resamples: int,
) -> Estimate:
    """A function of the means of `samples` [k, n], whose joint law is taken for normal."""
    means = samples.mean(axis=1)
    spread = np.atleast_2d(np.cov(samples)) / samples.shape[1]
    rng = np.random.default_rng(seed)
    drawn = rng.multivariate_normal(means, spread, resamples, check_valid="ignore", method="eigh")
    tails = (1 - LEVEL) / 2, (1 + LEVEL) / 2
    low, high = np.quantile(function(*drawn.T), tails)
    return Estimate(float(function(*means)), float(low), float(high))


def mean(
    values: NDArray[np.float64],
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
    method: Method | None = None,
) -> Estimate:
    """Mean of `values` [n] with its bootstrap interval."""
    return of_means([values], lambda one: one, seed=seed, resamples=resamples, method=method)


def ratio_of_means(
    numerator: NDArray[np.float64],
    denominator: NDArray[np.float64],
    *,
    paired: bool,
    seed: int = 0,
    resamples: int = RESAMPLES,
    method: Method | None = None,
) -> Estimate:
    """Mean of `numerator` [n] over mean of `denominator` [m] with its bootstrap interval.

    `paired`: entry k of both shares its luck (n equals m). Raises ValueError if the
    denominator's mean is 0.
    """
    if len(denominator) and not np.any(denominator):
        raise ValueError("the ratio of means has a denominator of 0")
    return of_means(
        [numerator, denominator],
        np.divide,
        paired=paired,
        seed=seed,
        resamples=resamples,
        method=method,
    )

"""What each reading does to each claim and to the sizes of the effects, all else mixed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.claims import CLAIMS, EFFECTS, RATIOS
from animat.statistics.estimates import LEVEL, UNKNOWN, Estimate, share
from animat.statistics.lives import column
from animat.statistics.readings import Readings, codes, comparable
from animat.statistics.universes import holds

FEWEST = 2
"""Universes that a value must have to be compared."""


class Outcome(NamedTuple):
    """Something of each universe that readings may change, [U].

    `scale` says how a difference between two means of it is told: `points` of a share (a claim
    that holds, 0 or 1), `factor` (a logarithm of a ratio) or `difference`.
    """

    name: str
    scale: str
    values: NDArray[np.float64]


class Imbalance(NamedTuple):
    """How much a comparison by `reading` is also one by `other`.

    By so many `points`, in [0, 1], the share of a value of `other` differs between the two groups.
    """

    reading: str
    other: str
    points: float


def outcomes(universes: pa.Table) -> list[Outcome]:
    """The claims and the effects of a table of universes as outcomes."""
    found = [
        Outcome(claim, "points", holds(universes, claim).astype(np.float64)) for claim in CLAIMS
    ]
    for name in EFFECTS:
        values = column(universes, name)
        ratio = name in RATIOS
        found.append(
            Outcome(name, "factor" if ratio else "difference", np.log(values) if ratio else values)
        )
    return found


def marginal_effects(universes: pa.Table, readings: Readings) -> pa.Table:
    """A row for every value of a reading but its first, and every outcome.

    Columns: `reading`, `value`, `against` (the first value), `outcome`, `scale`, `universes` and
    `universes_against`, `mean` and `mean_against` (share that holds; geometric mean of a ratio),
    `effect`, `low`, `high`: difference of the shares (Newcombe's interval), factor between the
    geometric means or difference of the means (Welch's). Only universes are compared in which
    either value was possible.
    """
    code = codes(universes, readings)
    what = outcomes(universes)
    rows = []
    for place, value, one, other in _contrasts(code, readings):
        name = list(readings)[place]
        for outcome in what:
            mine, theirs = outcome.values[one], outcome.values[other]
            effect = difference(mine, theirs, outcome.scale)
            rows.append(
                {
                    "reading": name,
                    "value": readings[name][value],
                    "against": readings[name][0],
                    "outcome": outcome.name,
                    "scale": outcome.scale,
                    "universes": len(mine),
                    "universes_against": len(theirs),
                    "mean": _mean(mine, outcome.scale),
                    "mean_against": _mean(theirs, outcome.scale),
                    **dict(zip(("effect", "low", "high"), effect, strict=True)),
                }
            )
    return pa.Table.from_pylist(rows)


def largest_imbalance(universes: pa.Table, readings: Readings) -> Imbalance:
    """The comparison of `marginal_effects` in which another reading is shared out least evenly.

    What that reading does enters the effect by so many points. Points of Sobol's sequence share
    out values in threes only roughly.
    """
    code, names = codes(universes, readings), list(readings)
    largest = Imbalance("", "", 0.0)
    for place, _, one, other in _contrasts(code, readings):
        if not (one.any() and other.any()):
            continue
        for rest, name in enumerate(names):
            for value in range(len(readings[name])):
                has = code[:, rest] == value
                points = abs(float(has[one].mean() - has[other].mean()))
                if rest != place and points > largest.points:
                    largest = Imbalance(names[place], name, points)
    return largest


def difference(one: NDArray[np.float64], other: NDArray[np.float64], scale: str) -> Estimate:
    """The mean of `one` [n] against that of `other` [m] on a scale of `Outcome`."""
    if min(len(one), len(other)) < FEWEST:
        return UNKNOWN
    if scale == "points":
        return _newcombe(one, other)
    between = float(one.mean() - other.mean())
    if np.ptp(one) == 0.0 and np.ptp(other) == 0.0:
        low = high = between
    else:
        interval = stats.ttest_ind(one, other, equal_var=False).confidence_interval(LEVEL)
        low, high = float(interval.low), float(interval.high)
    estimate = Estimate(between, low, high)
    return Estimate(*np.exp(estimate).tolist()) if scale == "factor" else estimate


def _contrasts(
    code: NDArray[np.int64], readings: Readings
) -> Iterator[tuple[int, int, NDArray[np.bool_], NDArray[np.bool_]]]:
    """Yield place of the reading, of its value, and the universes with it and with the first."""
    for place, values in enumerate(readings.values()):
        others = np.delete(code, place, axis=1)
        for value in range(1, len(values)):
            groups = [code[:, place] == value, code[:, place] == 0]
            kept = comparable(others, groups)
            yield place, value, groups[0] & kept, groups[1] & kept


def _newcombe(one: NDArray[np.float64], other: NDArray[np.float64]) -> Estimate:
    """Difference of two shares with Newcombe's hybrid of Wilson's intervals (1998, method 10)."""
    a, b = (share(int(part.sum()), len(part)) for part in (one, other))
    between = a.value - b.value
    return Estimate(
        between,
        between - float(np.hypot(a.value - a.low, b.high - b.value)),
        between + float(np.hypot(a.high - a.value, b.value - b.low)),
    )


def _mean(values: NDArray[np.float64], scale: str) -> float:
    if not len(values):
        return float("nan")
    mean = float(values.mean())
    return float(np.exp(mean)) if scale == "factor" else mean

"""Which readings matter to each other: the effect of one depends on the value of the other."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from scipy import stats

from animat.report.estimates import LEVEL
from animat.report.multiverse.marginal import FEWEST, Outcome, outcomes
from animat.report.multiverse.readings import Readings, codes, comparable

STRONGEST = 10
"""Interactions of each outcome that are told."""

Groups = tuple[NDArray[np.bool_], ...]


def strongest_interactions(
    universes: pa.Table, readings: Readings, most: int = STRONGEST
) -> pa.Table:
    """For every outcome the pairs of readings whose interaction is surest to be large.

    An interaction is the effect of one reading where the other has a value, less its effect where
    the other has its first value. Columns: `outcome`, `scale`, `reading`, `value`, `against`,
    `other`, `other_value`, `other_against`, `universes` (in the smallest of the four groups),
    `effect_here`, `effect_against` and `interaction`, `low`, `high` (a difference of points, a
    factor between factors, or a difference). Intervals are simultaneous: wide enough for all
    pairs at once (Bonferroni). A row is given only where the interval excludes that there is no
    interaction; of two readings only the pair of values that shows most.
    """
    code = codes(universes, readings)
    pairs = list(_pairs(code, readings))
    rows = []
    for outcome in outcomes(universes):
        told: dict[tuple[str, str], dict[str, Any]] = {}
        for names, groups in pairs:
            row = _interaction(outcome, groups, len(pairs))
            key = (names["reading"], names["other"])
            if row["sure"] > told.get(key, {"sure": 0.0})["sure"]:
                told[key] = {"outcome": outcome.name, "scale": outcome.scale, **names, **row}
        best = sorted(told.values(), key=lambda row: -row["sure"])[:most]
        rows += [{name: row[name] for name in SCHEMA.names} for row in best]
    return pa.Table.from_pylist(rows, SCHEMA)


SCHEMA = pa.schema(
    [(name, pa.string()) for name in ("outcome", "scale", "reading", "value", "against")]
    + [(name, pa.string()) for name in ("other", "other_value", "other_against")]
    + [("universes", pa.int64())]
    + [
        (name, pa.float64())
        for name in ("effect_here", "effect_against", "interaction", "low", "high")
    ]
)


def _pairs(code: NDArray[np.int64], readings: Readings) -> Iterator[tuple[dict[str, str], Groups]]:
    """Yield what is compared with what, and its four groups: both, first, other, neither."""
    names = list(readings)
    for one, other in combinations(range(len(names)), 2):
        rest = np.delete(code, (one, other), axis=1)
        for value, other_value in product(
            range(1, len(readings[names[one]])), range(1, len(readings[names[other]]))
        ):
            masks = [
                (code[:, one] == a) & (code[:, other] == b)
                for a, b in product((value, 0), (other_value, 0))
            ]
            if any(mask.sum() < FEWEST for mask in masks):
                continue
            kept = comparable(rest, masks)
            groups = tuple(mask & kept for mask in masks)
            if all(group.sum() >= FEWEST for group in groups):
                yield (
                    {
                        "reading": names[one],
                        "value": readings[names[one]][value],
                        "against": readings[names[one]][0],
                        "other": names[other],
                        "other_value": readings[names[other]][other_value],
                        "other_against": readings[names[other]][0],
                    },
                    groups,
                )


def _interaction(outcome: Outcome, groups: Groups, tests: int) -> dict[str, float]:
    """The double difference of the four means, and how far from nothing it surely is."""
    parts = [outcome.values[group] for group in groups]
    both, first, other, neither = (float(part.mean()) for part in parts)
    half = _half_width(parts, 1.0 - (1.0 - LEVEL) / (2 * tests), outcome.scale == "points")
    here, against = both - other, first - neither
    between = here - against
    told = np.array([here, against, between, between - half, between + half])
    if outcome.scale == "factor":
        told = np.exp(told)
    row = dict(
        zip(("effect_here", "effect_against", "interaction", "low", "high"), told, strict=True)
    )
    return row | {
        "universes": min(len(part) for part in parts),
        "sure": max(0.0, abs(between) - half),
    }


def _half_width(parts: list[NDArray[np.float64]], quantile: float, of_shares: bool) -> float:
    """Half of the t interval of a sum of independent means, with Satterthwaite's degrees.

    Far out in the tails a normal interval of a few universes is much too narrow.
    """
    size = np.array([len(part) for part in parts])
    # A share of 0 or 1 in a small group has no spread of its own, so each gets one more of either.
    variance = [_share_variance(part) if of_shares else part.var(ddof=1) for part in parts]
    spread = np.array(variance) / size
    if not spread.any():
        return 0.0
    degrees = spread.sum() ** 2 / np.sum(spread**2 / (size - 1))
    return float(stats.t.ppf(quantile, degrees) * np.sqrt(spread.sum()))


def _share_variance(values: NDArray[np.float64]) -> float:
    share = (values.sum() + 1.0) / (len(values) + 2.0)
    return float(share * (1.0 - share))

"""Which readings matter to each other: the effect of one depends on the value of the other.

Universes of a sample are not all combinations. Among the points of Sobol's sequence two readings
can go together just where a third has one of its values, or where two others do: what those do then
looks like an interaction of the first two. So what each reading does by itself, and what stronger
interactions do, is taken off before a pair is looked at. That the weaker of two might have been the
true one, no such sample can tell.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, product
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.estimates import LEVEL
from animat.statistics.marginal_effects import FEWEST, Outcome, outcomes
from animat.statistics.readings import Readings, codes, comparable

STRONGEST = 10
"""Interactions of each outcome that are told."""

Groups = tuple[NDArray[np.bool_], ...]

Pair = tuple[int, int]
"""The places of two readings."""


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
    interaction; of two readings only the pair of values that shows most. The surest is found first,
    and what it does is taken off before the next one is looked for.
    """
    code = codes(universes, readings)
    pairs = list(_pairs(code, readings))
    rows = []
    for outcome in outcomes(universes):
        told: dict[Pair, dict[str, Any]] = {}
        while len(told) < most:
            own, of_pairs = effects_of(code, list(told), outcome.values)
            surest: dict[str, Any] = {"sure": 0.0}
            for pair, names, groups in pairs:
                others = np.delete(own, pair, axis=1).sum(axis=1) + of_pairs
                row = _interaction(outcome, others, groups, len(pairs))
                if pair not in told and row["sure"] > surest["sure"]:
                    surest = {"pair": pair, **names, **row}
            if not surest["sure"]:
                break
            told[surest["pair"]] = {"outcome": outcome.name, "scale": outcome.scale, **surest}
        rows += [{name: row[name] for name in SCHEMA.names} for row in told.values()]
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


def effects_of(
    code: NDArray[np.int64], pairs: Sequence[Pair], values: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What each reading adds to the values [U] of universes, [U, F], and what some pairs add, [U].

    By least squares: first as if readings only added up, then what is left by the pairs. On average
    each adds nothing. `code` is [U, F].
    """
    each = [_levels(had) for had in code.T]
    alone = np.concatenate(each, axis=1)
    weights = _fitted(alone, values - values.mean())
    ends = np.cumsum([levels.shape[1] for levels in each])[:-1]
    parts = zip(each, np.split(weights, ends), strict=True)
    own = np.stack([levels @ weight for levels, weight in parts], axis=1)
    if not pairs:
        return own, np.zeros(len(values))
    both = np.concatenate(
        [_levels(code[:, one] * (code.max() + 1) + code[:, other]) for one, other in pairs], axis=1
    )
    both -= alone @ _fitted(alone, both)
    return own, both @ _fitted(both, values - values.mean() - own.sum(axis=1))


def _levels(had: NDArray[np.int64]) -> NDArray[np.float64]:
    """A column for each of the values that universes have [U], 1 where they have it, centred."""
    levels = np.equal.outer(had, np.unique(had)).astype(np.float64)
    return levels - levels.mean(axis=0)


def _fitted(columns: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.linalg.lstsq(columns, values, rcond=1e-9)[0], dtype=np.float64)


def _pairs(
    code: NDArray[np.int64], readings: Readings
) -> Iterator[tuple[Pair, dict[str, str], Groups]]:
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
                    (one, other),
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


def _interaction(
    outcome: Outcome, of_others: NDArray[np.float64], groups: Groups, tests: int
) -> dict[str, float]:
    """The double difference of the four means, and how far from nothing it surely is.

    The means are without what other readings and pairs add, `of_others` [U]; the interval is as
    wide as if they were with it.
    """
    parts = [outcome.values[group] for group in groups]
    both, first, other, neither = (
        float((outcome.values - of_others)[group].mean()) for group in groups
    )
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

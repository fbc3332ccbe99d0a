"""Survival statistics of a table of lives.

Kaplan-Meier curves and the log-rank test are scipy's (`ecdf`, `logrank`). A mean lifespan is
restricted: lives still going on at the cap count as ending there.
"""

import math
import warnings
from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.estimates import LEVEL, RESAMPLES, UNKNOWN, Estimate, mean, of_means, share
from animat.statistics.lives import CELL, cells, column, lifespans, restriction

ALIVE = "alive at the cap"


class KaplanMeier(NamedTuple):
    """Share of lives still going on after each number of steps, with its band.

    `times`, `survival`, `low`, `high` are arrays [k]; times start at 0, where all live. The band
    is the log-log one at level `LEVEL`, pointwise.
    """

    times: NDArray[np.float64]
    survival: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    lives: int
    deaths: int

    def median(self) -> Estimate:
        """Lifespan that half the lives reach, in steps; infinite where the curve stays above."""
        return Estimate(*(self._first_half(c) for c in (self.survival, self.low, self.high)))

    def _first_half(self, curve: NDArray[np.float64]) -> float:
        below = np.flatnonzero(curve <= 0.5 + 1e-12)
        return float(self.times[below[0]]) if below.size else math.inf


class LogRank(NamedTuple):
    """The log-rank test of two groups: z statistic and two-sided p."""

    statistic: float
    p: float


class DeathCount(NamedTuple):
    """How many lives of a cell ended this way. `variable` is `ALIVE` for those that did not."""

    variable: str
    side: str
    cause: str
    count: int
    share: Estimate

    @property
    def label(self) -> str:
        """The way to die in words."""
        if self.variable == ALIVE:
            return ALIVE
        return f"{self.variable} too {self.side}, {self.cause}"


class CellSummary(NamedTuple):
    """What the report says of a cell. Lifespans in steps; `cap` infinite if every life ended."""

    cell: tuple
    lives: int
    alive: int
    cap: float
    mean: Estimate
    median: Estimate
    success_rate: Estimate
    stability: Estimate
    deaths: tuple[DeathCount, ...]


def kaplan_meier(table: pa.Table) -> KaplanMeier:
    """The survival curve of the lives in `table`. Raises ValueError if there are none."""
    spans = lifespans(table)
    if not spans.steps.size:
        raise ValueError("a survival curve needs at least one life")
    estimate = stats.ecdf(stats.CensoredData.right_censored(spans.steps, spans.censored)).sf
    with warnings.catch_warnings():
        # The formula of the band has no value where all live or none does; it is filled below.
        warnings.simplefilter("ignore", RuntimeWarning)
        band = estimate.confidence_interval(LEVEL, method="log-log")
    survival = np.concatenate([[1.0], estimate.probabilities])
    low = np.concatenate([[1.0], band.low.probabilities])
    high = np.concatenate([[1.0], band.high.probabilities])
    low[survival == 1.0] = high[survival == 1.0] = 1.0
    over = survival == 0.0
    low[over] = 0.0
    high[over] = high[~over][-1]
    times = np.concatenate([[0.0], estimate.quantiles])
    return KaplanMeier(times, survival, low, high, spans.steps.size, int((~spans.censored).sum()))


def logrank(one: pa.Table, other: pa.Table) -> LogRank:
    """Do the two groups of lives end alike? Where no death can tell, p is 1."""
    groups = [lifespans(table) for table in (one, other)]
    if all(group.censored.all() for group in groups):
        return LogRank(0.0, 1.0)
    x, y = (stats.CensoredData.right_censored(g.steps, g.censored) for g in groups)
    with np.errstate(invalid="ignore"):
        result = stats.logrank(x, y)
    if math.isnan(result.statistic):
        return LogRank(0.0, 1.0)
    return LogRank(float(result.statistic), float(result.pvalue))


def mean_lifespan(table: pa.Table, *, seed: int = 0, resamples: int = RESAMPLES) -> Estimate:
    """Mean lifespan in steps, restricted at the cap, with its bootstrap interval."""
    steps = np.minimum(lifespans(table).steps, restriction([table]))
    return mean(steps, seed=seed, resamples=resamples)


def causes(table: pa.Table) -> list[DeathCount]:
    """How the lives ended, the most frequent way first, those alive at the cap last."""
    columns = ["censored", "death_variable", "death_side", "death_cause"]
    counted = (
        table.select(columns).unify_dictionaries().group_by(columns).aggregate([([], "count_all")])
    )
    ways: dict[tuple[str, str, str], int] = Counter()
    for row in counted.to_pylist():
        way = (ALIVE, "", "") if row["censored"] else tuple(row[name] for name in columns[1:])
        ways[way] += row["count_all"]
    order = sorted(ways, key=lambda way: (way[0] == ALIVE, -ways[way], way))
    return [DeathCount(*way, ways[way], share(ways[way], table.num_rows)) for way in order]


def success_rate(table: pa.Table, *, seed: int = 0, resamples: int = RESAMPLES) -> Estimate:
    """Share of acts that succeeded, over all lives; whole lives are resampled.

    Acts of one life hang together, so that an interval over single acts would be too narrow.
    Unknown if nobody acted.
    """
    acts = column(table, "acts").astype(np.float64)
    successes = column(table, "successes").astype(np.float64)
    acted = acts > 0
    if not acted.any():
        return UNKNOWN
    return of_means([successes[acted], acts[acted]], np.divide, seed=seed, resamples=resamples)


def stability(table: pa.Table, *, seed: int = 0, resamples: int = RESAMPLES) -> Estimate:
    """Physiological stability: the mean over lives of the mean drive; lower is better.

    Cos, Cañamero and Hayes (2010).
    """
    drives = column(table, "mean_drive").astype(np.float64)
    return mean(drives, seed=seed, resamples=resamples)


def summarise(
    table: pa.Table,
    by: Sequence[str] = CELL,
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> list[CellSummary]:
    """A summary of every cell, in order of first appearance."""
    return [
        CellSummary(
            cell=key,
            lives=rows.num_rows,
            alive=int(lifespans(rows).censored.sum()),
            cap=restriction([rows]),
            mean=mean_lifespan(rows, seed=seed, resamples=resamples),
            median=kaplan_meier(rows).median(),
            success_rate=success_rate(rows, seed=seed, resamples=resamples),
            stability=stability(rows, seed=seed, resamples=resamples),
            deaths=tuple(causes(rows)),
        )
        for key, rows in cells(table, by)
    ]

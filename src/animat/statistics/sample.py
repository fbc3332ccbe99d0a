"""The lives of a study as the report reads them: once, as arrays; and some of them, summed up."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.statistics.estimates import RESAMPLES, Estimate
from animat.statistics.factors import Factor, factor
from animat.statistics.lives import column, lifespans, restriction
from animat.statistics.resampling import (
    Sets,
    codes_of,
    mean_over,
    median_over,
    numbers,
    paired,
    ratio_over,
)
from animat.statistics.survival import CellSummary, KaplanMeier, causes, kaplan_meier


@dataclass(frozen=True)
class Sample:
    """The lives of a study, read once. Arrays are [n], a life each.

    `steps` are lifespans cut at `cap`, the step up to which every life was watched (infinite if
    all died); `case` and `number` are codes. Where the design is `paired`, lives of one number
    share their starting pose and random numbers in all cases.
    """

    table: pa.Table
    factors: tuple[Factor, ...]
    steps: NDArray[np.float64]
    cap: float
    case: NDArray[np.int64]
    number: NDArray[np.int64]
    paired: bool

    def factor(self, name: str) -> Factor:
        """The factor of that name."""
        return next(each for each in self.factors if each.name == name)

    def others(self, *names: str) -> list[Factor]:
        """All factors but those of these names."""
        return [each for each in self.factors if each.name not in names]


def sample(table: pa.Table, names: Sequence[str]) -> Sample:
    """The lives of `table` for the factors `names`. Raises ValueError if a column is missing.

    `table` has the columns of a table of lives, and may have `same_as`: the case whose lives
    these are, where cases that differ in name only share theirs. It must hold at least one life.
    """
    if not table.num_rows:
        raise ValueError("there is no life to report on")
    factors = tuple(factor(table, name) for name in names)
    if "same_as" in table.column_names:
        case = np.unique(column(table, "same_as"), return_inverse=True)[1].astype(np.int64)
    else:
        case = _combinations(factors, table.num_rows)
    cap = restriction([table])
    steps = np.minimum(lifespans(table).steps, cap)
    drawn = column(table, "seed"), column(table, "life"), case
    return Sample(table, factors, steps, cap, case, numbers(*drawn), paired(*drawn))


def case_means(lives: Sample, chosen: Factor) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The first life and the restricted mean lifespan of every case, both [c].

    Cases that share their lives count once for each value of the factor.
    """
    _, first, codes = np.unique(
        codes_of(lives.case, chosen.exact), return_index=True, return_inverse=True
    )
    return first, np.bincount(codes, lives.steps) / np.bincount(codes)


def other_combinations(lives: Sample, *names: str) -> NDArray[np.int64]:
    """The combination [n] of all other factors, those that hold the very same lives as one."""
    place = _combinations(lives.others(*names), len(lives.steps))
    content = codes_of(*(lives.factor(name).exact for name in names), lives.case)
    rows = np.unique(np.stack([place, content]), axis=1)
    starts = np.flatnonzero(np.diff(rows[0], prepend=-1))
    seen: dict[bytes, int] = {}
    same = [seen.setdefault(p.tobytes(), k) for k, p in enumerate(np.split(rows[1], starts[1:]))]
    return np.array(same)[place]


def _combinations(factors: Sequence[Factor], lives: int) -> NDArray[np.int64]:
    """Which combination of the factors' values each life has: codes [lives]."""
    return codes_of(np.zeros(lives), *(each.exact for each in factors))


class Level(NamedTuple):
    """The lives at a level of a factor; `measures` are means of further columns by their name."""

    summary: CellSummary
    curve: KaplanMeier
    measures: Mapping[str, Estimate]

    @property
    def label(self) -> str:
        """The name of the level, or the values of a case's factors."""
        return ", ".join(self.summary.cell)


def level(
    lives: Sample,
    rows: NDArray[np.bool_],
    cell: tuple[str, ...],
    sets: Sets,
    measures: Sequence[str] = (),
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> Level:
    """The chosen lives [n] under the name `cell`, resampled in `sets`."""
    table = lives.table.filter(pa.array(rows))
    steps, drawn = lives.steps[rows], sets.take(rows)
    how = {"seed": seed, "resamples": resamples}
    summary = CellSummary(
        cell=cell,
        lives=table.num_rows,
        alive=int(lifespans(table).censored.sum()),
        cap=lives.cap,
        mean=mean_over(steps, drawn, **how),
        median=median_over(steps, lives.cap, drawn, **how),
        success_rate=ratio_over(
            _numbers(table, "successes"), _numbers(table, "acts"), drawn, **how
        ),
        stability=mean_over(_numbers(table, "mean_drive"), drawn, **how),
        deaths=tuple(causes(table)),
    )
    return Level(
        summary,
        kaplan_meier(table),
        {name: mean_over(_numbers(table, name), drawn, **how) for name in measures},
    )


def _numbers(table: pa.Table, name: str) -> NDArray[np.float64]:
    return column(table, name).astype(np.float64)

"""Some of a study's lives, summed up: how long they were, how they ended, what was done."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.statistics.estimates import RESAMPLES, Estimate
from animat.statistics.lives import column, lifespans
from animat.statistics.resampling import Sets, mean_over, median_over, ratio_over
from animat.statistics.sample import Sample
from animat.statistics.survival import CellSummary, KaplanMeier, causes, kaplan_meier


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

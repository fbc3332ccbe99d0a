"""The traces of a study: a row for each recorded step of the lives that are to be recorded.

A life lived again is the same life. So lives are lived first, to see how long they are, and the
steps that are wanted are lived again; the last steps from a snapshot near them, if there is one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.life.batch import Batch, BatchResult, Snapshot, advance
from animat.life.life import Moment, TraceChoice, lived
from animat.life.trace import ROW, table
from animat.names import WHICH


@dataclass(frozen=True)
class Traced:
    """Lives of a case whose traces are wanted.

    They are the first `count` of those in `result`; `lives` [L] are the indices of these,
    and `weights` [L, B, W] the networks they were born with, if they were given any.
    """

    case: int
    batch: Batch
    result: BatchResult
    lives: NDArray[np.uint64]
    weights: NDArray[np.float64] | None
    count: int

    def schema(self) -> pa.Schema:
        """Return the columns of these traces: `case`, `life`, and those of docs/tables.md."""
        setting = self.batch.setting
        none = table(np.zeros(0, ROW.dtype(setting.counts._asdict())), setting.mind, setting.world)
        names = [pa.field(name, pa.int64()) for name in WHICH]
        return pa.schema([*names, *none.schema])

    def tables(self, choice: TraceChoice, wanted: pa.Schema) -> Iterator[pa.Table]:
        """Yield the traces as rows of the `wanted` columns; a life that failed has none."""
        for row in range(self.count):
            if self.result.errors[row] is None:
                for rows in self._trace(row, choice):
                    yield self._told(rows, row, wanted)

    def _trace(self, row: int, choice: TraceChoice) -> Iterator[NDArray[np.void]]:
        setting, seed = self.batch.setting, self.batch.seed
        life = self.lives[row : row + 1]
        weights = None if self.weights is None else self.weights[row : row + 1]
        lifespan = int(self.result.states["step"][row])
        if choice.last is None:
            states, present = setting.begin(seed, life, weights)
        else:
            start = max(lifespan - choice.last, 0)
            found = _before(start, row, self.result.earlier)
            states, present = found or setting.begin(seed, life, weights)
            advance(setting, seed, life, states, present, start)
            choice = TraceChoice()
        return lived(Moment(setting, seed, int(life[0]), states, present), lifespan, choice)

    def _told(self, rows: NDArray[np.void], row: int, wanted: pa.Schema) -> pa.Table:
        setting = self.batch.setting
        told = table(rows, setting.mind, setting.world)
        columns = {
            "case": pa.array(np.full(len(rows), self.case)),
            "life": pa.array(np.full(len(rows), int(self.lives[row]))),
            **dict(zip(told.column_names, told.columns, strict=True)),
        }
        filled = [columns.get(f.name, pa.nulls(len(rows), f.type)) for f in wanted]
        return pa.table(filled, schema=wanted)


def _before(step: int, row: int, earlier: list[Snapshot]) -> Snapshot | None:
    """Return the latest snapshot of a life in which it had lived at most `step` steps."""
    for states, present in reversed(earlier):
        if states["step"][row] <= step:
            return states[row : row + 1].copy(), present[row : row + 1].copy()
    return None

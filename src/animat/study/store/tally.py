"""How much of a study is finished."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from animat.study.plan.numbering import KINDS, Kind, Numbering, Part


@dataclass
class Counts:
    """Lives, or robots that teach: how many are finished, their steps, how many of them failed."""

    rows: int = 0
    steps: int = 0
    failed: int = 0


@dataclass
class Tally:
    """What is finished, counted part by part.

    `cases` are for each place the number of cases whose lives are its lives.
    """

    numbering: Mapping[Kind, Numbering]
    cases: Sequence[int]
    counts: dict[Kind, Counts] = field(default_factory=lambda: {kind: Counts() for kind in KINDS})

    def __post_init__(self) -> None:
        """Begin with nothing."""
        self._finished = {kind: bytearray(self.numbering[kind].parts) for kind in KINDS}
        starts = self.numbering["lives"].starts
        self._missing = [stop - start for start, stop in pairwise(starts)]
        self.finished_cases = 0

    def add(self, part: Part, steps: int, failed: int) -> None:
        """Count a part that is finished, with its steps and failures; once only."""
        if self.finished(part):
            return
        self._finished[part.kind][part.number] = True
        numbering, counts = self.numbering[part.kind], self.counts[part.kind]
        counts.rows += numbering.rows(part.number)
        counts.steps += steps
        counts.failed += failed
        if part.kind == "lives":
            for place, start, stop in numbering.pieces(part.number):
                self._missing[place] -= stop - start
                if not self._missing[place]:
                    self.finished_cases += self.cases[place]

    @property
    def complete(self) -> bool:
        """Whether all lives are finished, and all robots that teach have learnt."""
        return all(self.counts[kind].rows == self.numbering[kind].total for kind in KINDS)

    def finished(self, part: Part) -> bool:
        """Tell whether a part is finished."""
        return bool(self._finished[part.kind][part.number])

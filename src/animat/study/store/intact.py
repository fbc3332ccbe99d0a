"""Whether files of results are as they were written, and where they belong.

Whoever reads results must not report what a disk has changed. Every file has its checksums in it;
and what it has to hold follows from the study, the cases and the numbering, without the custom
functions that `animat verify` needs to simulate anything again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from animat.files.checksummed import read_parquet
from animat.files.settings import SettingsError
from animat.study.file.cases import cases as cases_of
from animat.study.file.study import Study
from animat.study.plan.numbering import Kind, Numbering, Part
from animat.study.plan.plan import case_table
from animat.study.plan.shard import RUN_AGAIN, identity_of, problem_of
from animat.study.store.manifest import CASES, COLUMNS, WRITTEN_ANEW

Stamp = tuple[int, int]


@dataclass(frozen=True)
class Intact:
    """What the files of a results directory have to hold.

    A file is read once, and again only where it has changed since.
    """

    directory: Path
    engine: int
    study: Study
    cases: pa.Table
    numbering: Mapping[Kind, Numbering]
    _good: dict[Path, Stamp] = field(default_factory=dict)

    def check(self, files: Mapping[Path, Part], columns: pa.Schema | None = None) -> None:
        """Read files of parts, which have these columns if that is known.

        Raises SettingsError with a line for each that is not as it was written, or not where it
        belongs, and for a table of cases that is not the study's.
        """
        self._check_cases()
        wrong = []
        for file, part in files.items():
            stamp = _stamp(file)
            if self._good.get(file) != stamp:
                found = self.wrong(file, part)
                if found is None and columns and not pq.read_schema(file).equals(columns):
                    found = f"{file.parent / COLUMNS}: has other columns; {WRITTEN_ANEW}"
                if found is None:
                    self._good[file] = stamp
                else:
                    wrong.append(found)
        if wrong:
            raise SettingsError(*dict.fromkeys(wrong))

    def wrong(self, file: Path, part: Part, *, unread: bool = False) -> str | None:
        """Return what is wrong with a file of a part; None if nothing is.

        `unread` leaves out whether its values have changed.
        """
        own = self.directory / part.file
        rows = self.numbering[part.kind].rows(part.number) if file == own else None
        try:
            identity = identity_of(self.engine, self.study, part, list(self._lived_in(part)))
        except (OSError, KeyError, IndexError, pa.ArrowException):
            return f"{own}: is damaged; {RUN_AGAIN}"
        return problem_of(file, identity, rows, unread=unread)

    def _lived_in(self, part: Part) -> Iterator[list[Any]]:
        """Yield who lived in a part, piece by piece; of robots that teach only its file knows."""
        row = 0
        names: Any = self._lived
        if part.kind == "teachers":
            names = read_parquet(self.directory / part.file, ["identity"])["identity"]
        for place, start, stop in self.numbering[part.kind].pieces(part.number):
            if part.kind == "teachers":
                yield [names[row].as_py(), start, stop]
            else:
                yield [*names[place], start, stop]
            row += stop - start

    @cached_property
    def _lived(self) -> list[tuple[int, str]]:
        """Number and identity of each case whose lives were lived for it, by place."""
        rows = self.cases.select(["case", "identity", "same_as"]).to_pylist()
        return [(row["case"], row["identity"]) for row in rows if row["case"] == row["same_as"]]

    def _check_cases(self) -> None:
        if not self._cases_are_right:
            raise SettingsError(
                f"{self.directory / CASES}: has other cases than the study; {WRITTEN_ANEW}"
            )

    @cached_property
    def _cases_are_right(self) -> bool:
        identities = self.cases["identity"].to_pylist()
        laid_out = cases_of(self.study)
        if len(laid_out) != len(identities):
            return False
        first: dict[str, int] = {}
        same_as = [first.setdefault(own, number) for number, own in enumerate(identities)]
        return self.cases.equals(case_table(laid_out, identities, same_as))


def _stamp(file: Path) -> Stamp:
    try:
        there = file.stat()
    except OSError:
        return 0, 0
    return there.st_mtime_ns, there.st_size

"""A recording: a life in a file, from which it can be looked at, lived again, and gone on with.

It is a checksummed Parquet file. Its rows are the trace, a step each; in the first row and in those
of every n-th step three more columns keep the moment before the step; its text is the head. So to
go on from any step is to take the last moment kept at or before it, and to live on to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from animat.files import arguments
from animat.files import atomic as files
from animat.files.arguments import callback, whole
from animat.files.checksummed import verified, writing
from animat.files.settings import SettingsError
from animat.life.life import LONGEST, Life, Moment, Progress, birth, check, live_rows, lived
from animat.life.scenario import LifeError, Setting
from animat.life.trace import ROW, table
from animat.names import KEPT
from animat.recording.checkpoint import Kept, check_fields, keep, restored
from animat.recording.divergence import Difference, kept_fields, kept_in, parted
from animat.recording.header import Head, ended, head_of, read_head

EVERY = 1_000
"""After how many steps a moment is kept, unless it is said."""

BLOCK = 25_000
"""Steps in a row group: what is held in memory, and how near damage is placed."""


def write_recording(
    path: Path,
    moment: Moment,
    *,
    steps: int,
    every: int = EVERY,
    made: Mapping[str, Any],
    progress: Progress | None = None,
) -> Life:
    """Live a life on from a moment, write its recording, and return it without a trace.

    It ends by death or when it has lived `steps` steps in all. A moment is kept every `every`
    steps; `made` says how the file is made. The file is written whole or not at all.

    Raises:
        SettingsError: the life cannot be lived or recorded, or the file cannot be written.
    """
    _, _, steps = check(moment.seed, moment.index, steps)
    every = whole("every", every, 1, LONGEST, LifeError)
    if moment.state.dead or moment.step >= steps:
        raise LifeError(f"after step {moment.step} there is nothing left to live up to {steps}")
    head = head_of(moment, steps, every, made)
    moment = moment.copy()
    tell = progress or (lambda _: None)
    part = _lived_part(moment, head, BLOCK, steps)
    with (
        files.whole(path) as partial,
        partial.open("wb+") as opened,
        writing(opened, part.schema) as file,
    ):
        while part.num_rows:
            begin = moment.step - part.num_rows
            file.write(part, f"steps {begin:,} to {moment.step - 1:,}")
            tell(part.num_rows)
            part = _lived_part(moment, head, BLOCK, steps)
        file.close(ended(head, moment).json_text())
    return Life(moment.setting, moment.seed, moment.index, moment.state, None)


@dataclass(frozen=True, eq=False)
class Recording:
    """A life in a file: `head` says what it is, `file` holds its steps."""

    path: Path
    head: Head
    file: pq.ParquetFile

    @classmethod
    def load(cls, path: str | Path) -> Recording:
        """Open a recording. Raises SettingsError where the file is none, or not as it was made."""
        path = arguments.path("path", path)
        text, file = verified(path, "recording")
        with _naming(path):
            head = read_head(text)
        rows, names = file.metadata.num_rows, file.schema_arrow.names
        if head.last - head.first != rows or not rows or not set(names) > set(KEPT):
            raise SettingsError(f"{path}: its steps are not those its head tells of")
        return cls(path, head, file)

    @cached_property
    def setting(self) -> Setting:
        """The setting of the life.

        Raises SettingsError where the life cannot be lived here: another engine, a function of the
        user's own that is gone or has changed.
        """
        with _naming(self.path):
            return self.head.setting()

    @property
    def trace(self) -> pa.Table:
        """The trace of the recorded steps; a row is a step."""
        names = [name for name in self.file.schema_arrow.names if name not in KEPT]
        return self.file.read(names).unify_dictionaries()

    def at(self, step: int) -> Moment:
        """Return the life after it has lived `step` steps, to be gone on with.

        Raises SettingsError where that was not recorded, or the life cannot be lived here.
        """
        step = whole("step", step, 0, LONGEST, LifeError)
        first, last = self.head.first, self.head.last
        if not first <= step <= last:
            raise LifeError(f"{self.path}: step {step} is not recorded, only {first} to {last} are")
        before = max(first, step - step % self.head.every)
        moment = self._restored(self.head.kept_end() if step == last else self._kept(before))
        for _ in lived(moment, step, None):
            pass
        if moment.step != step:
            raise LifeError(
                f"{self.path}: lived again, this life ends after {moment.step} steps;"
                " --verify shows where it parts"
            )
        return moment

    def verify(self, progress: Progress | None = None) -> Difference | None:
        """Live the life again and return where it parts from the recording, or None.

        A life recorded from its birth is born again; another one is taken from its first moment.
        Raises SettingsError where it cannot be lived here.
        """
        callback("progress", progress, LifeError)
        head, setting = self.head, self.setting
        again = self.at(head.first) if head.first else birth(setting, head.seed, head.life)
        with _naming(self.path):
            check_fields(head.fields, again.states.dtype)
        tell = progress or (lambda _: None)
        names = head.fields, setting.mind, setting.world
        for group in range(self.file.num_row_groups):
            recorded = self.file.read_row_group(group)
            begin = again.step
            part = _lived_part(again, head, recorded.num_rows, head.last)
            if not part.schema.equals(recorded.schema):
                raise LifeError(f"{self.path}: its columns are not those of its life")
            if found := parted(recorded, part, *names):
                row, fields = found
                return Difference(begin + row, fields)
            tell(part.num_rows)
        fields = tuple(kept_fields(head.kept_end(), keep(again, head.fields), *names))
        return Difference(again.step, fields) if fields else None

    def _kept(self, step: int) -> Kept:
        """Return the moment kept before a step."""
        row = step - self.head.first
        for group in range(self.file.num_row_groups):
            rows = self.file.metadata.row_group(group).num_rows
            if row < rows:
                kept = kept_in(self.file.read_row_group(group, list(KEPT)).slice(row, 1))
                if kept is not None:
                    return kept
                break
            row -= rows
        raise LifeError(f"{self.path}: holds no state before step {step}")

    def _restored(self, kept: Kept) -> Moment:
        head, setting = self.head, self.setting
        with _naming(self.path):
            return restored(kept, head.fields, setting, head.seed, head.life)


def _lived_part(moment: Moment, head: Head, size: int, until: int) -> pa.Table:
    """Live a life on, in place, by `size` steps or up to `until`; return its rows and moments."""
    rows = np.zeros(size, ROW.dtype(moment.setting.counts._asdict()))
    kept: dict[int, Kept] = {}
    filled = 0
    while filled < size and moment.step < until and not moment.state.dead:
        past = moment.step % head.every
        if past == 0 or moment.step == head.first:
            kept[filled] = keep(moment, head.fields)
        filled += live_rows(moment, min(until, moment.step - past + head.every), rows[filled:])
    part = table(rows[:filled], moment.setting.mind, moment.setting.world)
    for name, field, kind in zip(
        KEPT, Kept._fields, (pa.binary(), pa.binary(), pa.string()), strict=True
    ):
        values = [getattr(kept[row], field) if row in kept else None for row in range(filled)]
        part = part.append_column(name, pa.array(values, kind))
    return part


@contextmanager
def _naming(path: Path) -> Iterator[None]:
    """Name the file in every line that is wrong with what it holds."""
    try:
        yield
    except SettingsError as error:
        raise type(error)(*(f"{path}: {line}" for line in error.problems)) from None

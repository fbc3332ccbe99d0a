"""A results directory read: its tables, also while they still grow.

    results = animat.study.open("results/lifespan")
    lives = results.lives(columns=["mind.agent", "lifespan"])

A row is a life of a case. Cases whose lives are the same lives were lived once; here each has them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.dataset as ds
from pydantic import ValidationError

from animat.files import arguments
from animat.files.arguments import MOST_63, instance, sequence, whole
from animat.files.checksummed import read_parquet
from animat.files.settings import SettingsError, explain, nearest, parse_text, validated
from animat.files.tables import to_pandas
from animat.files.validation_errors import brief
from animat.study.file.study import Study
from animat.study.plan.numbering import KINDS, Kind, Numbering, Part
from animat.study.plan.shard import ShardHeader, stored
from animat.study.store.intact import Intact
from animat.study.store.manifest import read_cases, read_columns, read_manifest, read_text
from animat.study.store.tally import Tally

if TYPE_CHECKING:
    import pandas as pd


OF_A_CASE = ("identity", "same_as")
"""The columns of the table of cases that are no factors, but for its number."""


class Progress(NamedTuple):
    """Lives that are finished, and all there will be; cases of equal lives count once."""

    done: int
    all: int


def open(directory: Path | str) -> Results:  # noqa: A001
    """Return the results in a directory that `animat run` made, or is making.

    Raises SettingsError where there are none.
    """
    return Results(arguments.path("directory", directory))


class Results:
    """The results of a study, as far as they are finished when they are asked for.

    `manifest` says how they were made; `cases` is the table of cases: `case`, a column for each
    factor, `identity` of its lives, and `same_as`, the case whose lives they are.
    """

    def __init__(self, directory: Path) -> None:
        """Read what the directory is about. Raises SettingsError."""
        self.directory = directory
        self.manifest: dict[str, Any] = read_manifest(directory)
        self.cases: pa.Table = read_cases(directory)

    @cached_property
    def study(self) -> Study:
        """The study, every setting written out. Raises SettingsError for one that has changed."""
        where = str(self.directory)
        try:
            return validated(parse_text(self.text, where), Study)
        except ValidationError as error:
            raise explain(error, Study, where) from None

    @cached_property
    def text(self) -> str:
        """The text of the study file. Raises SettingsError for one that has changed."""
        return read_text(self.directory, self.manifest)

    @property
    def factors(self) -> list[str]:
        """The names of the factors, in the order of the design."""
        return [n for n in self.cases.column_names if n not in {"case", *OF_A_CASE}]

    @property
    def progress(self) -> Progress:
        """How many lives are finished."""
        numbering = self.numbering["lives"]
        done = sum(numbering.rows(part.number) for part in self._finished("lives"))
        return Progress(done, numbering.total)

    @cached_property
    def numbering(self) -> dict[Kind, Numbering]:
        """How lives, and robots that teach, are numbered and cut into parts."""
        return {kind: Numbering.read(self.manifest[kind]) for kind in KINDS}

    @property
    def steps_to_learn(self) -> int:
        """The steps that all robots that teach live together."""
        return self.manifest["steps_to_learn"]

    def tally(self) -> Tally:
        """Return how much is finished, with steps and failures; reads a little of every part."""
        same = self.cases["same_as"].to_numpy()
        _, shares = np.unique(same, return_counts=True)
        tally = Tally(self.numbering, shares.tolist())
        for kind in KINDS:
            for part, said in self._finished(kind).items():
                tally.add(part, said.steps, said.failed)
        return tally

    def unusable(self) -> list[str]:
        """Return a line for every part that its file does not hold, without reading its values."""
        parts = [part for kind in KINDS for part in self._there(kind)]
        files = [(self.directory / part.file, part) for part in parts]
        try:
            found = [self._intact.wrong(file, part, unread=True) for file, part in files]
        except SettingsError as error:  # the study file has changed
            return list(error.problems)
        return [*filter(None, found)]

    def dataset(self, kind: Kind = "lives") -> ds.Dataset:
        """Return the parts that are finished as a dataset, which reads only what is asked of it.

        Its lives stand under the case they were lived for, without factors. Raises SettingsError
        where a part is not as it was written, or not where it belongs.
        """
        columns = read_columns(self.directory, _known(kind))
        files = {self.directory / part.file: part for part in self._there(kind)}
        self._intact.check(files, columns)
        return ds.dataset([*map(str, files)], schema=columns, format="parquet")

    def lives(
        self, columns: Sequence[str] | None = None, where: pc.Expression | None = None
    ) -> pa.Table:
        """Return lives with the factors of their cases, by case and life.

        `columns` are those wanted, all unless given; `where` tells which lives, such as
        `pc.field("lifespan") > 1000`. Raises SettingsError for a column there is not.
        """
        wanted = self._checked(columns)
        if where is not None:
            instance("where", where, pc.Expression)
        needed = None if where is not None else {*wanted, "case", "life"}
        batches = [
            batch if where is None else _filtered(batch, where) for batch in self.batches(needed)
        ]
        table = pa.concat_tables(batches).unify_dictionaries()
        return _in_order(table).select(wanted).combine_chunks()

    def batches(self, columns: set[str] | None = None) -> Iterator[pa.Table]:
        """Yield lives with the factors of their cases, some thousands at a time, at least once.

        They come in the order in which they are numbered, `case` always among the columns.
        """
        dataset = self.dataset()
        if columns is not None:
            self._checked(list(instance("columns", columns, Set)))
            columns = {*columns, "case"}
        stored = [n for n in dataset.schema.names if columns is None or n in columns]
        factors = [n for n in self.factors if columns is None or n in columns]
        yield self._with_factors(dataset.schema.empty_table().select(stored), factors)
        batches = dataset.to_batches(columns=stored)
        while True:
            with _whole(self.directory):
                batch = next(batches, None)
            if batch is None:
                return
            yield self._with_factors(pa.table(batch), factors)

    def to_pandas(self) -> pd.DataFrame:
        """Return all lives as a pandas table; needs pandas (`pip install animat[pandas]`)."""
        return to_pandas(self.lives())

    def teachers(self) -> pa.Table:
        """Return the robots that learnt: `identity` of their class, `robot`, weights, likelihoods.

        Without any it has no columns.
        """
        with _whole(self.directory):
            return self.dataset("teachers").to_table()

    def curves(self, kind: Kind = "lives") -> pa.Table:
        """Return the learning curves of lives, or of the robots that teach; empty without any."""
        return self._beside("curves", _known(kind), kind)

    def traces(self) -> pa.Table:
        """Return the traces of the lives that were recorded; empty without any."""
        return self._beside("traces", "lives", "part")

    def failures(self, count: int) -> list[str]:
        """Return the first of the lives that failed, in words, at most `count` of them."""
        count = whole("count", count, 0, MOST_63)
        with _whole(self.directory):
            failed = self.dataset().head(count, filter=pc.field("error").is_valid())
        told = []
        for row in failed.select(["case", "life", "error"]).to_pylist():
            values = self.cases.slice(row["case"], 1).to_pylist()[0]
            factors = "".join(f", {name} = {values[name]}" for name in self.factors)
            told.append(f"case {row['case']}{factors}, life {row['life']}: {row['error']}")
        return told

    def _finished(self, kind: Kind) -> dict[Part, ShardHeader]:
        """Return the parts that are there, with their headers; damaged files are left out."""
        found = {}
        for part in self._there(kind):
            said = stored(self.directory / part.file)
            if said is not None and said.rows == self.numbering[kind].rows(part.number):
                found[part] = said
        return found

    def _there(self, kind: Kind) -> Iterator[Part]:
        """Yield the parts that have a file, whatever is in it."""
        numbering = self.numbering[kind]
        for path in sorted((self.directory / kind).glob("part-*.parquet")):
            number = path.stem.removeprefix("part-")
            part = Part(kind, int(number) if number.isdecimal() else numbering.parts)
            if part.number < numbering.parts and path == self.directory / part.file:
                yield part

    @cached_property
    def _intact(self) -> Intact:
        engine = self.manifest["engine"]
        return Intact(self.directory, engine, self.study, self.cases, self.numbering)

    def _beside(self, folder: str, kind: Kind, prefix: str) -> pa.Table:
        """Return what is kept beside the lives that are finished."""
        own = {f"{prefix}-{part.number:06d}.parquet": part for part in self._there(kind)}
        files = {
            path: part
            for name, part in own.items()
            if (path := self.directory / folder / name).exists()
        }
        self._intact.check(files)
        with _whole(self.directory):
            tables = [read_parquet(file) for file in files]
        if not tables:
            return pa.table({})
        return pa.concat_tables(tables, promote_options="default").unify_dictionaries()

    def _checked(self, columns: Sequence[str] | None) -> list[str]:
        known = ["case", *self.factors]
        known += [name for name in self.dataset().schema.names if name != "case"]
        for name in () if columns is None else sequence("columns", columns, str):
            if name not in known:
                raise SettingsError(f'lives have no column "{name}"{nearest(name, known)}')
        return known if columns is None else list(columns)

    @cached_property
    def _members(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The cases sorted by whose lives they have, and where those of each begin and end."""
        same = self.cases["same_as"].to_numpy()
        order = np.argsort(same, kind="stable")
        cases = np.arange(len(same))
        begin = np.searchsorted(same[order], cases)
        return order, begin, np.searchsorted(same[order], cases, side="right")

    def _with_factors(self, lives: pa.Table, factors: list[str]) -> pa.Table:
        """Return lives under every case that has them, with the factors of it."""
        order, begin, end = self._members
        lived_for = lives["case"].to_numpy()
        times = end[lived_for] - begin[lived_for]
        rows = np.repeat(np.arange(len(lived_for)), times)
        first = np.cumsum(times) - times
        cases = order[begin[lived_for][rows] + np.arange(len(rows)) - first[rows]]
        if len(rows) > len(lived_for):
            lives = lives.take(pa.array(rows))
        columns: dict[str, Any] = {"case": pa.array(cases, pa.int64())}
        for name in factors:
            values = self.cases[name].combine_chunks()
            coded = values.dictionary_encode() if pa.types.is_string(values.type) else values
            columns[name] = coded.take(pa.array(cases))
        rest = {name: lives[name] for name in lives.column_names if name != "case"}
        return pa.table({**columns, **rest})


def _filtered(lives: pa.Table, where: pc.Expression) -> pa.Table:
    try:
        return lives.filter(where)
    except pa.ArrowException as error:
        why = " ".join(str(error).split())
        raise SettingsError(f"where = {brief(where)}: {why}") from None


def _known(kind: Kind) -> Kind:
    if not isinstance(kind, str) or kind not in KINDS:
        raise SettingsError(f"kind = {brief(kind)}; allowed are {', '.join(KINDS)}")
    return kind


@contextmanager
def _whole(directory: Path) -> Iterator[None]:
    """Say of what has changed on the disk how to find it. Raises SettingsError."""
    try:
        yield
    except (OSError, pa.ArrowException) as error:
        why = " ".join(str(error).split())
        raise SettingsError(
            f"{directory}: a file cannot be read ({why}); animat verify says which"
        ) from None


def _in_order(lives: pa.Table) -> pa.Table:
    """Return lives by case and life."""
    case, life = lives["case"].to_numpy(), lives["life"].to_numpy()
    if np.all((np.diff(case) > 0) | ((np.diff(case) == 0) & (np.diff(life) >= 0))):
        return lives
    return lives.take(pa.array(np.lexsort((life, case))))

"""The universes of a study: its readings, and which case is which cell of which universe.

The study of a multiverse is one like any other. Its factor `cell` has the four cells of
Experiment 2; every other factor with values or levels is a reading. What is spread over a range,
such as the seed of a layout, is none, but differs from universe to universe.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.files.settings import SettingsError
from animat.statistics.claims import CELLS
from animat.statistics.numerals import numeral
from animat.study.file.factors import Range, Scalar
from animat.study.file.study import Study

CELL = "cell"

CELL_NAMES = tuple(f"{world} {agent}" for world, agent in CELLS)


class Reading(NamedTuple):
    """A reading in words, the factor it is, and its values as the design and the report have them.

    The first value is the one that the others are compared with.
    """

    name: str
    factor: str
    values: tuple[Scalar, ...]

    @property
    def labels(self) -> tuple[str, ...]:
        """The values in words."""
        return tuple(map(label, self.values))


class Universes(NamedTuple):
    """The universes of a study: the values of all readings [U], and the cases [U, 4] of `CELLS`."""

    readings: tuple[Reading, ...]
    values: tuple[tuple[str, ...], ...]
    cases: NDArray[np.int64]

    def names(self) -> dict[str, tuple[str, ...]]:
        """The values of each reading by its name, as the report wants them."""
        return {reading.name: reading.labels for reading in self.readings}

    def columns(self) -> dict[str, pa.Array]:
        """A column for each reading, [U]."""
        each = zip(*self.values, strict=True)
        return {
            reading.name: pa.array(column)
            for reading, column in zip(self.readings, each, strict=True)
        }


def readings_of(study: Study) -> tuple[Reading, ...]:
    """Return the readings of a study, in the order of its design.

    Raises SettingsError for a study that is no multiverse.
    """
    cell = study.design.grid.get(CELL)
    if not isinstance(cell, dict) or set(cell) != set(CELL_NAMES) or study.design.cases:
        raise SettingsError(
            f"{study.name}: is no multiverse; it needs a factor [design.grid.{CELL}] with the"
            f" levels {', '.join(CELL_NAMES)}, and no listed cases"
        )
    if study.teacher is None or not study.paired:
        raise SettingsError(
            f"{study.name}: a multiverse needs a [teacher], and paired = true: AF and BLIND are to"
            " share their random numbers"
        )
    factors = {
        name: tuple(levels)
        for name, levels in spread_factors(study).items()
        if not isinstance(levels, Range)
    }
    if not factors:
        raise SettingsError(f"{study.name}: has no reading: no factor but {CELL}")
    if "steps" in factors:
        raise SettingsError(f"{study.name}: steps is no reading; all universes need one cap")
    return tuple(
        Reading(name, factor, values)
        for name, (factor, values) in zip(_names(factors), factors.items(), strict=True)
    )


def spread_factors(study: Study) -> dict[str, Any]:
    """Return the factors of a study but for the cell: values, levels or ranges."""
    grid = {name: levels for name, levels in study.design.grid.items() if name != CELL}
    return grid | (study.design.sample.over if study.design.sample else {})


def universes_of(
    study: Study, cases: pa.Table, readings: tuple[Reading, ...] | None = None
) -> Universes:
    """Return the universes of a study, in the order of its cases.

    `cases` is the table of cases; `readings` are those of the study unless given, as of a study
    that has only some of their values. Raises SettingsError for a study that is no multiverse.
    """
    readings = readings or readings_of(study)
    factors = [name for name in spread_factors(study) if name in cases.column_names]
    number: dict[tuple[Any, ...], int] = {}
    values: list[tuple[str, ...]] = []
    found: list[list[int]] = []
    columns = [cases.column(name).to_pylist() for name in factors]
    had = [factors.index(reading.factor) for reading in readings]
    for case, cell, *point in zip(
        cases.column("case").to_pylist(), cases.column(CELL).to_pylist(), *columns, strict=True
    ):
        universe = number.setdefault(tuple(point), len(number))
        if universe == len(values):
            values.append(tuple(label(point[place]) for place in had))
            found.append([-1] * len(CELLS))
        found[universe][CELL_NAMES.index(cell)] = case
    order = np.array(found, dtype=np.int64)
    return Universes(readings, tuple(values), order)


def label(value: Scalar) -> str:
    """Return a value in words: true, 0.2, clamp."""
    if isinstance(value, bool):
        return str(value).lower()
    return numeral(value) if isinstance(value, float) else str(value)


def _names(factors: Mapping[str, Any]) -> Iterator[str]:
    """Yield each factor in words: the last part of its key, or all of it where two have that."""
    last = {factor: factor.rpartition(".")[2].replace("_", " ") for factor in factors}
    often = Counter(last.values())
    for factor, name in last.items():
        yield name if often[name] == 1 else factor

"""The axes of a design: what its combinations are made of.

Each factor of the grid is an axis; so are the points of a sample, and the list of cases.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from animat.files.validation_errors import allowed_types
from animat.study.file.design import Design
from animat.study.file.factors import Levels, Range, Scalar, Values, identity
from animat.study.file.keys import Key, annotation_of, read_key
from animat.study.file.sampling import Sample
from animat.study.file.settings import CaseSettings


class Option(NamedTuple):
    """One way an axis can be: the values of its factors, and the settings that these stand for."""

    factors: dict[str, Scalar]
    changes: dict[Key, Any]


Axis = Sequence[Option]
Combination = tuple[int, ...]
"""The number of an option of every axis."""


def size(design: Design) -> int:
    """Return the number of combinations, those left out included."""
    points = design.sample.size if design.sample else 1
    return math.prod(map(len, design.grid.values())) * points * max(1, len(design.cases))


def axes(design: Design, base: CaseSettings) -> list[Axis]:
    """Return the axes of a design, the slowest first; `base` is what it varies.

    Raises UnknownKeyError for keys that are none.
    """
    found: list[Axis] = [options(name, levels) for name, levels in design.grid.items()]
    if design.sample:
        found.append(_points(design.sample))
    if design.cases:
        found.append(_rows(design.cases, base))
    return found


def options(name: str, levels: Values | Levels) -> list[Option]:
    """Return the options of a factor. Raises UnknownKeyError for keys that are none."""
    if isinstance(levels, dict):
        return [
            Option({name: level}, {read_key(key): value for key, value in settings.items()})
            for level, settings in levels.items()
        ]
    return [Option({name: value}, {read_key(name): value}) for value in levels]


def combinations(axes: Sequence[Axis]) -> Iterator[Combination]:
    """Yield every combination, the first axis varying slowest."""
    return itertools.product(*(range(len(axis)) for axis in axes))


def factors(axes: Sequence[Axis], combination: Combination) -> dict[str, Scalar]:
    """Return the values of the factors in a combination, in the order of the design."""
    return {
        name: value
        for axis, number in zip(axes, combination, strict=True)
        for name, value in axis[number].factors.items()
    }


def left_out(design: Design, axes: Sequence[Axis], combination: Combination) -> int | None:
    """Return the number of the first rule that leaves a combination out, None if none does."""
    if not design.exclude:
        return None
    values = factors(axes, combination)
    for number, rule in enumerate(design.exclude):
        if all(
            name in values and identity(values[name]) in map(identity, rule.listed(name))
            for name in rule.when
        ):
            return number
    return None


def is_whole(key: Key) -> bool:
    """Tell whether the numbers of a setting are whole ones."""
    return int in allowed_types(annotation_of(CaseSettings, key))


def _points(sample: Sample) -> list[Option]:
    columns = [
        [_at(name, over, float(share)) for share in shares]
        for (name, over), shares in zip(sample.over.items(), sample.shares().T, strict=True)
    ]
    return [_together(point) for point in zip(*columns, strict=True)]


def _at(name: str, over: Range | Values | Levels, share: float) -> Option:
    """Return what a factor is at a share of its range or of its list."""
    if isinstance(over, Range):
        key = read_key(name)
        value = over.at(share, is_whole(key))
        return Option({name: value}, {key: value})
    choice = options(name, over)
    return choice[int(share * len(choice))]


def _together(point: Sequence[Option]) -> Option:
    return Option(
        {name: value for option in point for name, value in option.factors.items()},
        {key: value for option in point for key, value in option.changes.items()},
    )


def _rows(rows: Sequence[dict[str, Scalar]], base: CaseSettings) -> list[Option]:
    """Return listed cases; a key that a row leaves out has the value of `base`, if there is one."""
    names = dict.fromkeys(name for row in rows for name in row)
    return [
        Option(
            {
                name: value
                for name in names
                if (value := row.get(name, _in_force(base, read_key(name)))) is not None
            },
            {read_key(name): value for name, value in row.items()},
        )
        for row in rows
    ]


def _in_force(base: CaseSettings, key: Key) -> Scalar | None:
    here: Any = base
    for part in key:
        here = here.get(part) if isinstance(here, dict) else getattr(here, part, None)
    return here if isinstance(here, bool | int | float | str) else None

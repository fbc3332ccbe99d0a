"""What can be wrong with a design, told where it stands in the study file.

Every value is held against its setting alone first; whether values go together shows in the cases.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import Any, NamedTuple

from pydantic import ValidationError

from animat.files.settings import validated
from animat.files.validation_errors import (
    Mistake,
    allowed_types,
    is_model,
    mistakes_found,
    nearest,
    plain,
    written,
)
from animat.names import LIVES, OF_A_STUDY, column_like, malformed
from animat.study.file.axes import size
from animat.study.file.design import Design
from animat.study.file.factors import Range, Scalar, identity
from animat.study.file.keys import (
    Key,
    UnknownKeyError,
    annotation_of,
    known_keys,
    put,
    read_key,
    table_of,
)
from animat.study.file.settings import CaseSettings

MOST_CASES = 100_000
"""Combinations of a design, those left out included."""

VARIES = tuple(CaseSettings.model_fields)

Place = tuple[str | int, ...]


class Given(NamedTuple):
    """A value of a setting, where in a design it and its key stand, and if it ends a range."""

    factor: Place
    key_place: Place
    place: Place
    key: str
    value: Any
    is_end: bool = False


def design_mistakes(design: Design, base: dict[str, Any]) -> list[Mistake]:
    """Return what is wrong with a design over `base`, settings as TOML has them."""
    if size(design) > MOST_CASES:
        line = f"makes {size(design):,} combinations; allowed are up to {MOST_CASES:,}"
        return [Mistake(("design",), "", line)]
    given = list(_given(design))
    found = [mistake for one in given for mistake in _value_mistakes(one, base)]
    return [*_own_names(design), *found, *_overlaps(given), *_rows(design), *_exclusions(design)]


def without(design: Design, found: Iterable[Mistake]) -> Design | None:
    """Return the design without what is wrong with it; None if that would be another design.

    What is left shows whether there is more to tell.
    """
    bad = {mistake.key[1:4] for mistake in found}
    bad_rows = {key[1] for key in bad if key[:1] == ("cases",)}
    rows = [row for number, row in enumerate(design.cases) if number not in bad_rows]
    grid: dict[str, Any] = {}
    for name, levels in design.grid.items():
        if isinstance(levels, dict):
            good = {level: c for level, c in levels.items() if ("grid", name, level) not in bad}
        else:
            good = [value for n, value in enumerate(levels) if ("grid", name, n) not in bad]
        if ("grid", name) not in bad:
            grid[name] = good
    elsewhere = any(key[:1] not in {("grid",), ("cases",)} for key in bad)
    factor_lost = not all(grid.values()) or bool(rows) != bool(design.cases)
    rule_lost = len(grid) < len(design.grid) and design.exclude
    if elsewhere or factor_lost or rule_lost:
        return None
    return design.model_copy(update={"grid": grid, "cases": rows})


def _factors(design: Design) -> Iterator[tuple[Place, str, Any]]:
    """Yield place, name and levels of every factor of grid and sample."""
    for name, levels in design.grid.items():
        yield ("design", "grid", name), name, levels
    if design.sample:
        for name, levels in design.sample.over.items():
            yield ("design", "sample", "over", name), name, levels


def _given(design: Design) -> Iterator[Given]:
    for place, name, levels in _factors(design):
        if isinstance(levels, Range):
            for end in ("low", "high"):
                yield Given(place, place, (*place, end), name, getattr(levels, end), True)
        elif isinstance(levels, dict):
            for level, changes in levels.items():
                for key, value in changes.items():
                    at = (*place, level, key)
                    yield Given(place, at, at, key, value)
        else:
            for number, value in enumerate(levels):
                yield Given(place, place, (*place, number), name, value)
    for number, row in enumerate(design.cases):
        for key, value in row.items():
            at = ("design", "cases", number, key)
            yield Given(("design", "cases"), at, at, key, value)


def varied_keys(design: Design) -> set[Key]:
    """Return the keys of the settings that a design sets, those that are keys."""
    keys = set()
    for given in _given(design):
        with suppress(UnknownKeyError):
            keys.add(read_key(given.key))
    return keys


def _own_names(design: Design) -> Iterator[Mistake]:
    """Tell of factors with a name of one's own that cannot be called so."""
    seen: set[str] = set()
    for place, name, levels in _factors(design):
        if not isinstance(levels, dict):
            continue
        if name in VARIES:
            line = f'is a section; for the values of a setting quote its key, "{name}.KEY" = [...]'
        elif not name or "." in name:
            line = "a factor with levels needs a name of your own, without a dot"
        elif problem := malformed(name):
            line = problem
        elif column := column_like(name, LIVES, OF_A_STUDY):
            line = f"is called like the column {column} of a table; give it another name"
        elif name in seen:
            line = "another factor has this name"
        else:
            seen.add(name)
            for level in levels:
                if problem := malformed(level):
                    yield Mistake((*place, level), "", problem)
            continue
        yield Mistake(place, "", line)


def _value_mistakes(given: Given, base: dict[str, Any]) -> Iterator[Mistake]:
    """Tell what is wrong with a value, whatever the others are."""
    try:
        key = _varying(given.key, base)
        data = {key[0]: copy.deepcopy(base[key[0]])} if key[0] in base else {}
        put(data, CaseSettings, key, given.value)
    except UnknownKeyError as error:
        yield Mistake(given.key_place, "", str(error))
        return
    annotation = annotation_of(CaseSettings, key)
    holder = table_of(annotation_of(CaseSettings, key[:-1]))
    if isinstance(given.value, dict) and is_model(holder) and is_model(table_of(annotation)):
        line = f'is a section; give its settings one by one, "{given.key}.KEY" = VALUE'
        yield Mistake(given.place, "", line)
        return
    if given.is_end and not {int, float} & set(allowed_types(annotation)):
        yield Mistake(given.key_place, "", "is no number, so it has no range; give a list")
        return
    try:
        validated(data, CaseSettings)
    except ValidationError as error:
        for mistake in mistakes_found(error, CaseSettings):
            if mistake.key[: len(key)] == key:
                yield mistake._replace(key=(*given.place, *mistake.key[len(key) :]))


def _varying(text: str, base: dict[str, Any]) -> Key:
    key = read_key(text)
    if key[0] not in VARIES:
        close = nearest(written(key), known_keys(base, CaseSettings))
        if "did you mean" not in close:
            close = f"; keys begin with {', '.join(VARIES)}"
        raise UnknownKeyError(f"is no setting that may vary{close}")
    return key


def _overlaps(given: Iterable[Given]) -> Iterator[Mistake]:
    """Tell of settings that two factors set, or one as a whole and one in a part."""
    owners: dict[Key, Place] = {}
    above: dict[Key, Place] = {}
    for one in given:
        try:
            key = read_key(one.key)
        except UnknownKeyError:
            continue
        prefixes = [key[:length] for length in range(1, len(key) + 1)]
        others = [owners.get(prefix) for prefix in prefixes] + [above.get(key)]
        for other in others:
            if other is not None and other != one.factor:
                yield Mistake(one.key_place, "", f"{written(other)} sets {one.key}, too")
                break
        owners.setdefault(key, one.factor)
        for prefix in prefixes[:-1]:
            above.setdefault(prefix, one.factor)


def _rows(design: Design) -> Iterator[Mistake]:
    """Tell of cases that are listed twice."""
    seen: dict[Any, int] = {}
    for number, row in enumerate(design.cases):
        mark = frozenset((key, identity(value)) for key, value in row.items())
        if (first := seen.setdefault(mark, number)) != number:
            yield Mistake(("design", "cases", number), "", f"is the same as design.cases[{first}]")


def _exclusions(design: Design) -> Iterator[Mistake]:
    """Tell of rules that name factors or values that there are not."""
    known: dict[str, list[Scalar] | None] = {}
    for _, name, levels in _factors(design):
        known[name] = None if isinstance(levels, Range) else list(levels)
    for key in {key for row in design.cases for key in row}:
        values = [row[key] for row in design.cases if key in row]
        known[key] = values if len(values) == len(design.cases) else []
    for number, rule in enumerate(design.exclude):
        for name in rule.when:
            place = ("design", "exclude", number, "when", name)
            if name not in known:
                yield Mistake(place, "", f"is no factor of the design{nearest(name, known)}")
                continue
            levels = known[name]
            if levels is None:
                yield Mistake(place, "", "is spread over a range, of which no value can be named")
            for value in rule.listed(name) if levels else ():
                if identity(value) not in map(identity, levels or ()):
                    hint = nearest(str(value), map(str, levels or ()))
                    yield Mistake(place, "", f"{plain(value)} is none of its values{hint}")

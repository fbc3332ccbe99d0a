"""The design of a study: what is varied, and the cases that come of it."""

from __future__ import annotations

import copy
import itertools
import json
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from pydantic import Field, ValidationError

from animat.mistakes import allowed_types, mistakes, nearest, written
from animat.settings import Settings, SettingsError, validated
from animat.study.keys import Key, UnknownKeyError, annotation_of, put, read_key
from animat.study.sampling import Levels, Range, Sample, Scalar
from animat.study.settings import PUBLISHED, LifeSettings, WorldChoice

if TYPE_CHECKING:
    from animat.study.study import Study, Teacher

MOST_CASES = 100_000
"""Combinations of a design, those left out included."""

MOST_LINES = 20
"""Mistakes of a design that are told one by one."""


class Exclusion(Settings):
    """Combinations left out: where every factor named has one of the values given, and why."""

    when: Annotated[dict[str, Scalar | list[Scalar]], Field(min_length=1)]
    why: Annotated[str, Field(min_length=1)]


class Design(Settings):
    """Every combination of the grid's factors, the sample's points and the cases listed."""

    grid: dict[str, list[Scalar] | Levels] = {}
    sample: Sample | None = None
    cases: list[dict[str, Scalar]] = []
    exclude: list[Exclusion] = []

    def to_toml(self) -> str:
        """Return the design as a part of a study file; the order of factors is kept."""
        text = ""
        if self.grid:
            text += "\n[design.grid]\n" + _lines(self.grid)
        if self.sample is not None:
            sample = self.sample.model_dump(mode="json")
            over = sample.pop("over")
            text += "\n[design.sample]\n" + _lines(sample)
            text += "\n[design.sample.over]\n" + _lines(over)
        for row in self.cases:
            text += "\n[[design.cases]]\n" + _lines(row)
        for exclusion in self.exclude:
            text += "\n[[design.exclude]]\n" + _lines(exclusion.model_dump(mode="json"))
        return text


class Case(NamedTuple):
    """A case: what is lived in it, and the values of the factors that make it this case.

    Its lives are those of `seed` from `first` on, up to `steps` steps each; an AF has the networks
    of its `teacher`. `settings` name no world of the study's: each stands in its place.
    """

    number: int
    factors: dict[str, Scalar]
    settings: LifeSettings
    seed: int
    steps: int
    teacher: Teacher | None
    first: int


class Excluded(NamedTuple):
    """Combinations that a rule left out, and its reason."""

    why: str
    count: int


class Option(NamedTuple):
    """One way an axis of the design can be: its factors' values, and the settings they set."""

    factors: dict[str, Scalar]
    changes: dict[Key, Any]


def cases(study: Study) -> list[Case]:
    """Return the cases of a study, the first factor varying slowest.

    Raises:
        SettingsError: a design that cannot be, or cases that cannot be lived.
    """
    return list(_cases(study, list(_combinations(study.design))))


def excluded(study: Study) -> list[Excluded]:
    """Return how many combinations each rule leaves out, each counted for the first that does."""
    counts = [0] * len(study.design.exclude)
    for combination in itertools.product(*_axes(study.design)):
        rule = _rule(study.design, _factors(combination))
        if rule is not None:
            counts[rule] += 1
    return [
        Excluded(rule.why, count) for rule, count in zip(study.design.exclude, counts, strict=True)
    ]


def _combinations(design: Design) -> Iterator[tuple[Option, ...]]:
    for combination in itertools.product(*_axes(design)):
        if _rule(design, _factors(combination)) is None:
            yield combination


def _axes(design: Design) -> list[list[Option]]:
    from animat.study.study import CaseSettings

    sizes = [len(levels) for levels in design.grid.values()]
    sizes += [design.sample.points] if design.sample else []
    sizes += [len(design.cases)] if design.cases else []
    if math.prod(sizes) > MOST_CASES:
        raise SettingsError(
            f"design: makes {math.prod(sizes):,} combinations; allowed are {MOST_CASES:,}"
        )
    axes = [_options(name, levels) for name, levels in design.grid.items()]
    if design.sample:
        points = []
        for shares in design.sample.shares():
            point = Option({}, {})
            for (name, over), share in zip(design.sample.over.items(), shares, strict=True):
                if isinstance(over, Range):
                    key = read_key(name)
                    kinds = allowed_types(annotation_of(CaseSettings, key))
                    value = over.at(float(share), int in kinds)
                    option = Option({name: value}, {key: value})
                else:
                    options = _options(name, over)
                    option = options[int(share * len(options))]
                point.factors.update(option.factors)
                point.changes.update(option.changes)
            points.append(point)
        axes.append(points)
    if design.cases:
        axes.append([Option(row, {read_key(k): v for k, v in row.items()}) for row in design.cases])
    return axes


def _options(name: str, levels: list[Scalar] | Levels) -> list[Option]:
    if isinstance(levels, dict):
        return [
            Option({name: level}, {read_key(k): v for k, v in changes.items()})
            for level, changes in levels.items()
        ]
    return [Option({name: value}, {read_key(name): value}) for value in levels]


def _factors(combination: tuple[Option, ...]) -> dict[str, Scalar]:
    return {name: value for option in combination for name, value in option.factors.items()}


def _rule(design: Design, factors: dict[str, Scalar]) -> int | None:
    for number, rule in enumerate(design.exclude):
        if all(
            factors.get(name) in (values if isinstance(values, list) else [values])
            for name, values in rule.when.items()
        ):
            return number
    return None


def _cases(study: Study, combinations: list[tuple[Option, ...]]) -> Iterator[Case]:
    from animat.study.study import CaseSettings

    base = study.model_dump(
        mode="json", include=set(CaseSettings.model_fields), exclude_unset=True, exclude_none=True
    )
    problems = []
    for number, combination in enumerate(combinations):
        data = copy.deepcopy(base)
        try:
            for option in combination:
                for key, value in option.changes.items():
                    put(data, CaseSettings, key, value)
            own = validated(data, CaseSettings)
            world = _resolved(own.world, own.worlds)
            teacher = own.teacher
            if own.mind.agent != "AF":
                teacher = None
            elif teacher is None:
                raise SettingsError("agent AF needs networks: say in [teacher] who learnt them")
            else:
                teacher = teacher.model_copy(update={"world": _resolved(teacher.world, own.worlds)})
        except ValidationError as error:
            problems += mistakes(error, CaseSettings)
            continue
        except (UnknownKeyError, SettingsError) as error:
            problems.append(str(error))
            continue
        yield Case(
            number,
            _factors(combination),
            LifeSettings(world=world, robot=own.robot, mind=own.mind),
            study.seed,
            own.steps,
            teacher,
            0 if study.paired else number * study.lives,
        )
    if problems:
        raise SettingsError(*dict.fromkeys(problems))


def _resolved(choice: WorldChoice, worlds: dict[str, WorldChoice]) -> WorldChoice:
    """Return the world chosen; of one of the study's own, with what is set beside its name."""
    if choice.layout in worlds:
        own = worlds[choice.layout]
        beside = {name: getattr(choice, name) for name in choice.model_fields_set - {"layout"}}
        named = {"name": own.name or choice.layout}
        return WorldChoice(**{**own.model_dump(), **named, **beside})
    if choice.layout in {*PUBLISHED, "random"} or choice.layout.endswith(".toml"):
        return choice
    known = [*PUBLISHED, *worlds]
    raise SettingsError(
        f'world "{choice.layout}": no such world, and no .toml file of one'
        f"{nearest(choice.layout, known)}"
    )


def _lines(table: dict[str, Any]) -> str:
    return "".join(f"{written((key,))} = {_inline(value)}\n" for key, value in table.items())


def _inline(value: Any) -> str:
    """Return a value as TOML on one line."""
    if isinstance(value, Range):
        return _inline(value.model_dump())
    if isinstance(value, dict):
        pairs = (f"{json.dumps(key)} = {_inline(inner)}" for key, inner in value.items())
        return "{ " + ", ".join(pairs) + " }" if value else "{}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    return json.dumps(value)

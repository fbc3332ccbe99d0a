"""The design of a study: what is varied, and the cases that come of it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import tomli_w
from pydantic import AfterValidator, Field

from animat.arguments import instance
from animat.settings import Settings, SettingsError
from animat.study.design.axes import axes, combinations, factors, left_out
from animat.study.design.factors import Factor, Scalar, Value, Values
from animat.study.design.refusals import design_mistakes, without
from animat.study.design.sampling import Sample
from animat.study.design.sections import resolver
from animat.study.design.settings import LifeSettings, Teacher
from animat.study.design.telling import InCases, told

if TYPE_CHECKING:
    from animat.study.design.study import Study


def _one_line(text: str) -> str:
    if not text.isprintable():
        raise ValueError("must be one line of what can be printed")
    return text


class Exclusion(Settings):
    """Combinations left out: where every factor named has one of the values given, and why."""

    when: Annotated[dict[str, Value | Values], Field(min_length=1)]
    why: Annotated[str, Field(min_length=1), AfterValidator(_one_line)]

    def listed(self, factor: str) -> list[Scalar]:
        """Return the values of a factor that are left out."""
        values = self.when[factor]
        return values if isinstance(values, list) else [values]


class Design(Settings):
    """Every combination of the grid's factors, the sample's points and the cases listed."""

    grid: dict[str, Factor] = {}
    sample: Sample | None = None
    cases: list[Annotated[dict[str, Value], Field(min_length=1)]] = []
    exclude: list[Exclusion] = []

    def to_toml(self) -> str:
        """Return the design as a part of a study file, with its factors in their order."""
        # TOML writes inner tables after all values, which would change the order of factors.
        data = self.model_dump(mode="json", exclude_none=True)
        text = ""
        if data["grid"]:
            text += "\n[design.grid]\n" + _lines(data["grid"])
        if "sample" in data:
            over = data["sample"].pop("over")
            text += "\n[design.sample]\n" + _lines(data["sample"])
            text += "\n[design.sample.over]\n" + _lines(over)
        for name in ("cases", "exclude"):
            for row in data[name]:
                text += f"\n[[design.{name}]]\n" + _lines(row)
        return text


class Case(NamedTuple):
    """A case: what is lived in it, and the values of the factors that make it this case.

    Its lives are those of `seed` from `first` on, up to `steps` steps each; an AF has the networks
    of its `teacher`, other agents have none. No name of a world of the study is left in `settings`
    and `teacher`: the world stands in its place.
    """

    number: int
    factors: dict[str, Scalar]
    settings: LifeSettings
    seed: int
    steps: int
    teacher: Teacher | None
    first: int


class Excluded(NamedTuple):
    """How many combinations a rule left out, and its reason."""

    why: str
    count: int


def cases(study: Study) -> list[Case]:
    """Return the cases of a study, the first factor varying slowest, numbered from 0.

    Raises:
        SettingsError: with a line for every mistake in the design, and for every mistake that
            some of the cases share.
    """
    instance("study.design", getattr(study, "design", None), Design)
    base = study.varied()
    found = design_mistakes(study.design, base)
    lines = [line for mistake in found for line in mistake.lines()]
    sound = without(study.design, found) if found else study.design
    if sound is None:
        raise SettingsError(*told(lines))
    good, refused = _laid_out(study, sound, base)
    lines += [cases_with_it.told(line, len(good)) for line, cases_with_it in refused.items()]
    if lines:
        raise SettingsError(*told(lines))
    return good


def _laid_out(
    study: Study, design: Design, base: dict[str, Any]
) -> tuple[list[Case], dict[str, InCases]]:
    """Return a case for every combination of a design, and what is wrong with some of them."""
    along = axes(design, study)
    resolve = resolver(base, along)
    laid_out: list[Case] = []
    refused: dict[str, InCases] = {}
    for combination in combinations(along):
        if left_out(design, along, combination) is not None:
            continue
        named = factors(along, combination)
        settings, steps, teacher, problems = resolve(combination)
        for line in problems:
            refused[line] = refused.get(line, InCases(0, named, named)).and_in(named)
        number = len(laid_out)
        first = 0 if study.paired else number * study.lives
        laid_out.append(Case(number, named, settings, study.seed, steps, teacher, first))
    if not laid_out:
        raise SettingsError("key design.exclude: leaves no case")
    return laid_out, refused


def excluded(study: Study) -> list[Excluded]:
    """Return how many combinations each rule leaves out, each counted for the first that does.

    Raises SettingsError for a design with mistakes.
    """
    instance("study.design", getattr(study, "design", None), Design)
    found = design_mistakes(study.design, study.varied())
    if found:
        raise SettingsError(*told(line for mistake in found for line in mistake.lines()))
    along = axes(study.design, study)
    counts = [0] * len(study.design.exclude)
    for combination in combinations(along) if counts else ():
        rule = left_out(study.design, along, combination)
        if rule is not None:
            counts[rule] += 1
    return [
        Excluded(rule.why, count) for rule, count in zip(study.design.exclude, counts, strict=True)
    ]


def _lines(table: dict[str, Any]) -> str:
    return "".join(f"{_bare(key)} = {_inline(value)}\n" for key, value in table.items())


def _inline(value: Any) -> str:
    """Return a value as TOML on one line."""
    if isinstance(value, dict):
        pairs = (f"{_bare(key)} = {_inline(inner)}" for key, inner in value.items())
        return "{ " + ", ".join(pairs) + " }" if value else "{}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    return tomli_w.dumps({"value": value}).removeprefix("value = ").rstrip("\n")


def _bare(key: str) -> str:
    """Return a key as TOML writes it, in quotes only where it must be."""
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _inline(key)

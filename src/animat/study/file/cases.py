"""The cases of a study: what its design comes to, one combination after another."""

from __future__ import annotations

from typing import Any, NamedTuple

from animat.files.arguments import instance
from animat.files.settings import SettingsError
from animat.study.file.axes import axes, combinations, factors, left_out
from animat.study.file.check import design_mistakes, without
from animat.study.file.design import Design
from animat.study.file.factors import Scalar
from animat.study.file.messages import InCases, told
from animat.study.file.resolve import resolver
from animat.study.file.settings import LifeSettings, Teacher
from animat.study.file.study import Study


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

"""What a study asks, in plain words: its cases, what they differ in, and how each is simulated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from animat.figures.worlds import worlds_figure
from animat.life.drawing import robot_drawing, world_drawing
from animat.report.page import Picture, Section, picture
from animat.statistics.numerals import LISTED_AT_MOST, listed, word, words
from animat.study.file.cases import Case, excluded
from animat.study.file.factors import Range
from animat.study.file.study import Study
from animat.study.plan.plan import world_of

WORLDS_AT_MOST = 3

METHODS = {
    "sobol": "Sobol's sequence",
    "latin_hypercube": "a Latin hypercube",
    "saltelli": "Saltelli's scheme",
}


def asked_section(study: Study, cases: Sequence[Case]) -> Section:
    """Return what was asked; the file itself stands at the end of the page."""
    return Section(
        "What was asked",
        [_size(study, cases), _pairing(study), *_teacher(cases), *_records(study)],
        items=[*_factors(study), *_left_out(study)],
        pictures=_worlds(cases),
    )


def _worlds(cases: Sequence[Case]) -> list[Picture]:
    """Return the worlds drawn, where they are few."""
    choices = {case.settings.world.model_dump_json(): case.settings.world for case in cases}
    if len(choices) > WORLDS_AT_MOST:
        return []
    worlds = [world_of(choice) for choice in choices.values()]
    fig = worlds_figure(
        [world_drawing(world, world.name) for world in worlds],
        robot_drawing(cases[0].settings.robot),
    )
    names = listed([f'"{world.name}"' for world in worlds])
    words = f"The {'worlds' if len(worlds) > 1 else 'world'} {names}, to scale."
    return [picture(fig, words, words)]


def _size(study: Study, cases: Sequence[Case]) -> str:
    steps = words((case.steps for case in cases), "steps")
    number = "One case" if len(cases) == 1 else f"{len(cases):,} cases"
    each = "" if len(cases) == 1 else " each"
    return (
        f"{number} of {study.lives:,} {'life' if study.lives == 1 else 'lives'}{each}, up to"
        f" {steps} a life, from seed {study.seed}. A life that is still going on then is censored:"
        " it is known to be longer, not by how much."
    )


def _pairing(study: Study) -> str:
    if study.paired:
        return (
            "Paired (common random numbers): life i of every case draws from the same random"
            " streams, and starts in the same pose wherever its world allows it. So cases can be"
            " compared life by life and with less noise; but lives diverge once they act"
            " differently, and all cases share one draw of the streams. How much of a difference"
            " may still be chance, its interval says."
        )
    return "Not paired: every case has lives of its own, with random numbers of their own."


def _teacher(cases: Sequence[Case]) -> list[str]:
    teachers = [case.teacher for case in cases if case.teacher is not None]
    if not teachers:
        return []
    robots = words(each.robots for each in teachers)
    steps = words((each.steps for each in teachers), "steps")
    worlds = words(each.world.name or each.world.layout for each in teachers)
    return [
        f"AF knows what {robots} robots learnt before, with the mind of its case and the agent"
        f" LEARNING, for {steps} in the world {worlds}: life i has the networks of robot i modulo"
        " their number."
    ]


def _records(study: Study) -> list[str]:
    told = []
    if "likelihoods" in study.measures:
        told.append("what its networks say of each object type at its end")
    if "learning_curve" in study.measures:
        told.append("how they came to say it")
    if study.record is not None:
        told.append(
            f"the trace ({study.record.what}) of the first {study.record.lives:,} lives of a case"
        )
    return [f"Stored of a life beside its row: {listed(told)}."] if told else []


def _factors(study: Study) -> list[str]:
    design = study.design
    told = [f"{name}: {_levels(levels)}" for name, levels in design.grid.items()]
    if design.sample is not None:
        sample = design.sample
        over = "; ".join(f"{name} {_levels(levels)}" for name, levels in sample.over.items())
        told.append(
            f"{sample.size:,} points spread by {METHODS[sample.method]} (seed {sample.seed}) over"
            f" {over}"
        )
    if design.cases:
        names = list(dict.fromkeys(name for row in design.cases for name in row))
        told.append(f"{len(design.cases):,} cases given one by one, which set {listed(names)}")
    if len(told) > 1:
        told.append("every combination of these")
    return told


def _levels(levels: Range | Sequence[Any] | Mapping[str, Mapping[str, Any]]) -> str:
    if isinstance(levels, Range):
        how = ", evenly over its logarithm" if levels.scale == "log" else ""
        return f"from {word(levels.low)} to {word(levels.high)}{how}"
    if isinstance(levels, Mapping):
        named = [f"{name} ({_set(settings)})" for name, settings in levels.items()]
    else:
        named = [word(value) for value in levels]
    if len(named) > LISTED_AT_MOST:
        named = [*named[:LISTED_AT_MOST], f"... ({len(named)} in all)"]
    return ", ".join(named)


def _set(settings: Mapping[str, Any]) -> str:
    pairs = (f"{key} = {word(value)}" for key, value in settings.items())
    return ", ".join(pairs) or "nothing set"


def _left_out(study: Study) -> list[str]:
    return [f"left out, {rule.count:,} combinations: {rule.why}" for rule in excluded(study)]

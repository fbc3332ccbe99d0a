"""What was simulated and how lives were compared, in words for the methods of a paper."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from animat.mind.mind import Mind
from animat.mind.physiology import Variable
from animat.report.sections import restriction_words
from animat.robot.khepera import Khepera
from animat.statistics.estimates import LEVEL
from animat.statistics.findings import RESAMPLES, Findings
from animat.statistics.numerals import LISTED_AT_MOST, listed, word, words
from animat.statistics.resampling import BOOTSTRAPPED_AT_MOST, CASES, COMBINATIONS, LIVES
from animat.study.file.cases import Case
from animat.study.file.settings import WorldChoice
from animat.study.plan.plan import world_of
from animat.world.world import World

AGENTS = {
    "BLIND": "BLIND acts on whatever object it meets",
    "AF": "AF asks networks that were trained before, and leaves an object alone where the"
    " likelihood for the chosen behaviour is too low",
    "LEARNING": "LEARNING acts on whatever it meets and trains its networks as it lives",
    "ORACLE": "ORACLE knows what each object affords",
    "RANDOM": "RANDOM picks any behaviour for whatever it meets",
}

MOST_CASES = 200
"""Of more cases, the settings are read from as many as show every value of every factor."""


def model_words(cases: Sequence[Case], versions: dict[str, str], engine: int) -> list[str]:
    """Return what was simulated, a paragraph each; `versions` are those of Python's packages."""
    shown = representatives(cases)
    minds = [case.settings.mind for case in shown]
    return [
        f"Lives were simulated with animat {versions['animat']} (engine {engine}, Python"
        f" {versions['python']}, NumPy {versions['numpy']}, Numba {versions['numba']}), which"
        " rebuilds the system of Cos-Aguilera, Cañamero and Hayes (2003). Each life is a function"
        " of its settings, the seed and its number alone.",
        _robot(shown) + " " + _worlds([case.settings.world for case in shown]),
        _physiology(minds),
        _behaviour(minds),
        *_networks(minds),
    ]


def representatives(cases: Sequence[Case]) -> list[Case]:
    """Return the cases, or of many some in which every value of every factor occurs."""
    if len(cases) <= MOST_CASES:
        return list(cases)
    seen: set[tuple[str, Any]] = set()
    chosen = []
    for case in cases:
        new = {pair for pair in case.factors.items() if pair not in seen}
        if new:
            seen |= new
            chosen.append(case)
    return chosen


def _robot(cases: Sequence[Case]) -> str:
    robots = [case.settings.robot for case in cases]

    def of(read: Callable[[Khepera], Any], unit: str = "") -> str:
        return words(map(read, robots), unit)

    return (
        f"The robot is a Khepera of radius {of(lambda r: r.radius, 'mm')} with"
        f" {of(lambda r: len(r.sensors))} infrared sensors (model {of(lambda r: r.infrared)},"
        f" {_noise([r.infrared_noise for r in robots])}; motion"
        f" {_noise([r.motor_noise for r in robots])}); a step of it takes 62.5 ms."
    )


def _noise(noisy: Sequence[bool]) -> str:
    return words("with noise" if each else "without noise" for each in noisy)


def _worlds(choices: Sequence[WorldChoice]) -> str:
    worlds = {choice.model_dump_json(): world_of(choice) for choice in choices}
    if len(worlds) > LISTED_AT_MOST:
        counts = words(world.n_objects for world in worlds.values())
        return f"It lives in one of {len(worlds)} worlds with {counts} objects."
    return "It lives in " + listed([_world(world) for world in worlds.values()], "or") + "."


def _world(world: World) -> str:
    types = [one.type for one in world.layout.placements]
    counts = ", ".join(f"{types.count(name)} {name}" for name in dict.fromkeys(types))
    arena = world.arena
    size = f"{word(arena.width)} by {word(arena.height)} mm"
    return f'the world "{world.name}" ({size}; objects: {counts or "none"})'


def _physiology(minds: Sequence[Mind]) -> str:
    variables: dict[str, list[Variable]] = {}
    for mind in minds:
        for name, variable in mind.resolved_variables().items():
            variables.setdefault(name, []).append(variable)
    drives = {
        name: " and ".join([*drive.a, *drive.b])
        for mind in minds
        for name, drive in mind.drives.items()
    }
    watched = listed([f"{name} ({watches})" for name, watches in drives.items()])
    mortal = {mind.mortal for mind in minds}
    ends = (
        "No variable ends a life"
        if mortal == {False}
        else "A variable outside its viability zone ends the life"
        + ("" if mortal == {True} else ", in the cases where robots are mortal")
    )
    return (
        f"Homeostatic variables: {'; '.join(_variable(*each) for each in variables.items())}."
        f" {ends}. Drives, and what they watch: {watched}; the error is"
        f" {words(mind.error for mind in minds)}."
    )


def _variable(name: str, variables: Sequence[Variable]) -> str:
    def of(read: Callable[[Variable], Any]) -> str:
        return words(map(read, variables))

    margin = of(lambda v: v.lethal_margin)
    return (
        f"{name} (law {of(lambda v: str(v.law))}, rate {of(lambda v: v.rate)} per step, set point"
        f" {of(lambda v: v.set_point)}, at birth {of(lambda v: v.start)}, zone"
        f" {of(lambda v: f'[{word(v.low)}, {word(v.high)}]')}"
        + ("" if margin == "0" else f", lethal margin {margin}")
        + ("" if all(v.lethal for v in variables) else ", not lethal in all cases")
        + ")"
    )


def _behaviour(minds: Sequence[Mind]) -> str:
    def of(read: Callable[[Mind], Any], unit: str = "") -> str:
        return words(map(read, minds), unit)

    behaviours = {
        name: f"{name} (serves {one.serves}, needs {one.needs})"
        for mind in minds
        for name, one in mind.behaviours.items()
    }
    agents = dict.fromkeys(mind.agent for mind in minds)
    selector = of(lambda m: str(m.selector or m.nature.selector).replace("_", " "))
    return (
        f"Agents: {'; '.join(AGENTS[agent] for agent in agents)}. Behaviours:"
        f" {', '.join(behaviours.values())}, selected by {selector} (gate {of(lambda m: m.gate)})."
        f" An object is met within {of(lambda m: m.encounter_range, 'mm')} of the robot's rim;"
        f" an act takes {of(lambda m: m.interaction_steps, 'steps')}, an approach at most"
        f" {of(lambda m: m.approach_steps, 'steps')}. A success moves the variable served by"
        f" {of(lambda m: m.success_effect)} towards satisfaction (overflow:"
        f" {of(lambda m: m.overflow)}), a failure by {of(lambda m: m.failure_effect)} away from it"
        f" (past the bound: {of(lambda m: m.failed_act)}). Objects used"
        f" {words('appear elsewhere' if mind.consumed else 'stay' for mind in minds)}."
    )


def _networks(minds: Sequence[Mind]) -> list[str]:
    knowing = [mind for mind in minds if mind.nature.learns or mind.agent == "AF"]
    if not knowing:
        return []

    def of(read: Callable[[Mind], Any]) -> str:
        return words(map(read, knowing))

    estimator = of(lambda m: str(m.learning.estimator).replace("_", " "))
    biases = words("with" if mind.learning.biases else "without" for mind in knowing)
    return [
        f"Affordances: a network for each behaviour ({estimator},"
        f" {of(lambda m: m.learning.hidden_units)} hidden units, {biases} biases), trained by"
        f" {of(lambda m: str(m.learning.learner)).replace('_', '-')} at rate"
        f" {of(lambda m: m.learning.rate)} for {of(lambda m: m.learning.cycles)} cycles after each"
        f" episode in which the acting drive changed by more than"
        f" {of(lambda m: m.learning.threshold)}. AF acts where the likelihood is at least"
        f" {of(lambda m: m.likelihood_threshold)}."
    ]


WORDS = {
    "log-rank": "the log-rank test",
    "stratified log-rank": (
        "the log-rank test, stratified by the combinations of the other factors"
    ),
    "Kruskal-Wallis": "the Kruskal-Wallis test on the mean lifespans of cases",
    "Spearman": "Spearman's rank correlation of a factor with the mean lifespans of cases",
}
"""The tests that may have been made, by their names."""

PAIRED = (
    "where lives are paired by their seed and index, the mean difference within pairs, the share of"
    " pairs in which one outlives the other (with Wilson's interval, for the number of independent"
    " pairs that would vary as much), and the matched-pairs rank-biserial correlation (ties, such"
    " as two lives that reach the cap, ranked and counted for neither, as by Pratt)"
)


def statistics_words(found: Findings, scipy: str) -> list[str]:
    """The statistics that the page really has, a paragraph each; `scipy` is its version."""
    drawn = {found.resampled, *(effect.resampled for effect in found.effects)}
    units = "; for some factors, ".join(
        what for what in (LIVES, COMBINATIONS, CASES) if what in drawn
    )
    told = [
        f"Lifespans are described by Kaplan-Meier curves with pointwise log-log bands, and by"
        f" restricted means and medians. {restriction_words(found)} Physiological stability is the"
        " mean over a life of the mean of the drives. The success rate is the share of acts that"
        " succeeded.",
        f"Intervals are at {LEVEL:.0%}. Those of means, medians, rates and ratios are bootstrap"
        f" intervals of {RESAMPLES:,} resamples of {units}: BCa for means and ratios, percentiles"
        f" for medians; of more than {BOOTSTRAPPED_AT_MOST:,} such units, means are drawn from"
        " their joint normal law. Shares of the ways to die have Wilson's interval, which"
        " takes lives as independent.",
    ]
    if found.deaths and found.effects:
        told.append(_comparisons_words(found))
    if found.interactions:
        told.append(_interactions_words(found))
    told.append(f"Statistics were computed with SciPy {scipy}.")
    return told


def _comparisons_words(found: Findings) -> str:
    tests = dict.fromkeys(effect.test.name for effect in found.effects)
    comparisons = [one for effect in found.effects for one in effect.comparisons]
    tests |= dict.fromkeys(one.test.name for one in comparisons if not one.where)
    told = ", and by ".join(WORDS[name] for name in tests)
    if any(one.where for one in comparisons):
        told += ", and within single combinations by the log-rank test"
    paired = [one for one in comparisons if one.paired]
    sizes = [
        "Cliff's delta (the chance that a life of one group outlasts one of the other, less the"
        " chance of the contrary; the rank-biserial correlation) with DeLong's interval"
    ] * (len(paired) < len(comparisons))
    sizes += [PAIRED] * bool(paired)
    return (
        f"Factors and their levels were tested by {told}. Effect sizes are the ratio of restricted"
        f" mean lifespans, and {', and '.join(sizes)}. Hazard ratios are not given, as hazards are"
        " not proportional where curves cross. p values were corrected by Holm's method, for the"
        f" {len(found.factors_p)} tests of factors and for the {len(found.levels_p)} comparisons of"
        " levels each."
    )


def _interactions_words(found: Findings) -> str:
    tests, contrasts = (
        np.count_nonzero(~np.isnan(p)) for p in (found.interactions_p, found.contrasts_p)
    )
    return (
        "The interaction of two factors was tested by Hotelling's T² on the restricted mean"
        " lifespans of their combinations, averaged over the combinations of the other factors that"
        " have all of them, with sets of lives as units: for differences of differences, and for"
        " ratios of ratios on the scale of logarithms (delta method). Contrasts against the first"
        " levels have Student's test and interval. p values were corrected by Holm's method, for"
        f" the {tests} tests of interactions and for the {contrasts} tests of contrasts each."
    )

"""The methods of a paper, written from the settings that a study really used.

A setting that differs between cases is told with all its values, or with its range.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from animat.mind.mind import Mind
from animat.mind.physiology import Variable
from animat.robot.khepera import Khepera
from animat.statistics.words import LISTED_AT_MOST, listed, word, words
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

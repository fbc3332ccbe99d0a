"""The plan of a study: which lives there are to live, numbered, and cut into parts.

A plan is a function of the study alone, so that every process that reads the study knows which
life has which number. Cases whose lives are the same lives are lived once, and so are robots that
learn the same.
"""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from threading import Lock
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa

from animat.files.settings import SettingsError, validated
from animat.life.scenario import Setting, bring_together
from animat.mind.functions import Functions
from animat.mind.loading import imported_files
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.numerics.snapshot import source_files
from animat.study.file.cases import Case, cases
from animat.study.file.messages import InCases, told
from animat.study.file.settings import Teacher, WorldChoice
from animat.study.file.study import Study
from animat.study.plan.identity import Lived, identity
from animat.study.plan.numbering import KINDS, Kind, Numbering, Part, Piece, part_size
from animat.world.world import World

LIFE_STEPS = 30_000_000
"""Steps of a part in which every life reaches the cap: some seconds, which Ctrl-C waits for."""

TEACHER_STEPS = 5_000_000
"""The same for robots that learn, all of which do."""

WORLDS_KEPT = 4_096
"""Worlds kept as they are laid out, some kilobytes each: every agent of a design meets them all."""


class Class(NamedTuple):
    """Robots that learn alike: their identity, how many, and whose networks they learn for."""

    identity: str
    robots: int
    mind: Mind
    teacher: Teacher
    case: Case


class Plan:
    """The plan of a study; read only, and safe to use from several threads.

    `inputs` are the files that the study draws on beside its own: functions and worlds. Raises
    SettingsError where anything of the study cannot be lived.
    """

    def __init__(self, study: Study, check_functions: bool = False) -> None:
        """Number the cases, the robots that teach, and their parts.

        With `check_functions`, custom functions check every index they use.
        """
        self.study = study
        self.check_functions = check_functions
        self.text = study.to_toml()
        self.cases = cases(study)
        self.inputs: set[str] = set()
        self._functions: dict[tuple[str, ...], Functions] = {}
        self._lock = Lock()
        self.classes: list[Class] = []
        self.identities: list[str] = []
        self.same_as: list[int] = []
        self._class_of: dict[int, int] = {}
        self._number_all()
        self.lived = [case for case in self.cases if self.same_as[case.number] == case.number]
        robots = [each.robots for each in self.classes]
        lives = [study.lives] * len(self.lived)
        longest = max(case.steps for case in self.lived)
        learning = max((each.teacher.steps for each in self.classes), default=1)
        self.numbering: dict[Kind, Numbering] = {
            "teachers": Numbering.of(robots, part_size(sum(robots), learning, TEACHER_STEPS)),
            "lives": Numbering.of(lives, part_size(sum(lives), longest, LIFE_STEPS)),
        }

    def pieces(self, part: Part) -> list[Piece]:
        """Return what a part is made of."""
        return self.numbering[part.kind].pieces(part.number)

    def all_parts(self) -> Iterator[Part]:
        """Yield every part there is, those who teach first."""
        for kind in KINDS:
            for number in range(self.numbering[kind].parts):
                yield Part(kind, number)

    @property
    def steps_to_learn(self) -> int:
        """The steps that all robots that teach live together, if none fails."""
        return sum(each.robots * each.teacher.steps for each in self.classes)

    @property
    def shares(self) -> list[int]:
        """For each case that is lived, the number of cases whose lives are its lives."""
        counts = Counter(self.same_as)
        return [counts[case.number] for case in self.lived]

    def class_of(self, place: int) -> int | None:
        """Return the class whose networks the lives of a case have; None where they have none."""
        return self._class_of.get(self.lived[place].number)

    def parts_of_class(self, place: int) -> list[Part]:
        """Return the parts in which the robots of a class are."""
        return [Part("teachers", number) for number in self.numbering["teachers"].parts_of(place)]

    def setting(self, place: int) -> Setting:
        """Return the setting of a case; one that knows has networks that stand in for its own."""
        case = self.lived[place]
        mind, world = case.settings.mind, world_of(case.settings.world)
        if case.teacher is not None:
            school = world_of(case.teacher.world)
            mind = mind.model_copy(update={"networks": untaught(mind, school)})
        return bring_together(mind, world, case.settings.robot, self._functions_of(mind))

    def setting_of_class(self, place: int) -> Setting:
        """Return the setting in which the robots of a class learn."""
        each = self.classes[place]
        world = world_of(each.teacher.world)
        robot = each.case.settings.robot
        return bring_together(each.mind, world, robot, self._functions_of(each.mind))

    def case_table(self) -> pa.Table:
        """Return the table of cases: `case`, a column for each factor, `identity`, `same_as`."""
        return case_table(self.cases, self.identities, self.same_as)

    def _number_all(self) -> None:
        first: dict[str, int] = {}
        places: dict[str, int] = {}
        refused: dict[str, InCases] = {}
        for case in self.cases:
            self.inputs.update(_world_files(case))
            try:
                own = self._identity(case, places)
            except SettingsError as error:
                for line in error.problems:
                    before = refused.get(line, InCases(0, case.factors, case.factors))
                    refused[line] = before.and_in(case.factors)
                own = ""
            self.identities.append(own)
            self.same_as.append(first.setdefault(own, case.number))
        if refused:
            all_ = len(self.cases)
            raise SettingsError(*told(one.told(line, all_) for line, one in refused.items()))

    def _identity(self, case: Case, places: dict[str, int]) -> str:
        mind, robot = case.settings.mind, case.settings.robot
        taught = ""
        if case.teacher is not None:
            learner = mind.model_copy(update={"agent": "LEARNING", "networks": None})
            school = world_of(case.teacher.world)
            steps = case.teacher.steps
            functions = self._functions_of(learner)
            who = identity(Lived(learner, school, robot, functions, case.seed, steps))
            robots = case.teacher.robots
            place = places.setdefault(who, len(places))
            if place == len(self.classes):
                self.classes.append(Class(who, robots, learner, case.teacher, case))
            elif robots > self.classes[place].robots:
                self.classes[place] = self.classes[place]._replace(robots=robots)
            self._class_of[case.number] = place
            taught = f"{who} {robots}"
            mind = mind.model_copy(update={"networks": untaught(mind, school)})
        functions = self._functions_of(mind)
        world = world_of(case.settings.world)
        lived = Lived(mind, world, robot, functions, case.seed, case.steps, taught)
        own = identity(lived, traced=self.study.record is not None)
        return own if case.first == 0 else f"{own} {case.first}"

    def _functions_of(self, mind: Mind) -> Functions:
        """Return the user's functions of a mind; each is read and compiled once for a plan."""
        laws = [variable.law for variable in mind.resolved_variables().values()]
        others = (mind.drive_function, mind.selector, mind.wander)
        learning = (mind.learning.estimator, mind.learning.learner)
        key = tuple(map(str, (*laws, *others, *learning)))
        with self._lock:
            if key not in self._functions:
                functions = mind.functions(check=self.check_functions)
                self._functions[key] = functions
                for role, own in mind.own_functions().items():
                    self.inputs.update(_function_files(str(own), getattr(functions, role)))
            return self._functions[key]


def case_table(laid_out: Sequence[Case], identities: list[str], same_as: list[int]) -> pa.Table:
    """Return cases as a table; see `Plan.case_table`."""
    names = list(dict.fromkeys(name for case in laid_out for name in case.factors))
    columns: dict[str, Any] = {"case": [case.number for case in laid_out]}
    for name in names:
        columns[name] = _alike([case.factors.get(name) for case in laid_out])
    return pa.table({**columns, "identity": identities, "same_as": same_as})


@lru_cache(maxsize=2)
def plan_of(text: str, check_functions: bool = False) -> Plan:
    """Return the plan of a study given as the text of its file."""
    return Plan(validated(tomllib.loads(text), Study), check_functions)


def forget() -> None:
    """Forget the plans and worlds that were made of files, which may have changed since."""
    plan_of.cache_clear()
    _world.cache_clear()


def world_of(choice: WorldChoice) -> World:
    """Return the world chosen; one that is chosen again is not laid out again."""
    return _world(choice.model_dump_json(exclude_unset=True))


@lru_cache(maxsize=WORLDS_KEPT)
def _world(choice: str) -> World:
    return WorldChoice.model_validate_json(choice).world()


def _world_files(case: Case) -> list[str]:
    choices = [case.settings.world, *([case.teacher.world] if case.teacher else [])]
    return [choice.layout for choice in choices if choice.layout.endswith(".toml")]


def untaught(mind: Mind, school: World) -> Networks:
    """Return networks of the form that robots with this mind learn in this world."""
    shape = len(mind.behaviours), mind.weight_count(len(school.feature_names))
    hidden = mind.learning.hidden_units
    return Networks(tuple(mind.behaviours), school.feature_names, hidden, np.zeros(shape))


def _function_files(address: str, function: Any) -> set[str]:
    """Return the files of a custom function: its own, and those that it imports or calls.

    They are named as the study names the first, from the folder that the program runs in or from
    the root; what lies outside that folder is always named from the root.
    """
    given = Path(address.rpartition(":")[0])
    found = imported_files(given) | {Path(file) for file in source_files(function)}
    here = Path.cwd()
    names = {str(given)}
    for file in found - {given.resolve()}:
        is_near = not given.is_absolute() and file.is_relative_to(here)
        names.add(str(file.relative_to(here) if is_near else file))
    return names


def _alike(values: list[Any]) -> pa.Array:
    """Return values as a column, as texts where they are of several kinds."""
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int, float} and len(kinds) > 1:
        return pa.array([None if v is None else float(v) for v in values], pa.float64())
    if len(kinds) > 1:
        return pa.array([None if v is None else str(v) for v in values])
    return pa.array(values)

"""The mind: every setting of it, checked."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, field_validator, model_validator

from animat.files.arguments import boolean, whole
from animat.files.settings import Settings, SettingsError, nearest
from animat.files.validation_errors import plain
from animat.mind.affordance import ESTIMATORS, LEARNERS, weight_count
from animat.mind.agents import AGENTS, Agent
from animat.mind.behaviours import WANDERERS
from animat.mind.changes import Complete, changing, removing
from animat.mind.functions import BUILT_IN, Functions, resolve
from animat.mind.homeostasis import LAWS
from animat.mind.networks import MOST_HIDDEN, Networks
from animat.mind.physiology import PHYSIOLOGIES, Kind, Variable
from animat.mind.selection import SELECTORS
from animat.names import KEPT, MODES, TRACE, WHICH, name_problems

Unit = Annotated[float, Field(ge=0.0, le=1.0)]

LONGEST_WAIT = 1_000_000_000
"""Steps that an act, an approach or a turning away may take; a count of them does not overflow."""

Effects = dict[str, float]
Function = str | Callable[..., Any]


class VariableChange(Settings):
    """What is to differ in a variable of the physiology, or the whole of a new variable."""

    law: Function | None = None
    rate: Annotated[float, Field(gt=0.0, lt=1.0)] | None = None
    set_point: float | None = None
    start: float | None = None
    low: float | None = None
    high: float | None = None
    kind: Kind | None = None
    lethal: bool | None = None
    lethal_margin: Annotated[float, Field(ge=0.0)] | None = None


class Drive(Settings):
    """A drive: by variable, its coefficients a (on errors) and b (on rates; equation 3)."""

    a: Effects
    b: Effects = {}


class Behaviour(Settings):
    """A behaviour: the drive it serves, the affordance it needs, and what it does to variables.

    `success` and `failure` give for each variable how far the act moves it, positive towards
    satisfaction. Left out, an act moves the variables its drive watches by the mind's
    `success_effect`, and by minus its `failure_effect`.
    """

    serves: str
    needs: str
    success: Effects | None = None
    failure: Effects | None = None


PAPER_DRIVES = {
    "hunger": Drive(a={"nutrition": 1.0}),
    "fatigue": Drive(a={"stamina": 1.0}),
    "curiosity": Drive(a={"restlessness": 1.0}),
}
PAPER_BEHAVIOURS = {
    "eat": Behaviour(serves="hunger", needs="grasp"),
    "shelter": Behaviour(serves="fatigue", needs="shelter"),
    "interact": Behaviour(serves="curiosity", needs="interact"),
}
"""The drives and behaviours that every mind has, unless they are changed or removed."""


_check_variables, _write_variables = removing(PHYSIOLOGIES["excess"], VariableChange)
_check_drives, _write_drives = changing(PAPER_DRIVES, Drive)
_check_behaviours, _write_behaviours = changing(PAPER_BEHAVIOURS, Behaviour)


class Learning(Settings):
    """The affordance networks and their learning rule."""

    hidden_units: Annotated[int, Field(ge=1, le=MOST_HIDDEN)] = 2
    biases: bool = True
    rate: Annotated[float, Field(gt=0.0)] = 0.5
    cycles: Annotated[int, Field(ge=1, le=10_000)] = 10
    threshold: Annotated[float, Field(ge=0.0)] = 0.05
    estimator: Function = "feed_forward"
    learner: Function = "back_propagation"

    @field_validator("estimator")
    @classmethod
    def _known_estimator(cls, value: Function) -> Function:
        return _known("estimator", value, ESTIMATORS)

    @field_validator("learner")
    @classmethod
    def _known_learner(cls, value: Function) -> Function:
        return _known("learner", value, LEARNERS)


class Mind(Settings):
    """A mind: what it needs, what urges it, how it chooses, what it knows and how it learns.

    The defaults are those of the paper. What `variables`, `drives` and `behaviours` name is added
    to those of the paper or takes the place of one; None or False removes one. `networks` are those
    a robot has learnt, needed by the agent AF. docs/settings.md has every setting.
    """

    model_config = ConfigDict(arbitrary_types_allowed=True)

    agent: Literal["BLIND", "AF", "LEARNING", "ORACLE", "RANDOM"] = "BLIND"
    physiology: Literal["excess", "decay", "relax", "linear"] = "excess"
    variables: Annotated[dict[str, VariableChange], _check_variables, _write_variables] = {}
    drives: Annotated[dict[str, Drive], _check_drives, _write_drives] = Complete(PAPER_DRIVES)
    behaviours: Annotated[dict[str, Behaviour], _check_behaviours, _write_behaviours] = Complete(
        PAPER_BEHAVIOURS
    )
    lethal_margin: Annotated[float, Field(ge=0.0, lt=0.5)] | None = None
    overflow: Literal["clamp", "lethal"] = "clamp"
    failed_act: Literal["lethal", "clamp"] = "lethal"
    success_effect: Unit = 0.2
    failure_effect: Unit = 0.2
    death: bool | None = None
    error: Literal["signed", "rectified", "absolute"] = "signed"
    drive_function: Function | None = None
    selector: Function | None = None
    gate: Literal["positive", "always"] = "positive"
    likelihood_threshold: Unit = 0.5
    encounter_range: Annotated[float, Field(gt=0.0, le=200.0)] = 30.0
    contact_range: Annotated[float, Field(ge=6.0, le=200.0)] = 10.0
    interaction_steps: Annotated[int, Field(ge=1, le=LONGEST_WAIT)] = 20
    approach_steps: Annotated[int, Field(ge=1, le=LONGEST_WAIT)] = 100
    leave_steps: Annotated[int, Field(ge=0, le=LONGEST_WAIT)] = 40
    consumed: bool = False
    feature_noise: Unit = 0.0
    wander: Function = "curved"
    cruise_speed: Annotated[int, Field(ge=1, le=10)] = 5
    turn_speed: Annotated[int, Field(ge=1, le=10)] = 5
    learning: Learning = Learning()
    networks: Networks | None = Field(default=None, exclude=True, repr=False)

    @field_validator("networks", mode="before")
    @classmethod
    def _from_python(cls, value: Any) -> Any:
        if not isinstance(value, Networks | None):
            raise ValueError("networks are those of a life, and given in Python only")
        return value

    @field_validator("selector")
    @classmethod
    def _known_selector(cls, value: Function | None) -> Function | None:
        return _known("selector", value, SELECTORS)

    @field_validator("wander")
    @classmethod
    def _known_wander(cls, value: Function) -> Function:
        return _known("wander", value, WANDERERS)

    @field_validator("drive_function")
    @classmethod
    def _known_drive_function(cls, value: Function | None) -> Function | None:
        return _known("drive function", value, {})

    @model_validator(mode="after")
    def _consistent(self) -> Mind:
        variables = self.resolved_variables()
        problems = [*_misnamed(self, variables), *_unknown_names(self, variables)]
        own_laws = _own_laws(variables)
        if len(set(own_laws.values())) > 1:
            problems.append(
                f"variables {', '.join(own_laws)} follow different laws of your own;"
                " one function must serve them all"
            )
        if not self.drives or not self.behaviours:
            problems.append("a mind needs at least one drive and one behaviour")
        if self.contact_range > self.encounter_range:
            problems.append(
                f"contact_range = {self.contact_range} is wider than"
                f" encounter_range = {self.encounter_range}"
            )
        if self.networks is not None:
            problems += _misfit(self.networks, self)
        if problems:
            raise ValueError("\n".join(problems))
        return self

    @property
    def nature(self) -> Agent:
        """What the agent's name stands for."""
        return AGENTS[self.agent]

    @property
    def mortal(self) -> bool:
        """Whether a variable outside its viability zone ends the life."""
        return self.nature.mortal if self.death is None else self.death

    def resolved_variables(self) -> dict[str, Variable]:
        """Return the variables by name: the physiology's, changed and added to by `variables`.

        Raises SettingsError, with a line for each mistake, where a changed variable is impossible.
        """
        changes = {name: each for name, each in self.variables.items() if each is not False}
        removed = self.variables.keys() - changes.keys()
        resolved = {n: v for n, v in PHYSIOLOGIES[self.physiology].items() if n not in removed}
        problems: list[str] = []
        if self.lethal_margin is not None:
            margin = {"lethal_margin": self.lethal_margin}
            for name, variable in resolved.items():
                if variable.lethal_margin > 0.0:
                    resolved[name] = Variable(**{**dict(variable), **margin})
        for name, change in changes.items():
            settings = dict(resolved[name]) if name in resolved else {}
            if change.law is not None and change.kind is None:
                settings.pop("kind", None)
            settings.update({k: v for k, v in dict(change).items() if v is not None})
            if not settings.keys() >= {"law", "rate", "set_point"}:
                problems.append(
                    f"variables.{name}: a new variable must give law, rate and set_point"
                    f"{nearest(name, PHYSIOLOGIES[self.physiology])}"
                )
                continue
            try:
                resolved[name] = Variable(**settings)
            except SettingsError as error:
                problems += [f"variables.{name}: {line}" for line in error.problems]
        if problems:
            raise SettingsError(*problems)
        return resolved

    def own_functions(self) -> dict[str, Function]:
        """Return the user's own functions as they were given, by their role in `SIGNATURES`."""
        own: dict[str, Function] = {}
        for law in _own_laws(self.resolved_variables()).values():
            own["law"] = law
        if self.drive_function is not None:
            own["drives"] = self.drive_function
        for role, value, known in (
            ("selector", self.selector, SELECTORS),
            ("estimator", self.learning.estimator, ESTIMATORS),
            ("learner", self.learning.learner, LEARNERS),
            ("wander", self.wander, WANDERERS),
        ):
            if value is not None and value not in known:
                own[role] = value
        return own

    def functions(self, *, check: bool = False) -> Functions:
        """Return the custom functions, compiled. With `check`, they check every index they use.

        Raises FunctionError, and SettingsError for a `check` that is no bool.
        """
        check = boolean("check", check)
        own = self.own_functions()
        return BUILT_IN._replace(**{role: resolve(role, own[role], check=check) for role in own})

    def weight_count(self, feature_count: int) -> int:
        """Return the number of weights of one of its networks. Raises SettingsError."""
        feature_count = whole("feature_count", feature_count)
        return weight_count(feature_count, self.learning.hidden_units)


def _known(role: str, value: Any, known: dict[Any, int]) -> Any:
    """Let through a built-in name, a function, or FILE.py:NAME."""
    if isinstance(value, str) and value not in known and ".py:" not in value:
        raise ValueError(f"{plain(value)} is no {role}, nor FILE.py:NAME{nearest(value, known)}")
    if not isinstance(value, Hashable):
        raise ValueError("must be a function")
    return value


def _misnamed(mind: Mind, variables: dict[str, Variable]) -> list[str]:
    """Tell of names that cannot be columns of a trace, or are modes."""
    tables = (TRACE, KEPT, WHICH)
    modes = f"one of the modes {', '.join(MODES)}"
    return [
        *name_problems("variable", variables, tables=tables),
        *name_problems("drive", mind.drives, tables=tables, others=[("a variable", variables)]),
        *name_problems("behaviour", mind.behaviours, others=[(modes, MODES)]),
    ]


def _unknown_names(mind: Mind, variables: dict[str, Variable]) -> list[str]:
    """Tell of drives and behaviours that name what there is not."""
    problems: list[str] = []
    for name, drive in mind.drives.items():
        if not drive.a and not drive.b:
            problems.append(f"drives.{name} watches no variable")
        for watched in (*drive.a, *drive.b):
            if watched not in variables:
                problems.append(
                    f"drives.{name} watches {plain(watched)}, which is no variable"
                    f"{nearest(watched, variables)}"
                )
    for name, behaviour in mind.behaviours.items():
        if behaviour.serves not in mind.drives:
            problems.append(
                f"behaviours.{name}.serves = {plain(behaviour.serves)} is no drive"
                f"{nearest(behaviour.serves, mind.drives)}"
            )
        for moved in (*(behaviour.success or ()), *(behaviour.failure or ())):
            if moved not in variables:
                problems.append(
                    f"behaviours.{name} moves {plain(moved)}, which is no variable"
                    f"{nearest(moved, variables)}"
                )
    return problems


def _own_laws(variables: dict[str, Variable]) -> dict[str, Function]:
    """Return the laws of the user's own, by the variable that follows them."""
    return {name: each.law for name, each in variables.items() if each.law not in LAWS}


def _misfit(networks: Networks, mind: Mind) -> list[str]:
    if networks.behaviours != tuple(mind.behaviours):
        return [f"networks are for {networks.behaviours}, the mind has {tuple(mind.behaviours)}"]
    if networks.hidden != mind.learning.hidden_units:
        return [
            f"networks have {networks.hidden} hidden units,"
            f" learning.hidden_units = {mind.learning.hidden_units}"
        ]
    return []

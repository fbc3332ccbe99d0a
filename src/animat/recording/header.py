"""The head of a recording: everything a life is a function of, and how it ended, as JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import Field, ValidationError

from animat.files.settings import Settings, SettingsError, explain
from animat.life.engine import ENGINE
from animat.life.life import Moment
from animat.life.scenario import LifeError, Setting, bring_together
from animat.life.summary import death_of
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.numerics.snapshot import lasting_identity
from animat.recording.checkpoint import Fields, Kept, fields_of, keep
from animat.robot.khepera import Khepera
from animat.world.files import WorldFile, world_file
from animat.world.world import World

FORMAT = 1
"""Raised by 1 with every change after which an earlier version cannot read a recording."""

Whole = Annotated[int, Field(ge=0)]
Key = Annotated[int, Field(ge=0, lt=1 << 64)]
Hexadecimal = Annotated[str, Field(pattern="^([0-9a-f]{2})*$")]


class Knowledge(Settings):
    """Trained networks; see `Networks`."""

    behaviours: tuple[str, ...]
    features: tuple[str, ...]
    hidden: int
    weights: tuple[tuple[float, ...], ...]


class End(Settings):
    """A state as it is kept, but for being in hexadecimal; see `animat.recording.checkpoint`."""

    state: Hexadecimal
    present: Hexadecimal
    digest: str


class Head(Settings):
    """What a recording says besides its steps.

    `mind`, `networks`, `robot` and `world` hold the settings in full, `functions` the identity
    of each function of the user's own, by its role. Recorded are the steps from `first` to before
    `last` of a life that was to have `steps` at most. The state before `first`, and before every
    step that `every` divides, is kept with the trace; the one at the end, here, and what the life
    died of, if it did. `fields` are those of a state: name, type and shape.
    """

    format: Whole
    engine: Whole
    made: dict[str, Any]
    seed: Key
    life: Key
    steps: Whole
    every: Annotated[int, Field(ge=1)]
    first: Whole
    last: Whole
    mind: Mind
    networks: Knowledge | None
    robot: Khepera
    world: WorldFile
    functions: dict[str, str]
    fields: Fields
    end: End
    death: str | None

    @property
    def moments(self) -> int:
        """How many moments are kept, the first and the last included."""
        between = (self.last - 1) // self.every - self.first // self.every
        return 1 + between + 1

    def json_text(self) -> str:
        """Return the head as JSON in ASCII."""
        return json.dumps(self.model_dump())

    def setting(self) -> Setting:
        """Return the setting of the life. Raises SettingsError where it cannot be lived here."""
        if self.engine != ENGINE:
            raise LifeError(
                f"was lived by engine {self.engine}; this is engine {ENGINE}, by which it would be"
                " another life"
            )
        networks = self.networks and Networks(
            self.networks.behaviours,
            self.networks.features,
            self.networks.hidden,
            np.array(self.networks.weights),
        )
        mind = Mind(**{**dict(self.mind), "networks": networks})
        world = World(self.world.layout(), self.world.name, self.world.resolution)
        setting = bring_together(mind, world, self.robot)
        for role, found in _identities(setting).items():
            if found != self.functions.get(role):
                given = mind.own_functions()[role]
                raise LifeError(f"{role}: {given} has changed since the life was recorded")
        return setting

    def kept_end(self) -> Kept:
        """Return the moment at the end."""
        return Kept(bytes.fromhex(self.end.state), bytes.fromhex(self.end.present), self.end.digest)


def head_of(moment: Moment, steps: int, every: int, made: Mapping[str, Any]) -> Head:
    """Return the head of a recording that begins at a moment and holds no step yet.

    `made` says when, how and with what versions it is made. Raises LifeError where the life could
    not be lived again from a file.
    """
    setting = moment.setting
    for role, function in setting.mind.own_functions().items():
        if not isinstance(function, str):
            raise LifeError(
                f"{role}: a recorded life must find {getattr(function, '__name__', function)}"
                " again; give it by its file and name, FILE.py:NAME"
            )
    networks = setting.mind.networks
    world = setting.world
    fields = fields_of(moment.states.dtype)
    return Head(
        format=FORMAT,
        engine=ENGINE,
        made=dict(made),
        seed=moment.seed,
        life=moment.index,
        steps=steps,
        every=every,
        first=moment.step,
        last=moment.step,
        mind=setting.mind,
        networks=networks
        and Knowledge(
            behaviours=networks.behaviours,
            features=networks.features,
            hidden=networks.hidden,
            weights=tuple(map(tuple, networks.weights.tolist())),
        ),
        robot=setting.robot,
        world=world_file(world.name, world.layout, world.resolution),
        functions=_identities(setting),
        fields=fields,
        end=_end(moment, fields),
        death=None,
    )


def ended(head: Head, moment: Moment) -> Head:
    """Return the head of a recording that ends at a moment."""
    death = death_of(moment.state, moment.setting.mind)
    return head.model_copy(
        update={"last": moment.step, "end": _end(moment, head.fields), "death": death}
    )


def read_head(text: str) -> Head:
    """Return the head in a text. Raises SettingsError."""
    try:
        data = json.loads(text)
    except ValueError:
        data = None
    found = data.get("format") if isinstance(data, dict) else None
    if found != FORMAT:
        raise SettingsError(f"is of format {found!r}; this animat reads format {FORMAT}")
    try:
        return Head.__pydantic_validator__.validate_json(text)
    except ValidationError as error:
        raise explain(error, Head, "its head") from None


def _end(moment: Moment, fields: Fields) -> End:
    kept = keep(moment, fields)
    return End(state=kept.state.hex(), present=kept.present.hex(), digest=kept.digest)


def _identities(setting: Setting) -> dict[str, str]:
    """Return the identities of the user's own functions by their role."""
    own = setting.mind.own_functions()
    return {role: lasting_identity(getattr(setting.functions, role)) for role in own}

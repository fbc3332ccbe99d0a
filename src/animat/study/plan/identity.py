"""The identity of lives: what they are a pure function of, as a hash.

Lives of equal identity and index are the same lives, so they need to be lived only once. What goes
in is what the kernel reads of a setting and what stands in a row of the table of lives, and no
more: two cases that differ in what their agent never looks at are the same. A life is named by the
identity and its index.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from animat.files.settings import SettingsError
from animat.life.engine import ENGINE
from animat.life.scenario import LifeError, checked_parameters
from animat.mind.agents import ACCEPT_ALL, ASK_NETWORKS, ASK_TRUTH
from animat.mind.functions import BUILT_IN, Functions
from animat.mind.mind import Mind
from animat.mind.selection import RANDOM, WINNER_TAKE_ALL
from animat.numerics.snapshot import lasting_identity
from animat.robot.khepera import Khepera
from animat.world.files import world_file
from animat.world.world import World

LEARNING = ("learning_rate", "learning_cycles", "learning_threshold", "learner", "biases")
"""What is read only of a mind that learns; `biases` also at the birth of networks."""

ASKING = ("estimator", "feature_noise")
"""What is read only for what networks say or learn."""


class Lived(NamedTuple):
    """What lives are lived in and from: mind, world, robot, the user's functions, seed, cap.

    `taught` is the identity of the networks they are given, if any.
    """

    mind: Mind
    world: World
    robot: Khepera
    functions: Functions
    seed: int
    steps: int
    taught: str = ""


def identity(lived: Lived, *, traced: bool = False) -> str:
    """Return the identity of lives. In a trace (`traced`) stands also what decides nothing.

    Raises LifeError for what does not fit together, and for a function nobody can tell apart.
    """
    digest = hashlib.sha256()
    for part in _parts(lived, traced):
        digest.update(str(len(part)).encode() + b":" + part)
    return digest.hexdigest()[:32]


def networks_matter(record: np.record) -> bool:
    """Tell whether networks decide anything in the lives of a mind, or are what comes of them."""
    if record.learns or record.judge == ASK_NETWORKS:
        return True
    chooses_by_drives = record.selector in {WINNER_TAKE_ALL, RANDOM}
    return record.judge != ASK_TRUTH and not chooses_by_drives


def _parts(lived: Lived, traced: bool) -> Iterator[bytes]:
    mind, world = lived.mind, lived.world
    record = checked_parameters(mind, world)
    learns = bool(record.learns)
    networks = traced or networks_matter(record)
    unread: set[str] = set() if learns else set(LEARNING)
    unread |= set() if networks else set(ASKING)
    unread |= {"likelihood_threshold"} if record.judge == ACCEPT_ALL else set()
    yield json.dumps([ENGINE, lived.seed, lived.steps]).encode()
    yield from _fields(record, unread)
    yield from _fields(lived.robot.parameters(), set())
    yield _told_of_world(world)
    names = [mind.agent, *mind.resolved_variables(), *mind.drives, *mind.behaviours]
    yield json.dumps(names).encode()
    for role, built_in in BUILT_IN._asdict().items():
        own = getattr(lived.functions, role)
        if own is not built_in and role not in unread:
            try:
                yield f"{role} {lasting_identity(own)}".encode()
            except SettingsError as error:
                raise LifeError(f"{role}: {error}") from None
    if networks:
        untaught = [bool(mind.learning.biases), mind.learning.hidden_units]
        yield lived.taught.encode() if lived.taught else json.dumps(untaught).encode()


@lru_cache(maxsize=64)
def _told_of_world(world: World) -> bytes:
    return world_file(world.name, world.layout, world.resolution).model_dump_json().encode()


def _fields(record: np.record, unread: set[str]) -> Iterator[bytes]:
    """Yield the fields of a record that are read, each with its name."""
    for name in record.dtype.names or ():
        if name not in unread:
            yield name.encode() + b"=" + np.asarray(record[name]).tobytes()

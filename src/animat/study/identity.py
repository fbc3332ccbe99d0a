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

import numpy as np

from animat.life.engine import ENGINE
from animat.life.setting import LifeError, Setting
from animat.mind.agents import ACCEPT_ALL, ASK_NETWORKS, ASK_TRUTH
from animat.mind.functions import BUILT_IN
from animat.mind.selection import RANDOM, WINNER_TAKE_ALL
from animat.numerics.compiled import identity as identity_of_function
from animat.world.files import world_content

LEARNING = ("learning_rate", "learning_cycles", "learning_threshold", "learner")
"""What is read only of a mind that learns."""

ASKING = ("estimator", "feature_noise")
"""What is read only for what networks say or learn."""


def identity(
    setting: Setting, seed: int, steps: int, *, taught: str = "", traced: bool = False
) -> str:
    """Return the identity of the lives of a setting and seed, up to `steps` steps each.

    `taught` is the identity of the networks they are given, if any. In a trace (`traced`) stands
    also what decides nothing. Raises LifeError for a function that has no identity.
    """
    digest = hashlib.sha256()
    for part in _parts(setting, seed, steps, taught, traced):
        digest.update(str(len(part)).encode() + b":" + part)
    return digest.hexdigest()[:32]


def _parts(setting: Setting, seed: int, steps: int, taught: str, traced: bool) -> Iterator[bytes]:
    mind, record = setting.mind, setting.mind_parameters
    learns = bool(record.learns)
    networks = traced or learns or asks_networks(setting)
    unread: set[str] = set()
    if not traced:
        unread |= set() if learns else set(LEARNING)
        unread |= set() if networks else set(ASKING)
        unread |= set() if record.judge != ACCEPT_ALL else {"likelihood_threshold"}
    if not learns:
        unread.add("biases")  # else than for training they are read only at birth, see below
    yield json.dumps([ENGINE, seed, steps]).encode()
    yield from _fields(record, unread)
    yield from _fields(setting.robot_parameters, set())
    world = setting.world
    yield json.dumps(world_content(world.name, world.layout, world.resolution)).encode()
    names = [mind.agent, *mind.resolved_variables(), *mind.drives, *mind.behaviours]
    yield json.dumps(names).encode()
    for role, built_in in BUILT_IN._asdict().items():
        own = getattr(setting.functions, role)
        if own is not built_in and role not in unread:
            plain = getattr(own, "py_func", own)
            known = identity_of_function(plain)
            if known is None:
                raise LifeError(
                    f"{role}: {plain.__name__} takes more from the function around it than numbers"
                    " and texts, so that nobody can tell whether it has changed"
                )
            yield f"{role} {known}".encode()
    if networks:
        untaught = [bool(mind.learning.biases), mind.learning.hidden_units]
        yield taught.encode() if taught else json.dumps(untaught).encode()


def asks_networks(setting: Setting) -> bool:
    """Tell whether what the networks say decides anything in the lives of a setting."""
    record = setting.mind_parameters
    if record.judge == ASK_TRUTH:
        return False
    chooses_by_drives = record.selector in {WINNER_TAKE_ALL, RANDOM}
    return bool(record.judge == ASK_NETWORKS or not chooses_by_drives)


def _fields(record: np.record, unread: set[str]) -> Iterator[bytes]:
    """Yield the fields of a record that are read, each with its name."""
    for name in record.dtype.names or ():
        if name not in unread:
            yield name.encode() + b"=" + np.asarray(record[name]).tobytes()

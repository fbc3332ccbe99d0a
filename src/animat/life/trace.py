"""The trace of a life: what was sensed, felt, done and had of it, a row for each recorded step.

A row holds the pose the robot sensed in, what it sensed and felt there, what it set its motors
to, and what came of it (reward, event) in that step; the next row's pose is where that led. The
row of a death holds the values of the variables that it was a death of.
"""

from __future__ import annotations

from itertools import chain
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.life.state import EVENTS, NO_SITE, STATE
from animat.mind.behaviours import ACT, APPROACH, LEAVE, WANDER
from animat.mind.drives import strongest
from animat.mind.mind import Mind
from animat.names import MODES, TRACE, spelled
from animat.numerics.compiled import compiled
from animat.numerics.layout import Field, Layout
from animat.world.world import World

PLAIN = ("step", "x", "y", "heading", "left", "right", "site", "reward")
"""The columns that hold a field of a row as it is."""


KEPT = (
    *("x", "y", "heading", "left", "right", "readings", "values", "drives"),
    *("mode", "behaviour", "site", "likelihoods", "reward", "event"),
)
"""What a row takes from a state, under the same name."""

ROW = Layout(
    "row",
    (
        Field("step", np.int64),
        *(field for field in (*STATE.single, *STATE.arrays) if field.name in KEPT),
        Field("winner", np.int64),
    ),
)
"""A row of a trace."""

row_at = ROW.at


@compiled
def record_decision(row, state, limit):
    """Write down what led to the motor commands, before they are followed.

    The motors take no command beyond +-`limit`: written down is what they are driven by.
    """
    row.step = state.step
    row.x = state.x
    row.y = state.y
    row.heading = state.heading
    row.left = min(max(state.left, -limit), limit)
    row.right = min(max(state.right, -limit), limit)
    row.mode = state.mode
    row.behaviour = state.behaviour
    row.site = state.site
    row.winner = strongest(state.drives)
    for n in range(len(row.readings)):
        row.readings[n] = state.readings[n]
    for v in range(len(row.values)):
        row.values[v] = state.values[v]
    for d in range(len(row.drives)):
        row.drives[d] = state.drives[d]
    for b in range(len(row.likelihoods)):
        row.likelihoods[b] = state.likelihoods[b]


@compiled
def record_outcome(row, state):
    """Write down what came of the step; in a death, with the values that an act left."""
    row.reward = state.reward
    row.event = state.event
    if state.dead:
        for v in range(len(row.values)):
            row.values[v] = state.values[v]


def table(rows: NDArray[np.void], mind: Mind, world: World) -> pa.Table:
    """Return rows of the kernel as a table, with the names of the mind and of the world."""
    named = {
        "sensor": map(str, range(rows["readings"].shape[1])),
        "variable": list(mind.resolved_variables()),
        "drive": list(mind.drives),
        "behaviour": list(mind.behaviours),
    }
    types = np.array([*world.layout.site_types(), len(world.types)])
    objects = np.where(rows["site"] == NO_SITE, -1, types[rows["site"]])
    said = rows["likelihoods"].T
    values: dict[str, Any] = {name: [rows[name]] for name in TRACE if name in PLAIN}
    values |= {
        "infrared_{sensor}": rows["readings"].T,
        "{variable}": rows["values"].T,
        "{drive}": rows["drives"].T,
        "winning_drive": [_names(rows["winner"], named["drive"])],
        "behaviour": [_behaviour_names(rows, named["behaviour"])],
        "object": [_names(objects, [kind.name for kind in world.types])],
        "likelihood_{behaviour}": [pa.array(one, mask=np.isnan(one)) for one in said],
        "event": [_event_names(rows["event"])],
    }
    names = spelled(TRACE, **named)
    return pa.table(dict(zip(names, chain(*(values[each] for each in TRACE)), strict=True)))


def _names(codes: NDArray[np.int64], names: list[str]) -> pa.Array:
    """Return the names of codes as a dictionary column; null for a negative code."""
    indices = pa.array(codes, mask=codes < 0, type=pa.int32())
    return pa.DictionaryArray.from_arrays(indices, pa.array(names, pa.string()))


def _behaviour_names(rows: NDArray[np.void], behaviours: list[str]) -> pa.Array:
    """Return what the robot was doing; an act goes by the name of its behaviour."""
    doing = {WANDER: 0, APPROACH: 1, LEAVE: 2}
    codes = np.select([rows["mode"] == mode for mode in doing], list(doing.values()), 0)
    codes = np.where(rows["mode"] == ACT, 3 + rows["behaviour"], codes)
    return _names(codes, [*MODES, *behaviours])


def _event_names(events: NDArray[np.int64]) -> pa.Array:
    """Return the names of the events of each step, joined by blanks; empty for none."""
    codes, inverse = np.unique(events, return_inverse=True)
    texts = [" ".join(name for bit, name in enumerate(EVENTS) if code >> bit & 1) for code in codes]
    return _names(inverse.astype(np.int64), texts)

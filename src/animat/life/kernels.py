"""The kernels: some steps of some lives, compiled."""

from __future__ import annotations

from numba import types

from animat.life.state import INDICES, PRESENT, STATE, state_at
from animat.life.step import act, begin, decide, metabolise, sense, step
from animat.life.trace import ROW, record_decision, record_outcome, row_at
from animat.mind.functions import BUILT_IN, ROLES, SLOTS
from animat.mind.parameters import MIND, mind_at
from animat.numerics.layout import BYTES
from animat.numerics.linked import linked
from animat.robot.parameters import ROBOT, robot_at
from animat.world.raster import RASTER


@linked(
    (BYTES, PRESENT, INDICES, BYTES, BYTES, RASTER, types.uint64, types.int64),
    (STATE, MIND, ROBOT),
    SLOTS,
    ROLES,
    BUILT_IN,
)
def live_slice(states, present, lives, minds, robots, raster, seed, until, functions):
    """Live each of L lives on until it has lived `until` steps or is dead.

    `states` [L], `present` [L, S] and `lives` [L], their indices, belong together; `minds` [1] and
    `robots` [1] are those of all.
    """
    mind, robot = mind_at(minds, 0), robot_at(robots, 0)
    for n in range(len(lives)):
        state = state_at(states, n)
        while state.step < until and not state.dead:
            step(state, mind, robot, raster, present[n], functions, seed, lives[n])


@linked(
    (
        *(BYTES, PRESENT, INDICES, BYTES, BYTES, RASTER, types.uint64, types.int64),
        *(BYTES, types.int64, types.int64, types.boolean),
    ),
    (STATE, MIND, ROBOT, ROW),
    SLOTS,
    ROLES,
    BUILT_IN,
)
def live_recorded(
    states, present, lives, minds, robots, raster, seed, until, rows, room, every, ring, functions
):
    """Live one life on as `live_slice` does, and record every `every`-th step and the last.

    `rows` has `room`, is filled from its start, and the slice ends when it is full too; or, if
    `ring`, the row of step t is t mod `room`, and `every` must be 1. Returns how many rows were
    written.
    """
    mind, robot, state = mind_at(minds, 0), robot_at(robots, 0), state_at(states, 0)
    here, seen = present[0], lives[0]
    written = 0
    while state.step < until and not state.dead and (ring or written < room):
        row = row_at(rows, state.step % room if ring else written)
        begin(state)
        sense(state, robot, raster, here, seed, seen)
        metabolise(state, mind, functions)
        if not state.dead:
            decide(state, mind, robot, raster, here, functions, seed, seen)
        record_decision(row, state, robot.max_motor)
        if not state.dead:
            act(state, mind, robot, raster, here, functions, seed, seen)
        record_outcome(row, state)
        if state.step % every == 0 or state.dead:
            written += 1
        state.step += 1
    return written

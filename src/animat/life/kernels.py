"""The kernel: some steps of some lives, compiled."""

from __future__ import annotations

from animat.life.step import act, begin, decide, metabolise, sense, step
from animat.life.trace import record_decision, record_outcome
from animat.numerics.compiled import kernel


@kernel
def live_slice(states, present, lives, mind, robot, raster, functions, seed, until):
    """Live each of L lives on until it has lived `until` steps or is dead.

    `states` [L], `present` [L, S] and `lives` [L], their indices, belong together.
    """
    for n in range(len(states)):
        state = states[n]
        while state.step < until and not state.dead:
            step(state, mind, robot, raster, present[n], functions, seed, lives[n])


@kernel
def live_recorded(
    state, present, life, mind, robot, raster, functions, seed, until, rows, every, ring
):
    """Live one life on as `live_slice` does, and record every `every`-th step and the last.

    `rows` [N] is filled from its start, and the slice ends when it is full too; or, if `ring`, the
    row of step t is t mod N, and `every` must be 1. Returns how many rows were written.
    """
    written = 0
    while state.step < until and not state.dead and (ring or written < len(rows)):
        row = rows[state.step % len(rows)] if ring else rows[written]
        begin(state)
        sense(state, robot, raster, present, seed, life)
        metabolise(state, mind, functions)
        if not state.dead:
            decide(state, mind, robot, raster, present, functions, seed, life)
        record_decision(row, state, robot.max_motor)
        if not state.dead:
            act(state, mind, robot, raster, present, functions, seed, life)
        record_outcome(row, state)
        if state.step % every == 0 or state.dead:
            written += 1
        state.step += 1
    return written

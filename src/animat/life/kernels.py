"""The kernels: some steps of some lives, compiled."""

from __future__ import annotations

from numba import types

from animat.life.encounter import commit, disregard, encounter, meet
from animat.life.model import Key, Model
from animat.life.state import INDICES, PRESENT, STATE, state_at
from animat.life.step import (
    act,
    begin,
    begin_act,
    decide,
    drive,
    metabolise,
    sense,
    sense_what_is_looked_at,
    step,
)
from animat.life.trace import ROW, record_decision, record_outcome, row_at
from animat.mind.behaviours import ACT, WANDER
from animat.mind.functions import BUILT_IN, ROLES, SLOTS
from animat.mind.parameters import MIND, mind_at
from animat.numerics.layout import BYTES
from animat.numerics.linked import linked
from animat.robot.parameters import ROBOT, robot_at
from animat.world.raster import RASTER
from animat.world.scene import Scene

FLAGS = types.Array(types.uint8, 1, "C")
CHOICES = types.Array(types.int64, 1, "C")
COMMANDS = types.Array(types.int64, 2, "C")
"""What is handed over where others decide: who is due [L], choices [L], motor commands [L, 2]."""


@linked(
    (BYTES, PRESENT, INDICES, BYTES, BYTES, RASTER, types.uint64, types.int64),
    (STATE, MIND, ROBOT),
    SLOTS,
    ROLES,
    BUILT_IN,
)
def advance(states, present, lives, minds, robots, raster, seed, until, functions):
    """Advance each of L lives until it has lived `until` steps or is dead.

    `states` [L], `present` [L, S] and `lives` [L], their indices, belong together; `minds` [1] and
    `robots` [1] are those of all.
    """
    model = Model(mind_at(minds, 0), robot_at(robots, 0), functions)
    for n in range(len(lives)):
        state, scene, key = state_at(states, n), Scene(raster, present[n]), Key(seed, lives[n])
        while state.step < until and not state.dead:
            step(state, model, scene, key)


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
def advance_recorded(
    states, present, lives, minds, robots, raster, seed, until, rows, room, every, ring, functions
):
    """Advance one life as `advance` does, and record every `every`-th step and the last.

    `rows` has `room`, is filled from its start, and the call ends when it is full too; or, if
    `ring`, the row of step t is t mod `room`, and `every` must be 1. Returns how many rows were
    written.
    """
    model = Model(mind_at(minds, 0), robot_at(robots, 0), functions)
    state, scene, key = state_at(states, 0), Scene(raster, present[0]), Key(seed, lives[0])
    written = 0
    while state.step < until and not state.dead and (ring or written < room):
        row = row_at(rows, state.step % room if ring else written)
        begin(state)
        sense(state, model.robot, scene, key)
        metabolise(state, model)
        if not state.dead:
            decide(state, model, scene, key)
        record_decision(row, state, model.robot.max_motor)
        if not state.dead:
            act(state, model, scene, key)
        record_outcome(row, state)
        if state.step % every == 0 or state.dead:
            written += 1
        state.step += 1
    return written


@linked(
    (BYTES, PRESENT, INDICES, BYTES, BYTES, RASTER, types.uint64, types.int64, FLAGS),
    (STATE, MIND, ROBOT),
    SLOTS,
    ROLES,
    BUILT_IN,
)
def advance_to_choice(states, present, lives, minds, robots, raster, seed, until, due, functions):
    """Advance each of L lives as `advance` does, but no farther than to a choice of behaviour.

    `due` [L] tells which of them are due: each of these is inside a step, which `take_choice` ends.
    """
    model = Model(mind_at(minds, 0), robot_at(robots, 0), functions)
    for n in range(len(lives)):
        state, scene, key = state_at(states, n), Scene(raster, present[n]), Key(seed, lives[n])
        due[n] = 0
        while state.step < until and not state.dead:
            begin(state)
            if state.mode == WANDER:
                sense_what_is_looked_at(state, model, scene, key)
            metabolise(state, model)
            if not state.dead:
                if state.mode == WANDER and meet(state, model, scene, key):
                    due[n] = 1
                    break
                drive(state, model, scene, key)
                act(state, model, scene, key)
            state.step += 1


@linked(
    (BYTES, PRESENT, INDICES, BYTES, BYTES, RASTER, types.uint64, CHOICES, FLAGS),
    (STATE, MIND, ROBOT),
    SLOTS,
    ROLES,
    BUILT_IN,
)
def take_choice(states, present, lives, minds, robots, raster, seed, choices, due, functions):
    """End the step in which lives are due, with the behaviour chosen for each: `choices` [L].

    A choice of B, one more than the last behaviour, disregards the object; -1 is none.
    """
    model = Model(mind_at(minds, 0), robot_at(robots, 0), functions)
    for n in range(len(lives)):
        if due[n]:
            state, scene, key = state_at(states, n), Scene(raster, present[n]), Key(seed, lives[n])
            if choices[n] == len(model.mind.serves):
                encounter(state)
                disregard(state)
            else:
                commit(state, model.mind, choices[n])
            drive(state, model, scene, key)
            act(state, model, scene, key)
            state.step += 1
            due[n] = 0


@linked(
    (BYTES, PRESENT, INDICES, BYTES, BYTES, RASTER, types.uint64, COMMANDS, CHOICES),
    (STATE, MIND, ROBOT),
    SLOTS,
    ROLES,
    BUILT_IN,
)
def command(states, present, lives, minds, robots, raster, seed, motors, acts, functions):
    """Advance each of L lives that is not dead by one step, with motor commands from outside.

    `motors` [L, 2] are followed unless an act is under way. `acts` [L] are behaviours to begin, or
    -1: one begins where an object is in contact and faced that was not left just before, and ends
    as every act does.
    """
    model = Model(mind_at(minds, 0), robot_at(robots, 0), functions)
    for n in range(len(lives)):
        state, scene, key = state_at(states, n), Scene(raster, present[n]), Key(seed, lives[n])
        if state.dead:
            continue
        begin(state)
        sense(state, model.robot, scene, key)
        metabolise(state, model)
        if not state.dead:
            if state.mode != ACT and 0 <= acts[n] < len(model.mind.serves):
                begin_act(state, model, scene, key, acts[n])
            state.left = 0 if state.mode == ACT else motors[n, 0]
            state.right = 0 if state.mode == ACT else motors[n, 1]
            act(state, model, scene, key)
        state.step += 1

"""The parts of a step as compiled functions that do one of them once more, and what is in each."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from animat.life.encounter import met_site
from animat.life.model import Key, Model
from animat.life.step import step
from animat.mind import behaviours, drives, homeostasis
from animat.mind.behaviours import ACT, WANDER
from animat.numerics.compiled import OPTIONS, compiled
from animat.numerics.elementary import sine_cosine
from animat.numerics.streams import bits
from animat.robot.collision import collide
from animat.robot.infrared import is_dark, read_infrared
from animat.robot.motion import move
from animat.world.scene import Scene

(
    NOTHING,
    BLOCK,
    SINE,
    DRIFT,
    DRIVES,
    DEATH,
    SENSING,
    LOOKING,
    WANDERING,
    MOTION,
    COLLISION,
) = range(11)

OWN_STREAM = 255
"""A purpose that no stream of the package has."""


class Part(NamedTuple):
    """A part of a step: which states do it, and the operations of one call, as its source has them.

    `whole` parts make up the step; the others are contained in those.
    """

    name: str
    which: int
    when: str = "always"
    whole: bool = True
    products: int = 0
    additions_and_products: int = 0
    quotients: int = 0


PARTS = (
    Part("a block of random numbers", BLOCK, "draws and turns", products=20),
    Part("sine and cosine", SINE, "draws and turns", whole=False, additions_and_products=51),
    Part("variables drift", DRIFT, additions_and_products=13, quotients=2),
    Part("drives", DRIVES, additions_and_products=48),
    Part("looking for death", DEATH, additions_and_products=6),
    Part("sensing", SENSING, "wanders"),
    Part("- in the dark", SENSING, "wanders in the dark", whole=False, additions_and_products=5),
    # Sine and cosine, and eight looks before the sensors; the probes come on top.
    Part("- in the light", SENSING, "wanders in the light", False, additions_and_products=154),
    Part("looking for objects", LOOKING, "wanders", additions_and_products=4),
    Part("wandering", WANDERING, "wanders"),
    Part("motion, its sine and cosine too", MOTION, "moves", True, 0, 76, 1),
    Part("collision", COLLISION, "moves", additions_and_products=4),
)


@compiled
def sense(x, y, state, scratch, robot, raster, present):
    """Sense as a step of wandering does, the random numbers apart."""
    if is_dark(x, y, robot, raster):
        for n in range(len(scratch.readings)):
            scratch.readings[n] = 0
    else:
        word = np.uint64(state.step)
        words = word, word, word, word
        heading = state.heading + 0.01
        read_infrared(x, y, heading, robot, raster, present, words, scratch.readings, 0)


@compiled
def do(which, state, scratch, mind, robot, raster, present, functions, seed, life):
    """Do a part of the step of a state once more; what comes of it is left in `scratch`."""
    if which == BLOCK:
        a, b, c, d = bits(seed, life, OWN_STREAM, state.step)
        scratch.step = np.int64(a ^ b ^ c ^ d)
    elif which == SINE:
        # A little aside, so that it cannot be taken from where the step needs the same.
        scratch.x, scratch.y = sine_cosine(state.heading + 0.01)
    elif which == DRIFT:
        homeostasis.metabolise(scratch.values, mind, functions.law)
    elif which == DRIVES:
        drives.raise_drives(state.values, state.changes, mind, scratch.drives, functions.drives)
    elif which == DEATH:
        scratch.death_variable = homeostasis.first_outside(state.values, mind)
    elif which == SENSING:
        sense(state.x + 0.0, state.y + 0.0, state, scratch, robot, raster, present)
    elif which == LOOKING:
        scratch.site = met_site(state, robot.radius + mind.encounter_range, Scene(raster, present))
    elif which == WANDERING:
        left, right = behaviours.wander(
            mind.wander,
            state.readings,
            robot.sensor_cosine,
            robot.sensor_y,
            scratch.memory,
            0.4,
            0.6,
            mind.cruise_speed,
            mind.turn_speed,
            functions.wander,
        )
        scratch.left = int(left)
        scratch.right = int(right)
    elif which == MOTION:
        scratch.x, scratch.y, scratch.heading = move(
            state.x, state.y, state.heading, state.left, state.right, robot, 0.3, 0.6, 0.2
        )
    elif which == COLLISION:
        scratch.x, scratch.y, scratch.heading, scratch.dead = collide(
            state.x,
            state.y,
            state.heading,
            state.x + 1.0,
            state.y + 1.0,
            state.heading + 0.01,
            robot,
            raster,
            present,
        )


@njit(**OPTIONS)
def alone(which, rounds, states, scratch, mind, robot, raster, functions, seed, present):
    """Do a part for every one of the states, so many times."""
    for _ in range(rounds):
        for n in range(len(states)):
            do(
                which,
                states[n],
                scratch[0],
                mind,
                robot,
                raster,
                present[0],
                functions,
                seed,
                np.uint64(n),
            )


@njit(**OPTIONS)
def in_step(which, until, states, scratch, mind, robot, raster, functions, seed, present):
    """Live lives on, with a part done once more in every step that needs it."""
    model = Model(mind, robot, functions)
    for n in range(len(states)):
        state = states[n]
        life = np.uint64(n)
        while state.step < until:
            wanders = state.mode == WANDER
            if which < SENSING or wanders or (which > WANDERING and state.mode != ACT):
                do(
                    which,
                    state,
                    scratch[0],
                    mind,
                    robot,
                    raster,
                    present[n],
                    functions,
                    seed,
                    life,
                )
            step(state, model, Scene(raster, present[n]), Key(seed, life))


@njit(**OPTIONS)
def dark_at(x, y, robot, raster):
    """Tell whether there is nothing for a sensor to see."""
    return is_dark(x, y, robot, raster)

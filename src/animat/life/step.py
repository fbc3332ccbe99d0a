"""One step of a life: sense, metabolise, decide, act.

This is the hot path. `step` is the whole of it, top to bottom. Who wants to decide in the mind's
place does so through `animat.life.control`. Every function changes `state`, the record of
`animat.life.state`, in place, and reads `model` (mind, robot and functions), `scene` (what stands
about) and `key` (what random numbers are addressed by).

    sense       read the infrared sensors; `step` leaves out what the search would not look at
    metabolise  the variables drift, the drives follow, a life may end
    decide      wander, meet an object, choose a behaviour, steer
    act         move, collide, and take the outcome of an act that ends
"""

from __future__ import annotations

import math

from animat.life import failure
from animat.life.encounter import (
    abandon,
    change_mode,
    choose,
    commit,
    encounter,
    forget_lost,
    judge,
    meet,
    met_site,
    perceive,
)
from animat.life.outcome import check_viability, end_act
from animat.life.sight import bearing, distance_to
from animat.life.state import BLOCKED, NO_SITE, REACHED, UNREACHED
from animat.mind import behaviours, drives, homeostasis
from animat.mind.behaviours import ACT, APPROACH, CUSTOM_WANDER, LEAVE, WANDER
from animat.numerics.compiled import compiled
from animat.numerics.slots import any_custom
from animat.numerics.streams import MOTORS, SENSORS, bits, uniforms
from animat.numerics.streams import WANDER as WANDERING
from animat.robot.collision import collide
from animat.robot.infrared import NOISES, is_dark, read_infrared
from animat.robot.motion import move

BLOCK = 1 << 48
"""How far apart the noise of two sensors is addressed: 8 of it are more than a life has steps."""


@compiled
def step(state, model, scene, key):
    """Live one step. A life that ends in it is `dead` afterwards."""
    begin(state)
    if state.mode == WANDER:
        sense_what_is_looked_at(state, model, scene, key)
    metabolise(state, model)
    if not state.dead:
        decide(state, model, scene, key)
        act(state, model, scene, key)
    state.step += 1


@compiled
def begin(state):
    """Clear what is said of one step only."""
    state.event = 0
    state.reward = 0


@compiled
def sense_what_is_looked_at(state, model, scene, key):
    """Sense as much as the search will look at: not the noise of sensors that see nothing."""
    wander, robot = model.mind.wander, model.robot
    if behaviours.ignores_the_dark(wander) and is_dark(state.x, state.y, robot, scene.raster):
        for n in range(len(state.readings)):
            state.readings[n] = 0
    else:
        sense(state, model.robot, scene, key)


@compiled
def sense(state, robot, scene, key):
    """Read the infrared sensors where the robot stands."""
    raster, present, readings = scene.raster, scene.present, state.readings
    for first in range(0, len(readings), NOISES):
        words = bits(key.seed, key.life, SENSORS, state.step + first * BLOCK)
        x, y, heading = state.x, state.y, state.heading
        read_infrared(x, y, heading, robot, raster, present, words, readings, first)


@compiled
def metabolise(state, model):
    """Let the variables drift for one step and the drives follow them; end a life that must."""
    mind, functions = model.mind, model.functions
    failure.asks(state, failure.LAW)
    homeostasis.metabolise(state.values, mind, functions.law)
    for v in range(len(state.values)):
        state.changes[v] = state.values[v] - state.previous[v]
        state.previous[v] = state.values[v]
    failure.asks(state, failure.DRIVES)
    drives.raise_drives(state.values, state.changes, mind, state.drives, functions.drives)
    total = 0.0
    for drive in state.drives:
        total += drive
    state.drive_sum += total / len(state.drives)
    if any_custom():
        check_needs(state, mind)
    check_viability(state, mind, homeostasis.METABOLISM)


@compiled
def check_needs(state, mind):
    """Fail a life in which a custom law or drive function gave what is not finite."""
    for v in range(len(state.values)):
        if mind.law[v] == homeostasis.CUSTOM_LAW and not math.isfinite(state.values[v]):
            failure.fail(state, failure.LAW, 0.0, 0.0)
    if mind.error == drives.CUSTOM_DRIVES and not drives.all_finite(state.drives):
        failure.fail(state, failure.DRIVES, 0.0, 0.0)


@compiled
def decide(state, model, scene, key):
    """Set the motor commands of this step, meeting an object if one is near."""
    if state.mode == WANDER and meet(state, model, scene, key):
        commit(state, model.mind, choose(state, model, key))
    drive(state, model, scene, key)


@compiled
def drive(state, model, scene, key):
    """Set the motor commands that what the robot is doing calls for."""
    if state.mode == WANDER:
        search(state, model, key)
    elif state.mode == ACT:
        state.left = 0
        state.right = 0
    else:
        steer(state, model.mind, scene.raster)


@compiled
def act(state, model, scene, key):
    """Move by the motor commands, and go on with what the robot is doing."""
    mind, robot, raster = model.mind, model.robot, scene.raster
    move_and_collide(state, robot, scene, key)
    state.mode_steps += 1
    if state.mode == APPROACH:
        if is_reached(state, model, raster):
            state.event |= REACHED
            change_mode(state, ACT)
        elif state.mode_steps >= mind.approach_steps:
            state.event |= UNREACHED
            state.unreached += 1
            abandon(state)
    elif state.mode == ACT:
        if state.mode_steps >= mind.interaction_steps:
            end_act(state, model, scene, key)
    elif state.mode == LEAVE:
        ahead, aside = bearing(state, raster)
        if behaviours.has_left(ahead, aside) or state.mode_steps >= mind.leave_steps:
            state.site = NO_SITE
            change_mode(state, WANDER)
    forget_lost(state, robot.radius + mind.encounter_range, raster)


@compiled
def begin_act(state, model, scene, key, behaviour):
    """Begin an act with the nearest object in contact, if it is faced."""
    mind, raster = model.mind, scene.raster
    site = met_site(state, model.robot.radius + mind.contact_range, scene)
    if site == NO_SITE:
        return
    before, state.site = state.site, site
    if not is_reached(state, model, raster):
        state.site = before
        return
    state.met = site
    perceive(state, mind, raster.features[raster.site_type[site]], key)
    judge(state, mind, raster.affords[raster.site_type[site]], model.functions)
    encounter(state)
    state.event |= REACHED
    state.behaviour = behaviour
    state.likelihoods[behaviour] = state.estimates[behaviour]
    change_mode(state, ACT)


@compiled
def is_reached(state, model, raster):
    """Tell whether the object the robot deals with is in contact, and faced."""
    distance = distance_to(state.site, state.x, state.y, raster)
    ahead, aside = bearing(state, raster)
    reach = model.robot.radius + model.mind.contact_range
    return distance <= reach and behaviours.faces(ahead, aside)


@compiled
def search(state, model, key):
    """Wander: no object calls for anything."""
    mind, robot = model.mind, model.robot
    u_a = u_b = 0.0
    if behaviours.needs_numbers(mind.wander, state.memory):
        u_a, u_b, _, _ = uniforms(key.seed, key.life, WANDERING, state.step)
    failure.asks(state, failure.WANDER)
    left, right = behaviours.wander(
        mind.wander,
        state.readings,
        robot.sensor_cosine,
        robot.sensor_y,
        state.memory,
        u_a,
        u_b,
        mind.cruise_speed,
        mind.turn_speed,
        model.functions.wander,
    )
    if (
        any_custom()
        and mind.wander == CUSTOM_WANDER
        and not can_be_driven(left, right, robot.max_motor)
    ):
        failure.fail(state, failure.WANDER, left, right)
        left = right = 0
    state.left = int(left)
    state.right = int(right)


@compiled
def can_be_driven(left, right, limit):
    """Tell whether two commands, cut to whole numbers, are within the limit of the motors."""
    return abs(left) < limit + 1.0 and abs(right) < limit + 1.0


@compiled
def steer(state, mind, raster):
    """Turn to the object and approach it, or turn away from it."""
    ahead, aside = bearing(state, raster)
    if state.mode == APPROACH:
        left, right = behaviours.approach(ahead, aside, mind.cruise_speed, mind.turn_speed)
    else:
        left, right = behaviours.leave(ahead, aside, mind.cruise_speed, mind.turn_speed)
    state.left = left
    state.right = right


@compiled
def move_and_collide(state, robot, scene, key):
    """Move by the motor commands, unless something stands in the way."""
    if state.left == 0 and state.right == 0:
        return
    u_x, u_y, u_turn, _ = uniforms(key.seed, key.life, MOTORS, state.step)
    x, y, heading = move(
        state.x, state.y, state.heading, state.left, state.right, robot, u_x, u_y, u_turn
    )
    x, y, heading, blocked = collide(
        state.x, state.y, state.heading, x, y, heading, robot, scene.raster, scene.present
    )
    state.x = x
    state.y = y
    state.heading = heading
    if blocked:
        state.event |= BLOCKED
        state.blocked += 1

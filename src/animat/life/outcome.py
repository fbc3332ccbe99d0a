"""The outcome of an act: success or failure, what it does to needs, and what is learnt of it."""

from __future__ import annotations

from animat.life import failure
from animat.life.encounter import abandon
from animat.life.sight import OUT_OF_SIGHT, distance_to
from animat.life.state import DIED, FAILED, HIGH, LOW, SUCCEEDED, TRAINED
from animat.mind import affordance, drives, homeostasis
from animat.numerics.compiled import compiled
from animat.numerics.slots import any_custom
from animat.numerics.streams import OUTCOMES, PLACEMENT, uniforms


@compiled
def end_act(state, model, scene, key):
    """End an act: success or failure, what it does to the variables, and what is learnt of it."""
    mind, raster, functions = model.mind, scene.raster, model.functions
    b = state.behaviour
    likelihood = raster.affords[raster.site_type[state.site], mind.needs[b]]
    u, _, _, _ = uniforms(key.seed, key.life, OUTCOMES, state.acts)
    succeeded = u < likelihood
    state.acts += 1
    state.acts_by_behaviour[b] += 1
    if succeeded:
        state.event |= SUCCEEDED
        state.reward = 1
        state.successes += 1
        state.successes_by_behaviour[b] += 1
        apply_effects(state, mind, mind.success[b], functions)
    else:
        state.event |= FAILED
        state.reward = -1
        apply_effects(state, mind, mind.failure[b], functions)
    cause = homeostasis.SUCCESS if succeeded else homeostasis.FAILURE
    check_viability(state, mind, cause)
    left = state.site
    abandon(state)
    if succeeded and mind.consumed:
        replace(left, state, scene, key)


@compiled
def apply_effects(state, mind, effects, functions):
    """Move the variables by `effects` [V]; learn if the acting drive varied suddenly.

    The variation is that of the drive before the variables are held back at their bounds, so that
    no failure goes unnoticed.
    """
    for v in range(len(state.values)):
        state.values_after[v] = state.values[v] + effects[v]
        state.changes_after[v] = state.changes[v] + effects[v]
    if mind.learns:
        failure.asks(state, failure.DRIVES)
        drives.raise_drives(
            state.values_after, state.changes_after, mind, state.drives_after, functions.drives
        )
        custom = any_custom() and mind.error == drives.CUSTOM_DRIVES
        if custom and not drives.all_finite(state.drives_after):
            failure.fail(state, failure.DRIVES, 0.0, 0.0)
        acting = mind.serves[state.behaviour]
        variation = state.drives_after[acting] - state.drives[acting]
        if abs(variation) > mind.learning_threshold:
            train(state, mind, 1.0 if variation < 0.0 else 0.0, functions)
    homeostasis.settle(state.values, state.values_after, mind)


@compiled
def train(state, mind, target, functions):
    """Train the network of the behaviour that was run towards what came of it."""
    state.event |= TRAINED
    state.trainings += 1
    failure.asks(state, failure.LEARNER)
    weights = state.weights[state.behaviour]
    affordance.learn(
        mind.learner,
        state.features,
        weights,
        state.hidden,
        target,
        mind.learning_rate,
        mind.learning_cycles,
        mind.biases,
        functions.learner,
    )
    custom = any_custom() and mind.learner == affordance.CUSTOM_LEARNER
    if custom and not drives.all_finite(weights):
        failure.fail(state, failure.LEARNER, 0.0, 0.0)


@compiled
def check_viability(state, mind, cause):
    """End the life if a variable is outside its viability zone."""
    v = homeostasis.first_outside(state.values, mind)
    if v >= 0:
        state.dead = True
        state.event |= DIED
        state.death_variable = v
        state.death_side = LOW if state.values[v] < mind.dies_below[v] else HIGH
        state.death_cause = cause


@compiled
def replace(site, state, scene, key):
    """Put an object that was used up onto a spare site of its kind, out of sight, if one is free.

    With k sites free, each is taken with probability 1/k; where none is, the object stays.
    """
    present = scene.present
    free = 0
    for s in range(len(present)):
        if is_spare(s, site, state, scene):
            free += 1
    u, _, _, _ = uniforms(key.seed, key.life, PLACEMENT, state.acts)
    take = int(u * free)
    for s in range(len(present)):
        if is_spare(s, site, state, scene):
            if take == 0:
                present[s] = 1
                present[site] = 0
                return
            take -= 1


@compiled
def is_spare(s, site, state, scene):
    """Tell whether an object of `site` can be put onto site s, where nobody sees it."""
    raster = scene.raster
    return (
        not scene.present[s]
        and raster.site_type[s] == raster.site_type[site]
        and distance_to(s, state.x, state.y, raster) == OUT_OF_SIGHT
    )

"""Encounters: meeting an object, judging it, taking it on or leaving it.

An encounter begins when the edge of an object comes within `encounter_range` of the robot's rim,
the nearest object first. An object that was left cannot be met again until it has been out of that
range (2010).
"""

from __future__ import annotations

import math

from animat.life import failure
from animat.life.sight import distance_to, row_and_column
from animat.life.state import ABANDONED, DISREGARDED, ENCOUNTERED, NO_SITE
from animat.mind import affordance, drives, selection
from animat.mind.affordance import CUSTOM_ESTIMATOR
from animat.mind.agents import ACCEPT_ALL, ASK_TRUTH
from animat.mind.behaviours import APPROACH, LEAVE
from animat.numerics.compiled import compiled
from animat.numerics.slots import any_custom
from animat.numerics.streams import FEATURES, SELECTION, uniforms


@compiled
def meet(state, model, scene, key):
    """Perceive and judge an object if one is near; tell whether a behaviour has to be chosen."""
    mind, raster = model.mind, scene.raster
    site = met_site(state, model.robot.radius + mind.encounter_range, scene)
    if site == NO_SITE:
        return False
    if mind.gated and not state.drives[drives.strongest(state.drives)] > 0.0:
        return False
    state.met = site
    perceive(state, mind, raster.features[raster.site_type[site]], key)
    judge(state, mind, raster.affords[raster.site_type[site]], model.functions)
    return True


@compiled
def choose(state, model, key):
    """Return the behaviour that the mind chooses for the object met, or -1 for none."""
    u, _, _, _ = uniforms(key.seed, key.life, SELECTION, state.step)
    failure.asks(state, failure.SELECTOR)
    return selection.select(
        model.mind.selector,
        state.drives,
        state.estimates,
        model.mind.serves,
        u,
        state.choice_memory,
        model.functions.selector,
    )


@compiled
def commit(state, mind, chosen):
    """Take on the object met with the behaviour chosen, or disregard it if that seems in vain."""
    if chosen < 0 or chosen >= len(mind.serves):
        state.met = NO_SITE
        if chosen != -1:
            failure.fail(state, failure.SELECTOR, float(chosen), 0.0)
        return
    encounter(state)
    state.behaviour = chosen
    state.likelihoods[chosen] = state.estimates[chosen]
    if mind.judge == ACCEPT_ALL or state.estimates[chosen] >= mind.likelihood_threshold:
        change_mode(state, APPROACH)
    else:
        disregard(state)


@compiled
def encounter(state):
    """Begin to deal with the object met."""
    state.event |= ENCOUNTERED
    state.encounters += 1
    state.site = state.met
    state.met = NO_SITE


@compiled
def disregard(state):
    """Leave the object that was just encountered."""
    state.event |= DISREGARDED
    state.disregarded += 1
    abandon(state)


@compiled
def met_site(state, reach, scene):
    """Return the nearest object within `reach` (mm) of the centre that was not abandoned, or -1."""
    raster, present = scene.raster, scene.present
    row, column = row_and_column(state.x, state.y, raster)
    for k in range(raster.near_site.shape[2]):
        if not raster.near_distance[row, column, k] <= reach:
            return NO_SITE
        site = raster.near_site[row, column, k]
        if present[site] and not is_abandoned(state, site):
            return site
    return NO_SITE


@compiled
def perceive(state, mind, features, key):
    """Take in the features [F] of an object, with noise if there is any."""
    for f in range(len(state.features)):
        state.features[f] = features[f]
        if mind.feature_noise > 0.0:
            number = state.step * len(state.features) + f
            noise, _, _, _ = uniforms(key.seed, key.life, FEATURES, number)
            state.features[f] += mind.feature_noise * (2.0 * noise - 1.0)


@compiled
def judge(state, mind, affords, functions):
    """Estimate how likely the object perceived affords each behaviour."""
    failure.asks(state, failure.ESTIMATOR)
    for b in range(len(state.estimates)):
        if mind.judge == ASK_TRUTH:
            state.estimates[b] = affords[mind.needs[b]]
        else:
            state.estimates[b] = affordance.estimate(
                mind.estimator,
                state.features,
                state.weights[b],
                state.hidden,
                functions.estimator,
            )
            custom = any_custom() and mind.estimator == CUSTOM_ESTIMATOR
            if custom and not math.isfinite(state.estimates[b]):
                failure.fail(state, failure.ESTIMATOR, 0.0, 0.0)


@compiled
def change_mode(state, mode):
    """Begin to do something else."""
    state.mode = mode
    state.mode_steps = 0


@compiled
def abandon(state):
    """Leave the object, and do not meet it again until it has been out of sight."""
    for n in range(ABANDONED - 1, 0, -1):
        state.abandoned[n] = state.abandoned[n - 1]
    state.abandoned[0] = state.site
    change_mode(state, LEAVE)


@compiled
def is_abandoned(state, site):
    """Tell whether an object was left and has been in sight ever since."""
    for abandoned in state.abandoned:
        if abandoned == site:
            return True
    return False


@compiled
def forget_lost(state, reach, raster):
    """Forget the abandoned objects that are no longer within `reach` (mm) of the centre."""
    if state.abandoned[0] == NO_SITE:
        return
    kept = 0
    for n in range(ABANDONED):
        site = state.abandoned[n]
        if site != NO_SITE and distance_to(site, state.x, state.y, raster) <= reach:
            state.abandoned[kept] = site
            kept += 1
    for n in range(kept, ABANDONED):
        state.abandoned[n] = NO_SITE

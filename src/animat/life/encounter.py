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
from animat.numerics.linked import any_custom
from animat.numerics.streams import FEATURES, SELECTION, uniforms


@compiled
def look_around(state, mind, robot, raster, present, functions, seed, life):
    """Meet an object if one is near and a drive asks for something."""
    site = met_site(state, robot.radius + mind.encounter_range, raster, present)
    if site == NO_SITE:
        return
    if mind.gated and not state.drives[drives.strongest(state.drives)] > 0.0:
        return
    perceive(state, mind, raster.features[raster.site_type[site]], seed, life)
    judge(state, mind, raster.affords[raster.site_type[site]], functions)
    luck, _, _, _ = uniforms(seed, life, SELECTION, state.step)
    failure.asks(state, failure.SELECTOR)
    chosen = selection.select(
        mind.selector, state.drives, state.estimates, mind.serves, luck, functions.selector
    )
    if chosen < 0 or chosen >= len(mind.serves):
        if chosen != -1:
            failure.fail(state, failure.SELECTOR, float(chosen), 0.0)
        return
    state.event |= ENCOUNTERED
    state.encounters += 1
    state.site = site
    state.behaviour = chosen
    state.likelihoods[chosen] = state.estimates[chosen]
    if mind.judge == ACCEPT_ALL or state.estimates[chosen] >= mind.likelihood_threshold:
        change_mode(state, APPROACH)
    else:
        state.event |= DISREGARDED
        state.disregarded += 1
        abandon(state)


@compiled
def met_site(state, reach, raster, present):
    """Return the nearest object within `reach` (mm) of the centre that was not abandoned, or -1."""
    row, column = row_and_column(state.x, state.y, raster)
    for k in range(raster.near_site.shape[2]):
        if not raster.near_distance[row, column, k] <= reach:
            return NO_SITE
        site = raster.near_site[row, column, k]
        if present[site] and not is_abandoned(state, site):
            return site
    return NO_SITE


@compiled
def perceive(state, mind, features, seed, life):
    """Take in the features [F] of an object, with noise if there is any."""
    for f in range(len(state.features)):
        state.features[f] = features[f]
        if mind.feature_noise > 0.0:
            noise, _, _, _ = uniforms(seed, life, FEATURES, state.step * len(state.features) + f)
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

"""Birth: where a life starts and with what networks.

The start pose is uniform over the playground, at least 50 mm from its edge and clear of
everything; the weights of untrained networks are uniform in [0, 1). Both come from streams of
their own, so that lives of one seed and index start alike whatever their agent.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types
from numpy.typing import NDArray

from animat.life.sight import row_and_column
from animat.life.state import INDICES, NO_SITE, PRESENT, STATE, Counts, state_at, state_dtype
from animat.numerics.compiled import compiled
from animat.numerics.layout import BYTES
from animat.numerics.linked import linked
from animat.numerics.streams import START, WEIGHTS, uniforms
from animat.robot.collision import CLEAR, touched
from animat.robot.parameters import ROBOT, robot_at
from animat.world.raster import RASTER

START_MARGIN = 50.0
"""How far from the edge of the playground a life starts at least, in mm."""

ATTEMPTS = 100_000
"""How many poses are tried before a world counts as having no room to start."""


@linked(
    (BYTES, PRESENT, INDICES, BYTES, RASTER, types.uint64, types.float64, types.float64),
    (STATE, ROBOT),
)
def place(states, present, lives, robots, raster, seed, width, height, functions):
    """Set the start poses of L states; return how many found no clear pose."""
    homeless = 0
    for n in range(len(lives)):
        state, body = state_at(states, n), robot_at(robots, 0)
        if not find_pose(state, present[n], body, raster, seed, lives[n], width, height):
            homeless += 1
    return homeless


@compiled
def find_pose(state, present, robot, raster, seed, life, width, height):
    """Set the pose to the first clear one of those the stream START offers.

    Clear is a pose in which no ring point is hit, and nothing small stands within the ring either.
    """
    for attempt in range(ATTEMPTS):
        u_x, u_y, u_heading, _ = uniforms(seed, life, START, attempt)
        x = START_MARGIN + u_x * (width - 2.0 * START_MARGIN)
        y = START_MARGIN + u_y * (height - 2.0 * START_MARGIN)
        heading = math.pi - u_heading * 2.0 * math.pi
        if raster.clearance[row_and_column(x, y, raster)] < robot.ring_radius:
            continue
        if touched(x, y, heading, robot, raster, present) == CLEAR:
            state.x = x
            state.y = y
            state.heading = heading
            return True
    return False


@linked((BYTES, INDICES, types.uint64), (STATE,))
def draw_weights(states, lives, seed, functions):
    """Draw the weights of L states from U[0, 1)."""
    for n in range(len(lives)):
        weights = state_at(states, n).weights
        rows, columns = weights.shape
        for b in range(rows):
            for w in range(columns):
                index = b * columns + w
                draws = uniforms(seed, lives[n], WEIGHTS, index // 4)
                weights[b, w] = draws[index % 4]


def born(
    counts: Counts, parameters: np.record, lives: int, weights: NDArray | None
) -> NDArray[np.void]:
    """Return the states [L] of lives at birth, still without a place.

    `weights` [B, W] or [L, B, W] are the networks they are born with; None leaves them at 0.
    """
    states = np.zeros(lives, state_dtype(counts))
    states["values"] = parameters.start
    states["previous"] = parameters.start
    states["behaviour"] = -1
    states["death_variable"] = -1
    states["death_side"] = -1
    states["site"] = NO_SITE
    states["met"] = NO_SITE
    states["likelihoods"] = np.nan
    states["abandoned"] = NO_SITE
    if weights is not None:
        states["weights"] = weights
    return states


def clear_biases(states: NDArray[np.void], features: int, hidden: int) -> None:
    """Set the biases of networks that are to have none to 0."""
    places = [*range(0, hidden * (features + 1), features + 1), hidden * (features + 1)]
    states["weights"][:, :, places] = 0.0

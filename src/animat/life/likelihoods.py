"""What the networks of robots say of every object type of a world."""

from __future__ import annotations

import numpy as np
from numba import types
from numpy.typing import NDArray

from animat.life.scenario import Setting
from animat.life.state import STATE, state_at
from animat.mind import affordance
from animat.mind.functions import BUILT_IN, ROLES, SLOTS
from animat.mind.parameters import MIND, mind_at
from animat.numerics.layout import BYTES, raw
from animat.numerics.linked import linked
from animat.numerics.threads import attempt


def likelihoods(setting: Setting, states: NDArray[np.void]) -> NDArray[np.float64]:
    """Return the likelihoods [L, B, T] of L lives, by behaviour and object type.

    Those of a life for which a custom estimator raises are NaN.
    """
    types = setting.raster.features.shape[0]
    behaviours = len(setting.mind.behaviours)
    said = np.zeros((len(states), behaviours, types))
    ask = _ask.of(setting.counts, setting.functions)
    mind, _, raster = setting.constants

    def asked(some: slice) -> Exception | None:
        return attempt(lambda: ask(raw(states[some]), mind, raster.features, said[some]))[1]

    if asked(slice(None)) is not None:
        for n in range(len(states)):
            if asked(slice(n, n + 1)) is not None:
                said[n] = np.nan
    return said


def afforded(setting: Setting) -> NDArray[np.float64]:
    """Return the truth [B, T]: Table 1's probabilities, by behaviour and object type."""
    return setting.raster.affords.T[setting.mind_parameters.needs]


@linked(
    (BYTES, BYTES, types.Array(types.float64, 2, "C"), types.Array(types.float64, 3, "C")),
    (STATE, MIND),
    SLOTS,
    ROLES,
    BUILT_IN,
)
def _ask(states, minds, features, said, functions):
    mind = mind_at(minds, 0)
    for n in range(len(said)):
        state = state_at(states, n)
        for b in range(said.shape[1]):
            for t in range(said.shape[2]):
                said[n, b, t] = affordance.estimate(
                    mind.estimator,
                    features[t],
                    state.weights[b],
                    state.hidden,
                    functions.estimator,
                )

"""What the networks of robots say of every object type of a world."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from animat.life.scenario import Setting
from animat.mind import affordance
from animat.numerics.compiled import kernel
from animat.numerics.threads import attempt


def likelihoods(setting: Setting, states: NDArray[np.void]) -> NDArray[np.float64]:
    """Return the likelihoods [L, B, T] of L lives, by behaviour and object type.

    Those of a life for which a custom estimator raises are NaN.
    """
    types = setting.raster.features.shape[0]
    behaviours = len(setting.mind.behaviours)
    said = np.zeros((len(states), behaviours, types))
    rest = setting.mind_parameters, setting.raster.features, setting.functions
    if attempt(lambda: _ask(states, *rest, said))[1] is None:
        return said
    for n in range(len(states)):
        if attempt(lambda n=n: _ask(states[n : n + 1], *rest, said[n : n + 1]))[1] is not None:
            said[n] = np.nan
    return said


def afforded(setting: Setting) -> NDArray[np.float64]:
    """Return the truth [B, T]: Table 1's probabilities, by behaviour and object type."""
    return setting.raster.affords.T[setting.mind_parameters.needs]


@kernel
def _ask(states, mind, features, functions, said):
    for n in range(len(states)):
        state = states[n]
        for b in range(said.shape[1]):
            for t in range(said.shape[2]):
                said[n, b, t] = affordance.estimate(
                    mind.estimator,
                    features[t],
                    state.weights[b],
                    state.hidden,
                    functions.estimator,
                )

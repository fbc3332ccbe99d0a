"""What a mind has learnt: the weights of its affordance networks, with the names they go by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from animat.mind.affordance import feed_forward


@dataclass(frozen=True)
class Networks:
    """The trained networks of one robot.

    `weights` [B, W], a row for each of `behaviours`; `features`, the names of the F inputs;
    `hidden`, the number of hidden units H.
    """

    behaviours: tuple[str, ...]
    features: tuple[str, ...]
    hidden: int
    weights: NDArray[np.float64]

    def likelihoods(self, features: dict[str, float]) -> dict[str, float]:
        """Return for each behaviour how likely an object with these features is to afford it.

        >>> life.networks.likelihoods({"shape": 1.0, "size": 0.0})  # doctest: +SKIP
        {'eat': 0.97, 'shelter': 0.02, 'interact': 0.99}
        """
        inputs = np.array([features[name] for name in self.features])
        hidden = np.zeros(self.hidden)
        return {
            behaviour: float(feed_forward(inputs, self.weights[b], hidden))
            for b, behaviour in enumerate(self.behaviours)
        }

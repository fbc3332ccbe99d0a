"""What a mind has learnt: the weights of its affordance networks, with the names they go by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from animat.mind.affordance import feed_forward, weight_count
from animat.numerics.compiled import kernel
from animat.settings import nearest


@dataclass(frozen=True, eq=False)
class Networks:
    """The trained networks of one robot.

    `weights` [B, W], a row for each of `behaviours`; `features`, the names of the F inputs;
    `hidden`, the number of hidden units H. The weights are copied and cannot be changed. Raises
    ValueError where there are not as many weights as the names ask for, or one is not finite.
    """

    behaviours: tuple[str, ...]
    features: tuple[str, ...]
    hidden: int
    weights: NDArray[np.float64]

    def __post_init__(self) -> None:
        """Take a copy of the weights, and check that they fit."""
        weights = np.array(self.weights, np.float64, order="C")
        wanted = (len(self.behaviours), weight_count(len(self.features), self.hidden))
        if self.hidden < 1 or weights.shape != wanted:
            raise ValueError(
                f"weights of shape {weights.shape} do not fit {len(self.behaviours)} networks of"
                f" {len(self.features)} features and {self.hidden} hidden units: {wanted}"
            )
        if not np.isfinite(weights).all():
            raise ValueError("weights of networks must be finite numbers")
        weights.setflags(write=False)
        object.__setattr__(self, "weights", weights)

    def __eq__(self, other: object) -> bool:
        """Tell whether two networks have the same names and the same weights."""
        return isinstance(other, Networks) and self._key() == other._key()

    def __hash__(self) -> int:
        """Equal networks have the same hash."""
        return hash(self._key())

    def _key(self) -> tuple[object, ...]:
        return self.behaviours, self.features, self.hidden, self.weights.tobytes()

    def likelihoods(self, features: dict[str, float]) -> dict[str, float]:
        """Return for each behaviour how likely an object with these features is to afford it.

        Raises ValueError where the features are not those the networks know.

        >>> life.networks.likelihoods({"shape": 1.0, "size": 0.0})  # doctest: +SKIP
        {'eat': 0.97, 'shelter': 0.02, 'interact': 0.99}
        """
        for name in features:
            if name not in self.features:
                raise ValueError(f'"{name}" is no feature{nearest(name, self.features)}')
        missing = [name for name in self.features if name not in features]
        if missing:
            raise ValueError(f"features lack {', '.join(missing)}")
        inputs = np.array([features[name] for name in self.features])
        outputs = np.zeros(len(self.behaviours))
        ask(inputs, self.weights, np.zeros(self.hidden), outputs)
        return dict(zip(self.behaviours, outputs.tolist(), strict=True))


@kernel
def ask(features, weights, hidden, outputs):
    """Fill in what each of B networks, `weights` [B, W], puts out for `features` [F]."""
    for b in range(len(outputs)):
        outputs[b] = feed_forward(features, weights[b], hidden)

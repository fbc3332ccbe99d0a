"""What a mind has learnt: the weights of its affordance networks, with the names they go by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from animat.files import arguments
from animat.files.arguments import boolean, instance, real, reals, sequence, whole
from animat.files.settings import SettingsError, nearest
from animat.files.validation_errors import plain
from animat.mind.affordance import feed_forward, weight_count
from animat.mind.networks_file import read_networks_file, write_networks_file
from animat.names import name_problems
from animat.numerics.compiled import kernel

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_HIDDEN = 64
"""Hidden units of a network."""


@dataclass(frozen=True, eq=False)
class Networks:
    """The trained networks of one robot.

    `weights` [B, W], a row for each of `behaviours`; `features`, the names of the F inputs;
    `hidden`, the number of hidden units H; `custom`, whether they were learnt for a custom
    estimator, which alone can tell what they say. The weights are copied and cannot be changed.
    Raises SettingsError where there are not as many weights as the names ask for, or one is not
    finite.
    """

    behaviours: tuple[str, ...]
    features: tuple[str, ...]
    hidden: int
    weights: NDArray[np.float64]
    custom: bool = False

    def __post_init__(self) -> None:
        """Take a copy of the weights, and check that they fit."""
        behaviours = _names("behaviours", self.behaviours)
        features = _names("features", self.features)
        hidden = whole("hidden", self.hidden, 1, MOST_HIDDEN)
        weights = reals("weights", self.weights)
        wanted = (len(behaviours), weight_count(len(features), hidden))
        if weights.shape != wanted:
            raise SettingsError(
                f"weights of shape {weights.shape} do not fit {len(behaviours)} networks of"
                f" {len(features)} features and {hidden} hidden units: {wanted}"
            )
        weights.setflags(write=False)
        for name, value in (
            ("behaviours", behaviours),
            ("features", features),
            ("hidden", hidden),
            ("weights", weights),
            ("custom", boolean("custom", self.custom)),
        ):
            object.__setattr__(self, name, value)

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

        Raises SettingsError where the features are not those the networks know, and for networks of
        a custom estimator.

        >>> life.networks.likelihoods({"shape": 1.0, "size": 0.0})  # doctest: +SKIP
        {'eat': 0.97, 'shelter': 0.02, 'interact': 0.99}
        """
        self._check_built_in()
        for name in instance("features", features, Mapping):
            if name not in self.features:
                raise SettingsError(
                    f"{plain(name)} is no feature{nearest(str(name), self.features)}"
                )
        missing = [name for name in self.features if name not in features]
        if missing:
            raise SettingsError(f"features lack {', '.join(missing)}")
        inputs = np.array([real(f"features.{name}", features[name]) for name in self.features])
        outputs = np.zeros(len(self.behaviours))
        ask(inputs, self.weights, np.zeros(self.hidden), outputs)
        return dict(zip(self.behaviours, outputs.tolist(), strict=True))

    @classmethod
    def load(cls, path: str | Path) -> Networks:
        """Return the networks of a file that `save` wrote, to the last bit.

        Raises SettingsError, with a line for everything that is wrong with the file.
        """
        file = read_networks_file(arguments.path("path", path))
        return cls(tuple(file.weights), file.features, file.hidden, file.matrix())

    def save(self, path: str | Path) -> None:
        """Write the networks as a TOML file, replacing what was there. Raises SettingsError."""
        write_networks_file(
            arguments.file("path", path),
            self.behaviours,
            self.features,
            self.hidden,
            np.asarray(self.weights),
        )

    def figure(self, objects: Mapping[str, Mapping[str, float]] | None = None) -> Figure:
        """Draw what each network says, and its weights.

        Networks of two features are drawn as a surface over both, others as a bar for each object.
        `objects` are the features of object types by their names, such as
        `{kind.name: kind.features for kind in world.types}`. Raises SettingsError where these are
        not the features the networks know, and for networks of a custom estimator.
        """
        self._check_built_in()
        from animat.figures.networks import SURFACE, networks_figure

        named = instance("objects", {} if objects is None else objects, Mapping)
        _names("objects", [*named])
        said = [list(self.likelihoods(features).values()) for features in named.values()]
        places = np.array([[each[f] for f in self.features] for each in named.values()])
        return networks_figure(
            self.behaviours,
            self.features,
            self._layers(),
            self._surface(SURFACE) if len(self.features) == 2 else None,
            dict(zip(named, zip(places, said, strict=True), strict=True)),
        )

    def _check_built_in(self) -> None:
        if self.custom:
            raise SettingsError(
                "these networks were learnt for a custom estimator, and only that can tell what"
                " they say; lives and studies ask it: likelihood_* of traces and of tables of lives"
            )

    def _surface(self, along: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the likelihoods [B, N, N] at N values of the second and of the first feature."""
        said = np.zeros((len(self.behaviours), len(along), len(along)))
        outputs, hidden = np.zeros(len(self.behaviours)), np.zeros(self.hidden)
        for row, second in enumerate(along):
            for column, first in enumerate(along):
                ask(np.array([first, second]), self.weights, hidden, outputs)
                said[:, row, column] = outputs
        return said

    def _layers(self) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Return of each network the weights, biases first: hidden [H, 1 + F], output [1 + H]."""
        cut = self.hidden * (len(self.features) + 1)
        return [(each[:cut].reshape(self.hidden, -1), each[cut:]) for each in self.weights]


def _names(what: str, given: Any) -> tuple[str, ...]:
    names = sequence(what, given, str)
    problems = name_problems(what, names)
    problems += [f"{what} {plain(name)} is there twice" for name in names if names.count(name) > 1]
    if problems:
        raise SettingsError(*dict.fromkeys(problems))
    return names


@kernel
def ask(features, weights, hidden, outputs):
    """Fill in what each of B networks, `weights` [B, W], puts out for `features` [F]."""
    for b in range(len(outputs)):
        outputs[b] = feed_forward(features, weights[b], hidden)

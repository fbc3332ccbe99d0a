"""The paper's claims C1 to C7, and whether they hold: in one universe, or in each of many.

A verdict comes from a confidence interval and from nothing else: *holds* if the whole interval
says so, *fails* if the whole interval says the opposite, *undecided* if it says both.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Literal

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.statistics.estimates import RESAMPLES, Estimate, Estimates, rows_of_means
from animat.statistics.lives import column

Verdict = Literal["holds", "fails", "undecided"]

CELLS = (("abundant", "BLIND"), ("abundant", "AF"), ("scarce", "BLIND"), ("scarce", "AF"))
"""World and agent of the four cells of Experiment 2, in the order of everything here."""

CLAIMS = ("C1", "C2", "C3", "C4", "C5", "C6", "C7")

RATIOS = {
    "abundant_gain": "AF / BLIND, abundant world",
    "scarce_gain": "AF / BLIND, scarce world",
    "worlds_blind": "abundant / scarce, BLIND",
    "worlds_af": "abundant / scarce, AF",
}
"""The effects that are ratios of mean lifespans, in words."""

COMPARED = {"abundant_gain": (1, 0), "scarce_gain": (3, 2), "worlds_blind": (0, 2),
            "worlds_af": (1, 3), "gain_difference": (1, 0, 3, 2)}  # fmt: skip
"""The places in `CELLS` of the cells that an effect compares."""

EFFECTS = {
    **RATIOS,
    "gain_difference": "abundant gain - scarce gain",
    "learning_error": "largest distance of a mean likelihood from Table 1",
}
"""All effects: each is a column of a table of universes, with its `_low` and `_high`."""

ABUNDANT_GAIN = (1.75, 2.25)
"""C4: "nearly 100%" is a gain nearer to 100 % than to 50 % or 150 %, so 75 % to 125 %."""

SCARCE_GAIN = (1.25, 1.75)
"""C5: "nearly 50%" is a gain nearer to 50 % than to nothing or to 100 %, so 25 % to 75 %."""

FARTHEST = 0.2
"""C7: a network matches Table 1 with a likelihood of at least 0.8 where an act is afforded, and of
at most 0.2 where it is not: this far from the truth at most."""

INTERACT = "interact"

ORDER: tuple[Verdict, ...] = ("fails", "undecided", "holds")


def above(estimate: Estimate, bound: float) -> Verdict:
    """Does the quantity exceed `bound`? Undecided while the interval touches it."""
    if estimate.low > bound:
        return "holds"
    return "fails" if estimate.high < bound else "undecided"


def inside(estimate: Estimate, band: tuple[float, float]) -> Verdict:
    """Does the quantity lie in the closed `band`?"""
    if estimate.low >= band[0] and estimate.high <= band[1]:
        return "holds"
    return "fails" if estimate.high < band[0] or estimate.low > band[1] else "undecided"


def within(estimate: Estimate, bound: float) -> Verdict:
    """Is the quantity at most `bound`?"""
    if estimate.high <= bound:
        return "holds"
    return "fails" if estimate.low > bound else "undecided"


def worst(verdicts: Iterable[Verdict]) -> Verdict:
    """The verdict on a claim of several parts."""
    return min(verdicts, key=ORDER.index)


def verdicts(effects: Mapping[str, Estimate], distances: Iterable[Estimate]) -> dict[str, Verdict]:
    """The verdict on each claim in one universe.

    `effects` has those of lifespans; `distances` are those of each mean likelihood from Table 1.
    """
    rich, poor = effects["abundant_gain"], effects["scarce_gain"]
    return {
        "C1": above(rich, 1.0),
        "C2": above(poor, 1.0),
        "C3": worst(above(effects[name], 1.0) for name in ("worlds_blind", "worlds_af")),
        "C4": inside(rich, ABUNDANT_GAIN),
        "C5": inside(poor, SCARCE_GAIN),
        "C6": above(effects["gain_difference"], 0.0),
        "C7": worst(within(distance, FARTHEST) for distance in distances),
    }


def lifespan_effects(
    spans: NDArray[np.float64], alive: NDArray[np.bool_], *, seed: int = 0, resamples: int
) -> dict[str, Estimates]:
    """The effects that are made of mean lifespans, from lifespans [U, 4, n].

    Lives of one place share their random numbers in the four cells of a universe. Raises ValueError
    if those `alive` were cut at different steps, as means of such say nothing together.
    """
    if alive.any() and spans[alive].min() < spans.max():
        raise ValueError("the lives of all universes must have one cap")

    def of_ratios(a, b, c=None, d=None):
        return a / b if c is None else a / b - c / d

    return {
        name: rows_of_means(
            [spans[:, cell] for cell in cells], of_ratios, seed=seed, resamples=resamples
        )
        for name, cells in COMPARED.items()
    }


class Learnt:
    """Likelihoods of networks in universes, by `pairs` of network and object.

    `said` [U, pairs, robots] are the likelihoods, `away` how far each is from what the network
    should say. That is 1 from Table 1's `afforded` of 0.5 on, and always of `INTERACT`.
    """

    def __init__(self, likelihoods: pa.Table, universes: NDArray[np.int64]) -> None:
        """Read a table with `universe`, `robot`, `network`, `object`, `likelihood`, `afforded`.

        Raises ValueError unless all `universes` have the same robots, networks and objects.
        """
        names = ("robot", "object", "network", "universe")
        keys = [column(likelihoods, name) for name in names]
        order = np.lexsort([keys[0], _places(keys[1]), _places(keys[2]), keys[3]])
        robots, things, networks, count = (len(np.unique(key)) for key in keys)
        if not len(order):
            raise ValueError("the table of likelihoods is empty")
        if not np.array_equal(np.unique(keys[-1]), universes):
            raise ValueError("lives and likelihoods are of different universes")
        there = set(zip(*(key.tolist() for key in keys), strict=True))
        shape = (count, networks * things, robots)
        if len(order) != np.prod(shape) or len(there) != len(order):
            raise ValueError("every universe needs one likelihood a robot, network and object")
        first = order.reshape(shape)[0, :, 0]
        self.pairs = list(zip(keys[2][first].tolist(), keys[1][first].tolist(), strict=True))
        said = column(likelihoods, "likelihood").astype(np.float64)
        true = (column(likelihoods, "afforded") >= 0.5) | (keys[2] == INTERACT)
        self.said = said[order].reshape(shape)
        self.away = np.abs(said - true.astype(np.float64))[order].reshape(shape)


def _places(values: NDArray) -> NDArray[np.int64]:
    """Which of the distinct values each is, in the order in which they first appear."""
    _, first, code = np.unique(values, return_index=True, return_inverse=True)
    return np.argsort(np.argsort(first))[code]


def over_robots(values: NDArray[np.float64], seed: int, resamples: int = RESAMPLES) -> Estimates:
    """The means over robots of values [U, pairs, robots], arrays [U, pairs]."""
    rows = values.reshape(-1, values.shape[-1])
    each = rows_of_means([rows], lambda one: one, seed=seed, resamples=resamples)
    return Estimates(*(part.reshape(values.shape[:2]) for part in each))

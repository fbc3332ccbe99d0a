"""The interaction of two factors: does the effect of one depend on the level of the other?

It is told on two scales, as one may be there without the other: differences of mean lifespans that
differ, and ratios that differ. Both compare lives within the combinations of all other factors, so
that nothing else differs.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.estimates import LEVEL, RESAMPLES, Estimate
from animat.statistics.factors import Factor
from animat.statistics.lives import column
from animat.statistics.resampling import codes_of, ratio_over, sets_of
from animat.statistics.sample import Sample, other_combinations
from animat.statistics.significance import Significance, hotelling


class Axis(NamedTuple):
    """The levels of a factor; `places` are their numbers, NaN where not set, None for words."""

    name: str
    levels: tuple[str, ...]
    places: tuple[float, ...] | None


class Contrast(NamedTuple):
    """How the effect of two levels of one factor differs between two levels of the other.

    `first` and `second` are a level and the reference of each factor. `difference` is in steps:
    the difference of the means of `first` at the level of `second`, less that at its reference;
    `ratio` is the one ratio over the other. Each has the p value of its own test.
    """

    first: tuple[str, str]
    second: tuple[str, str]
    difference: Estimate
    difference_p: float
    ratio: Estimate
    ratio_p: float


class Interaction(NamedTuple):
    """What two factors do together.

    `means` are the restricted mean lifespans by the place of both levels. `differences` and
    `ratios` test all contrasts at once, on either scale. `blocks` is how many combinations of the
    other factors have all of these cells, `incomplete` how many have not and are left out.
    """

    first: Axis
    second: Axis
    means: Mapping[tuple[int, int], Estimate]
    contrasts: tuple[Contrast, ...]
    differences: Significance
    ratios: Significance
    blocks: int
    incomplete: int
    resampled: str

    @property
    def name(self) -> str:
        """Both factors."""
        return f"{self.first.name} by {self.second.name}"


def interactions(
    lives: Sample, names: Sequence[str], *, seed: int = 0, resamples: int = RESAMPLES
) -> tuple[Interaction, ...]:
    """The interaction of every two of the factors `names` that are crossed with each other.

    They are crossed if some combination of all other factors has two levels of the one with two
    levels of the other. A sample of points, where no two agree in all else, has none.
    """
    if len(names) < 2:
        return ()
    point = np.unique(codes_of(*(each.exact for each in lives.factors)), return_index=True)[1]
    found = (
        _interaction(lives, one, other, point, seed, resamples)
        for one, other in combinations([lives.factor(name) for name in names], 2)
    )
    return tuple(each for each in found if each is not None)


def _interaction(
    lives: Sample,
    first: Factor,
    second: Factor,
    point: NDArray[np.int64],
    seed: int,
    resamples: int,
) -> Interaction | None:
    """The interaction of two factors, if they are crossed; `point` is a life of each case."""
    width = int(second.exact.max()) + 1
    shape = int(first.exact.max()) + 1, width
    cell = first.exact * width + second.exact
    cells = len(np.unique(cell[point]))
    others = lives.others(first.name, second.name)
    if 2 * cells < shape[0] * width or any(
        np.bincount(each.exact[point]).max() < cells for each in others
    ):
        return None
    block = other_combinations(lives, first.name, second.name)
    used, block = np.unique(block, return_inverse=True)
    held = np.unique(codes_of(block, cell), return_index=True)[1]
    complete = np.bincount(block[held]) == cells
    present = np.zeros(shape, dtype=bool)
    present.flat[np.unique(cell)] = True
    pairs = _crossed(present)
    if not complete.any() or not pairs:
        return None
    rows = complete[block]
    sets = sets_of(lives.number[rows], lives.case[rows], block[rows])
    steps, cell, block = lives.steps[rows], cell[rows], block[rows]
    # Every block counts alike in each cell, also where a study that still runs has fewer lives.
    place = codes_of(cell, block)
    weight = 1.0 / (np.bincount(place)[place] * complete.sum())
    means = np.bincount(cell, weight * steps, shape[0] * width)
    unit = means.max()
    units, code = np.unique(sets.codes, return_inverse=True)
    pulls = np.bincount(
        code * means.size + cell, weight * (steps - means[cell]) / unit, len(units) * means.size
    ).reshape(len(units), means.size)
    axes = _axis(lives, first), _axis(lives, second)
    contrasts = np.zeros((len(pairs), means.size))
    for row, (a, a0, b, b0) in zip(contrasts, pairs, strict=True):
        row[[a * width + b, a0 * width + b0]] = 1.0
        row[[a * width + b0, a0 * width + b]] = -1.0
    means = np.where(present.ravel(), means / unit, 1.0)
    scales = [
        (contrasts @ means, pulls @ contrasts.T),
        (contrasts @ np.log(means), (pulls / means) @ contrasts.T),
    ]
    told: list[Contrast] = []
    for number, (a, a0, b, b0) in enumerate(pairs):
        (difference, difference_p), (log_ratio, ratio_p) = (
            _estimate(values[number], pull[:, number]) for values, pull in scales
        )
        told.append(
            Contrast(
                (axes[0].levels[a], axes[0].levels[a0]),
                (axes[1].levels[b], axes[1].levels[b0]),
                Estimate(*(unit * each for each in difference)),
                difference_p,
                Estimate(*(float(np.exp(each)) for each in log_ratio)),
                ratio_p,
            )
        )
    differences, ratios = (hotelling(*scale) for scale in scales)
    return Interaction(
        axes[0],
        axes[1],
        {
            (int(code // width), int(code % width)): ratio_over(
                (weight * steps)[cell == code],
                weight[cell == code],
                sets.take(cell == code),
                seed=seed,
                resamples=resamples,
            )
            for code in np.unique(cell)
        },
        tuple(told),
        differences,
        ratios,
        int(complete.sum()),
        len(used) - int(complete.sum()),
        sets.what,
    )


def _crossed(present: NDArray[np.bool_]) -> list[tuple[int, int, int, int]]:
    """Level and reference of both factors wherever all four cells are `present` [i, j].

    The reference is the first level of each that has most of its cells.
    """
    a0 = int(present.sum(axis=1).argmax())
    b0 = int((present.sum(axis=0) * present[a0]).argmax())
    return [
        (a, a0, b, b0)
        for a, b in np.argwhere(present & present[:, [b0]] & present[[a0]]).tolist()
        if a != a0 and b != b0
    ]


def _axis(lives: Sample, factor: Factor) -> Axis:
    first = np.unique(factor.exact, return_index=True)[1]
    levels = tuple(factor.label(int(row)) for row in first)
    if not factor.ordered:
        return Axis(factor.name, levels, None)
    places = column(lives.table, factor.name)[first].astype(np.float64)
    return Axis(factor.name, levels, tuple(places.tolist()))


def _estimate(value: float, pulls: NDArray[np.float64]) -> tuple[Estimate, float]:
    """A value with Student's interval and p, from how much each of s units `pulls` [s] it."""
    count = len(pulls)
    if count < 2:
        return Estimate(float(value), float("nan"), float("nan")), float("nan")
    error = np.sqrt(count / (count - 1) * (pulls**2).sum())
    half = float(stats.t.ppf((1 + LEVEL) / 2, count - 1) * error)
    test = hotelling(np.array([value]), pulls[:, None])
    return Estimate(float(value), float(value) - half, float(value) + half), test.p

"""Universes judged: from the lives and the likelihoods of each, its effects and seven verdicts.

Estimates, intervals and verdicts are those of `claims.judge_lifespans` and `judge_learning`, made
for many universes at once. Lives share their luck within a universe, so that cells are paired.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.statistics.claims import (
    Verdict,
    distance_from_table_1,
    learning_verdict,
    lifespan_verdicts,
)
from animat.statistics.estimates import RESAMPLES, Estimate
from animat.statistics.lives import column
from animat.statistics.universe_intervals import Estimates, bootstrapped_rows

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

EFFECTS = {
    **RATIOS,
    "gain_difference": "abundant gain - scarce gain",
    "learning_error": "largest distance of a mean likelihood from Table 1",
}
"""All effects: each is a column of a table of universes, with its `_low` and `_high`."""


def judge_universes(
    lives: pa.Table, likelihoods: pa.Table, *, seed: int = 0, resamples: int = RESAMPLES
) -> pa.Table:
    """A row for every universe: its effects with intervals, verdicts, and what its cells were like.

    `lives` has the columns `universe`, `world` and `agent` (as in `CELLS`) and those of a table of
    lives; every universe has the four cells with the same lives. `likelihoods` has `universe`,
    `robot`, `network`, `object`, `likelihood`, `afforded`: of every universe the same robots,
    networks and objects. Columns, beside `universe`: the names of `EFFECTS` and `CLAIMS`, and for
    each cell `mean_`, `alive_` (share at the cap) and `success_` (share of acts; null if nobody
    acted), followed by world and agent. Raises ValueError for a universe that lacks something.
    """
    numbers, order = _in_order(lives)
    shape = (len(numbers), len(CELLS), -1)
    spans = column(lives, "lifespan").astype(np.float64)[order].reshape(shape)
    alive = column(lives, "censored").astype(bool)[order].reshape(shape)
    _check_cap(spans, alive)
    effects = _lifespan_effects(spans, seed, resamples)
    distances = _distances(likelihoods, numbers, seed, resamples)
    worst = distances.value.argmax(axis=1)[:, None]
    effects["learning_error"] = Estimates(
        *(np.take_along_axis(part, worst, axis=1)[:, 0] for part in distances)
    )
    columns: dict[str, object] = {"universe": numbers}
    for name, estimates in effects.items():
        for part, values in zip(("", "_low", "_high"), estimates, strict=True):
            columns[name + part] = values
    columns |= _verdicts(effects)
    columns["C7"] = [
        learning_verdict(Estimate(*pair) for pair in zip(*parts, strict=True))
        for parts in zip(*distances, strict=True)
    ]
    acts, successes = (column(lives, name)[order].reshape(shape) for name in ("acts", "successes"))
    with np.errstate(invalid="ignore"):
        rates = successes.sum(axis=2) / acts.sum(axis=2)
    for number, (world, agent) in enumerate(CELLS):
        columns[f"mean_{world}_{agent}"] = spans[:, number].mean(axis=1)
        columns[f"alive_{world}_{agent}"] = alive[:, number].mean(axis=1)
        rate = rates[:, number]
        columns[f"success_{world}_{agent}"] = pa.array(rate, mask=np.isnan(rate))
    return pa.table(columns)


def holds(universes: pa.Table, claim: str) -> NDArray[np.bool_]:
    """In which universes [U] the claim holds; undecided is not enough."""
    return np.array([verdict == "holds" for verdict in universes.column(claim).to_pylist()])


def verdicts_by_value(universes: pa.Table) -> dict[str, list[Verdict]]:
    """The verdict on each claim in each universe if its estimates were exact.

    Undecided is then only what lies on a border, such as a ratio of just 1.
    """
    effects = {name: Estimates(*[column(universes, name)] * 3) for name in EFFECTS}
    error = effects["learning_error"]
    return {
        **_verdicts(effects),
        "C7": [learning_verdict([error.at(u)]) for u in range(len(error.value))],
    }


def deaths(lives: pa.Table) -> pa.Table:
    """How the lives of each universe and cell ended: how many (`lives`) of which cause.

    The columns of `lives` are those of `judge_universes`. A life alive at the cap has no variable,
    side and cause.
    """
    by = ["universe", "world", "agent", "death_variable", "death_side", "death_cause"]
    counted = pa.table({name: _plain(lives, name) for name in [*by, "life"]}).group_by(by)
    ways = counted.aggregate([("life", "count")]).rename_columns([*by, "lives"])
    return ways.sort_by([(name, "ascending") for name in by])


def complete(lives: pa.Table, likelihoods: pa.Table, lives_a_cell: int) -> NDArray[np.int64]:
    """The universes of which nothing is missing: four cells of so many lives, and likelihoods."""
    universe, rows = np.unique(column(lives, "universe"), return_counts=True)
    there = np.unique(column(likelihoods, "universe"))
    return np.intersect1d(universe[rows == len(CELLS) * lives_a_cell], there)


def _in_order(lives: pa.Table) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The universes, and the order of rows that makes them [universe, cell, life]."""
    universe, life = (column(lives, name).astype(np.int64) for name in ("universe", "life"))
    world, agent = column(lives, "world"), column(lives, "agent")
    cell = np.full(len(universe), -1)
    for number, (in_world, of_agent) in enumerate(CELLS):
        cell[(world == in_world) & (agent == of_agent)] = number
    if not len(universe) or np.any(cell < 0):
        raise ValueError("universes are judged by the four cells of Experiment 2, and only those")
    order = np.lexsort((life, cell, universe))
    numbers, rows = np.unique(universe, return_counts=True)
    each = rows[0] // len(CELLS)
    shape = (len(numbers), len(CELLS), each)
    if (
        np.any(rows != len(CELLS) * each)
        or np.any(cell[order].reshape(shape) != np.arange(len(CELLS))[:, None])
        or np.any(np.ptp(life[order].reshape(shape), axis=1))
    ):
        raise ValueError("every universe needs the same lives in its four cells")
    return numbers, order


def _check_cap(spans: NDArray[np.float64], alive: NDArray[np.bool_]) -> None:
    """Means of lives cut at different steps say nothing together."""
    if alive.any() and spans[alive].min() < spans.max():
        raise ValueError("the lives of all universes must have one cap")


def _lifespan_effects(
    spans: NDArray[np.float64], seed: int, resamples: int
) -> dict[str, Estimates]:
    """From lifespans [U, 4, n] the effects that are made of mean lifespans."""
    rich_blind, rich_af, poor_blind, poor_af = (spans[:, cell] for cell in range(len(CELLS)))
    pairs = [(rich_af, rich_blind), (poor_af, poor_blind)]
    pairs += [(rich_blind, poor_blind), (rich_af, poor_af)]
    effects = {
        name: bootstrapped_rows(pair, _ratio, seed=seed, resamples=resamples)
        for name, pair in zip(RATIOS, pairs, strict=True)
    }
    effects["gain_difference"] = bootstrapped_rows(
        [rich_af, rich_blind, poor_af, poor_blind], _difference, seed=seed, resamples=resamples
    )
    return effects


def _ratio(numerator, denominator):
    return numerator / denominator


def _difference(a, b, c, d):
    return a / b - c / d


def _itself(mean):
    return mean


def _distances(
    likelihoods: pa.Table, numbers: NDArray[np.int64], seed: int, resamples: int
) -> Estimates:
    """The mean distance from Table 1 of every network and object, arrays [U, pairs]."""
    keys = [column(likelihoods, name) for name in ("robot", "object", "network", "universe")]
    order = np.lexsort([np.unique(key, return_inverse=True)[1] for key in keys])
    robots, things, networks, universes = (len(np.unique(key)) for key in keys)
    shape = (universes, networks * things, robots)
    there = set(zip(*(key.tolist() for key in keys), strict=True))
    if not np.array_equal(np.unique(keys[-1]), numbers):
        raise ValueError("lives and likelihoods are of different universes")
    if len(order) != np.prod(shape) or len(there) != len(order):
        raise ValueError("every universe needs one likelihood a robot, network and object")
    away = distance_from_table_1(likelihoods)[order].reshape(-1, robots)
    estimates = bootstrapped_rows([away], _itself, seed=seed, resamples=resamples)
    return Estimates(*(part.reshape(shape[:2]) for part in estimates))


def _verdicts(effects: Mapping[str, Estimates]) -> dict[str, list[Verdict]]:
    """The verdicts on C1 to C6 in every universe."""
    judged: dict[str, list[Verdict]] = {name: [] for name in CLAIMS[:-1]}
    for u in range(len(effects["abundant_gain"].value)):
        verdicts = lifespan_verdicts(
            effects["abundant_gain"].at(u),
            effects["scarce_gain"].at(u),
            [effects["worlds_blind"].at(u), effects["worlds_af"].at(u)],
            effects["gain_difference"].at(u),
        )
        for name, verdict in verdicts.items():
            judged[name].append(verdict)
    return judged


def _plain(table: pa.Table, name: str) -> pa.ChunkedArray:
    """A column without its dictionary, whose batches may differ."""
    values = table.column(name)
    return values.cast(values.type.value_type) if pa.types.is_dictionary(values.type) else values

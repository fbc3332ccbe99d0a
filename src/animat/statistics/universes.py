"""Universes judged: from the lives and the likelihoods of each, its effects and seven verdicts."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.statistics.claims import (
    CELLS,
    CLAIMS,
    EFFECTS,
    Learnt,
    Verdict,
    lifespan_effects,
    over_robots,
    verdicts,
)
from animat.statistics.estimates import RESAMPLES, Estimate, Estimates, share
from animat.statistics.lives import column


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
    numbers, order = in_order(lives)

    def of_cells(name: str) -> NDArray:
        return column(lives, name)[order].reshape(len(numbers), len(CELLS), -1)

    spans, alive = of_cells("lifespan").astype(np.float64), of_cells("censored").astype(bool)
    effects = lifespan_effects(spans, alive, seed=seed, resamples=resamples)
    distances = over_robots(Learnt(likelihoods, numbers).away, seed, resamples)
    worst = distances.value.argmax(axis=1)[:, None]
    errors = (np.take_along_axis(part, worst, axis=1)[:, 0] for part in distances)
    columns: dict[str, object] = {"universe": numbers}
    for name, estimates in {**effects, "learning_error": Estimates(*errors)}.items():
        for part, values in zip(("", "_low", "_high"), estimates, strict=True):
            columns[name + part] = values
    judged = [
        verdicts(
            {name: each.at(u) for name, each in effects.items()},
            map(Estimate, *(part[u] for part in distances)),
        )
        for u in range(len(numbers))
    ]
    columns |= {claim: [one[claim] for one in judged] for claim in CLAIMS}
    with np.errstate(invalid="ignore"):
        rates = of_cells("successes").sum(axis=2) / of_cells("acts").sum(axis=2)
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
    values = zip(*(column(universes, name).tolist() for name in EFFECTS), strict=True)
    exact = [dict(zip(EFFECTS, (Estimate(v, v, v) for v in row), strict=True)) for row in values]
    judged = [verdicts(one, [one["learning_error"]]) for one in exact]
    return {claim: [one[claim] for one in judged] for claim in CLAIMS}


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


def in_order(lives: pa.Table) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The universes, and the order of rows that makes them [universe, cell, life].

    Raises ValueError unless every universe has the same lives in its four cells, and no others.
    """
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


def _plain(table: pa.Table, name: str) -> pa.ChunkedArray:
    """A column without its dictionary, whose batches may differ."""
    values = table.column(name)
    return values.cast(values.type.value_type) if pa.types.is_dictionary(values.type) else values


VERDICTS = ("holds", "undecided", "fails")


def verdict_shares(universes: pa.Table) -> pa.Table:
    """For each claim and verdict the share of universes with Wilson's interval.

    Columns: `claim`, `verdict`, `universes`, `share`, `low`, `high`, and `share_by_value`: the
    share if every universe were judged by its estimates alone, as if they had no error. Many
    lives would turn the shares into these, if the estimates are not biased.
    """
    by_value = verdicts_by_value(universes)
    rows = []
    for claim in CLAIMS:
        judged = column(universes, claim)
        for verdict in VERDICTS:
            count = int(np.sum(judged == verdict))
            value, low, high = share(count, len(judged))
            rows.append(
                {
                    "claim": claim,
                    "verdict": verdict,
                    "universes": count,
                    "share": value,
                    "low": low,
                    "high": high,
                    "share_by_value": by_value[claim].count(verdict) / len(judged),
                }
            )
    return pa.Table.from_pylist(rows)

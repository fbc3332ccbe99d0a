"""The universes of a results directory, judged: a few hundred are read at a time."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from animat.experiments.universes import Reading, Universes, universes_of
from animat.statistics.claims import CELLS
from animat.statistics.estimates import RESAMPLES
from animat.statistics.universes import complete, deaths, judge_universes
from animat.study.plan.plan import Class, Plan, world_of
from animat.study.store.results import Results

AT_A_TIME = 256
"""Universes whose lives are in memory at a time."""

COLUMNS = (
    "case", "life", "lifespan", "censored", "death_variable", "death_side", "death_cause", "acts",
    "successes",
)  # fmt: skip


class Judged(NamedTuple):
    """The universes of a study, judged.

    `table` has a row for each that is complete: its readings and what `judge_universes` tells.
    `deaths` is how their lives ended. `missing` universes have lives or robots that failed.
    """

    universes: Universes
    table: pa.Table
    deaths: pa.Table
    missing: int


def judge(
    plan: Plan,
    results: Results,
    readings: tuple[Reading, ...] | None = None,
    *,
    resamples: int = RESAMPLES,
    tell: Callable[[int], None] = lambda universes: None,
) -> Judged:
    """Judge the universes of a study that was simulated, by `readings` as in `universes_of`.

    `tell` is called with how many more are.
    """
    universes = universes_of(plan.study, results.cases, readings)
    likelihoods = _Likelihoods(plan, results)
    tables, ways = [], []
    for first in range(0, len(universes.values), AT_A_TIME):
        cases = universes.cases[first : first + AT_A_TIME]
        numbers = first + np.arange(len(cases))
        lives = _lives(results, cases, numbers, plan.study.lives)
        said = likelihoods.of(cases, numbers)
        whole = complete(lives, said, plan.study.lives)
        if len(whole):
            lives, said = (table.filter(_among(table, whole)) for table in (lives, said))
            tables.append(judge_universes(lives, said, resamples=resamples))
            ways.append(deaths(lives))
        tell(len(cases))
    if not tables:
        return Judged(universes, pa.table({"universe": pa.array([], pa.int64())}), pa.table({}),
                      len(universes.values))  # fmt: skip
    judged = pa.concat_tables(tables)
    rows = judged.column("universe").combine_chunks()
    named = {name: column.take(rows) for name, column in universes.columns().items()}
    order = ["universe", *named, *judged.column_names[1:]]
    columns = {"universe": rows, **named, **{n: judged[n] for n in judged.column_names[1:]}}
    table = pa.table({name: columns[name] for name in order})
    missing = len(universes.values) - table.num_rows
    return Judged(universes, table, pa.concat_tables(ways), missing)


def _lives(
    results: Results, cases: NDArray[np.int64], numbers: NDArray[np.int64], lives: int
) -> pa.Table:
    """The finished lives of universes `numbers` [u] whose cells are `cases` [u, 4]."""
    same = np.asarray(results.cases["same_as"])
    lived_for = same[cases].ravel()
    wanted = pc.field("case").isin(pa.array(np.unique(lived_for)))
    dataset = results.dataset()
    if "error" in dataset.schema.names:
        wanted = wanted & pc.field("error").is_null()
    table = dataset.to_table(columns=list(COLUMNS), filter=wanted).unify_dictionaries()
    table = table.sort_by([("case", "ascending"), ("life", "ascending")])
    there = np.asarray(table["case"])
    begin, end = (np.searchsorted(there, lived_for, side=side) for side in ("left", "right"))
    rows = np.concatenate([np.arange(*ends) for ends in zip(begin, end, strict=True)])
    count = end - begin
    worlds, agents = (np.tile(names, len(cases)) for names in zip(*CELLS, strict=True))
    named = {
        "universe": pa.array(np.repeat(np.repeat(numbers, len(CELLS)), count)),
        "world": pa.array(np.repeat(worlds, count)),
        "agent": pa.array(np.repeat(agents, count)),
    }
    taken = table.drop_columns(["case"]).take(pa.array(rows, pa.int64()))
    return pa.table({**named, **{name: taken[name] for name in taken.column_names}})


class _Likelihoods:
    """What the training robots of every universe say of every object, for `judge_universes`."""

    def __init__(self, plan: Plan, results: Results) -> None:
        self._plan = plan
        dataset = results.dataset("teachers")
        columns = [name for name in dataset.schema.names if name != "weights"]
        table = dataset.to_table(columns=columns, filter=pc.field("error").is_null())
        self._rows = table.sort_by([("identity", "ascending"), ("robot", "ascending")])
        names = np.asarray(self._rows["identity"]).astype(str)
        identity, first, count = np.unique(names, return_index=True, return_counts=True)
        self._begin = dict(zip(identity.tolist(), zip(first, count, strict=True), strict=True))
        same = np.asarray(results.cases["same_as"])
        places = {case.number: place for place, case in enumerate(plan.lived)}
        self._place = np.array([places[case] for case in same])
        self._robots = plan.study.teacher.robots if plan.study.teacher else 0
        self._truths: dict[str, dict[tuple[str, str], float]] = {}

    def of(self, cases: NDArray[np.int64], numbers: NDArray[np.int64]) -> pa.Table:
        """The likelihoods of universes `numbers` [u] whose cells are `cases` [u, 4].

        Universes of which a robot failed are left out.
        """
        informed = cases[:, CELLS.index(("abundant", "AF"))]
        tables = [pa.table({"universe": pa.array([], pa.int64())})]
        for truth, chosen in self._alike(informed):
            first, universe = [], []
            for row in chosen:
                begin, robots = self._begin.get(self._class_of(int(informed[row])).identity, (0, 0))
                if robots >= self._robots:
                    first.append(begin)
                    universe.append(numbers[row])
            each = np.array(first, dtype=np.int64)[:, None] + np.arange(self._robots)
            rows = pa.array(each.ravel())
            taught = self._rows.take(rows)
            universes = pa.array(np.repeat(universe, self._robots), pa.int64())
            for (network, thing), afforded in truth.items():
                columns = {
                    "universe": universes,
                    "robot": taught["robot"],
                    "network": pa.array([network] * len(universes), pa.string()),
                    "object": pa.array([thing] * len(universes), pa.string()),
                    "likelihood": taught[f"likelihood_{network}_{thing}"],
                    "afforded": pa.array(np.full(len(universes), afforded)),
                }
                tables.append(pa.table(columns))
        return pa.concat_tables(tables, promote_options="default")

    def _class_of(self, case: int) -> Class:
        place = self._plan.class_of(int(self._place[case]))
        assert place is not None
        return self._plan.classes[place]

    def _alike(self, cases: NDArray[np.int64]) -> list[tuple[dict[tuple[str, str], float], list]]:
        """The rows of `cases` whose training robots met the same types, and what these afford."""
        alike: dict[str, list[int]] = {}
        for row, case in enumerate(cases.tolist()):
            training = self._class_of(case).teacher.world
            alike.setdefault(training.layout, []).append(row)
            if training.layout not in self._truths:
                self._truths[training.layout] = _truth(self._class_of(case))
        return [(self._truths[layout], rows) for layout, rows in alike.items()]


def _truth(taught: Class) -> dict[tuple[str, str], float]:
    """Table 1's probability for each network and object that a class of teachers learns."""
    return {
        (name, kind.name): kind.affords[behaviour.needs]
        for kind in world_of(taught.teacher.world).types
        for name, behaviour in taught.mind.behaviours.items()
    }


def _among(table: pa.Table, universes: NDArray[np.int64]) -> pa.Array:
    return pa.array(np.isin(np.asarray(table["universe"]), universes))

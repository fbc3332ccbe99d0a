"""The columns of the tables of a study, and rows put into them.

All parts of a kind have the same columns, whatever cases are in them, so that they can be read as
one table. What a life has not, it has as null; one that failed has nothing but its name and its
error.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.life.likelihoods import likelihoods
from animat.life.scenario import Setting
from animat.life.summary import NAMES as LIFE_NAMES
from animat.life.summary import summary, without_failed
from animat.mind.mind import Mind
from animat.names import LIKELIHOOD, spelled
from animat.study.plan.identity import networks_matter
from animat.study.plan.numbering import Kind
from animat.study.plan.plan import Plan, world_of
from animat.world.world import World

NAMES = (*LIFE_NAMES, "case", "identity", "robot")
"""The columns that tell which life a row is of; a life that failed has them too."""


@lru_cache(maxsize=4)
def schema(plan: Plan, kind: Kind) -> pa.Schema:
    """Return the columns of a kind of parts; docs/tables.md describes them."""
    known: dict[object, pa.Schema] = {}
    for place, (mind, world) in enumerate(_minds_and_worlds(plan, kind)):
        types = [one.name for one in world.types]
        key = (tuple(mind.behaviours), tuple(types), mind.agent, mind.selector)
        if key not in known:
            known[key] = _schema_of(plan, kind, place)
    first = {"lives": ("case", pa.int64()), "teachers": ("identity", pa.string())}[kind]
    columns = pa.unify_schemas([pa.schema([first]), *known.values()])
    return columns.append(pa.field("error", pa.string()))


def life_columns(
    plan: Plan, setting: Setting, seed: int, lives: NDArray, states: NDArray[np.void]
) -> dict[str, pa.Array]:
    """Return what is told of L lives that ended in `states` [L]."""
    columns = summary(setting, seed, lives, states)
    if "likelihoods" in plan.study.measures and networks_matter(setting.mind_parameters):
        columns |= _likelihood_columns(setting, states)
        if setting.mind.nature.learns:
            columns["weights"] = _weights(states)
    return columns


def teacher_columns(
    setting: Setting, robots: NDArray, states: NDArray[np.void]
) -> dict[str, pa.Array]:
    """Return what is told of L robots that learnt until `states` [L]."""
    own = {"robot": pa.array(robots.astype(np.int64)), "weights": _weights(states)}
    return own | _likelihood_columns(setting, states)


def rows(
    columns: Mapping[str, pa.Array], errors: Sequence[str | None], wanted: pa.Schema
) -> pa.Table:
    """Return L lives as rows of the `wanted` columns; `errors` [L] are those of lives that failed.

    A column that is missing is null.
    """
    told = without_failed(columns, errors, NAMES)
    filled = [
        told[each.name] if each.name in told else pa.nulls(len(errors), each.type)
        for each in wanted
    ]
    return pa.table(filled, schema=wanted)


def joined(tables: Iterable[pa.Table]) -> pa.Table:
    """Return tables of the same columns as one, without seams."""
    return pa.concat_tables(tables).unify_dictionaries().combine_chunks()


def long_table(
    setting: Setting, said: NDArray[np.float64], axes: Mapping[str, NDArray]
) -> pa.Table:
    """Return likelihoods [..., B, T] as a table with a row for each, named by the `axes` before."""
    columns: dict[str, pa.Array] = {}
    names = {
        "network": list(setting.mind.behaviours),
        "object": [kind.name for kind in setting.world.types],
    }
    for axis, (name, values) in enumerate({**axes, **names}.items()):
        shape = [1] * said.ndim
        shape[axis] = -1
        codes = np.broadcast_to(np.arange(len(values)).reshape(shape), said.shape).ravel()
        if name in names:
            columns[name] = pa.DictionaryArray.from_arrays(
                pa.array(codes, pa.int32()), pa.array(values)
            )
        else:
            columns[name] = pa.array(np.asarray(values)[codes])
    columns["likelihood"] = pa.array(said.ravel())
    return pa.table(columns)


def _minds_and_worlds(plan: Plan, kind: Kind) -> Iterator[tuple[Mind, World]]:
    if kind == "lives":
        for case in plan.lived:
            yield case.settings.mind, world_of(case.settings.world)
    else:
        for each in plan.classes:
            yield each.mind, world_of(each.teacher.world)


def _schema_of(plan: Plan, kind: Kind, place: int) -> pa.Schema:
    """Return what is told of the lives of a case, or of the robots of a class."""
    none = np.zeros(0, np.uint64)
    setting = plan.setting(place) if kind == "lives" else plan.setting_of_class(place)
    states, _ = setting.begin(0, none)
    if kind == "lives":
        return pa.table(life_columns(plan, setting, 0, none, states)).schema
    return pa.table(teacher_columns(setting, none, states)).schema


def _likelihood_columns(setting: Setting, states: NDArray[np.void]) -> dict[str, pa.Array]:
    said = likelihoods(setting, states)
    types = [kind.name for kind in setting.world.types]
    flat = said.reshape(len(said), math.prod(said.shape[1:]))
    names = spelled((LIKELIHOOD,), behaviour=setting.mind.behaviours, object=types)
    columns = (pa.array(one, from_pandas=True) for one in flat.T)
    return dict(zip(names, columns, strict=True))


def _weights(states: NDArray[np.void]) -> pa.Array:
    weights = states["weights"]
    lengths = np.full(len(states), math.prod(weights.shape[1:]))
    ends = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int32)
    return pa.ListArray.from_arrays(pa.array(ends), pa.array(weights.ravel()))

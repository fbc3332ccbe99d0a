"""A part lived: from the text of a study and the number of a part to the content of its files.

Nothing else goes in but the networks that the robots learnt which teach in it, themselves a
function of the study; nothing else comes out. So a part can be lived on any thread, in any process
and on any machine, and is the same, byte for byte.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from threading import Event
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.life.batch import EPISODES, Batch, BatchResult
from animat.life.life import TraceChoice
from animat.study.execute.traces import Traced
from animat.study.plan.columns import (
    joined,
    life_columns,
    long_table,
    rows,
    schema,
    teacher_columns,
)
from animat.study.plan.numbering import Kind, Part, Piece
from animat.study.plan.plan import Plan, plan_of
from animat.study.plan.shard import Made, file_names, part_identity, recorded, shard_file

Networks = Mapping[int, NDArray[np.float64]]
"""By class of teachers, the weights [robots, B, W] of each robot; NaN of one that failed."""


class Lived(NamedTuple):
    """Lives of a piece of a part: what they are, how they ended."""

    piece: Piece
    batch: Batch
    lives: NDArray[np.uint64]
    weights: NDArray[np.float64] | None
    result: BatchResult


def live_part(
    text: str,
    part: Part,
    networks: Networks,
    stop: Event | None = None,
    check_functions: bool = False,
) -> Made:
    """Live a part of the study whose file reads `text`.

    `networks` has those of every class in `classes_needed`. Raises StoppedError once `stop` is
    set.
    """
    plan = plan_of(text, check_functions)
    lived = live_pieces(plan, part.kind, plan.pieces(part), networks, stop)
    identity = part_identity(plan, part)
    failed = sum(one.result.failed for one in lived)
    steps = sum(int(one.result.states["step"].sum()) for one in lived)
    files = {}
    for path in file_names(plan, part):
        if path.startswith("curves/"):
            curves = _curves(plan, part.kind, lived)
            files[path] = shard_file([curves], curves.schema, identity)
        elif path.startswith("traces/"):
            files[path] = shard_file(*_traces(plan, lived), identity)
        else:
            table = table_of(plan, part.kind, lived)
            files[path] = shard_file([table], table.schema, identity, steps, failed)
    return Made(files, plan.numbering[part.kind].rows(part.number), steps, failed)


def live_pieces(
    plan: Plan,
    kind: Kind,
    pieces: Iterable[Piece],
    networks: Networks,
    stop: Event | None = None,
) -> list[Lived]:
    """Live the lives of some pieces. Raises StoppedError once `stop` is set."""
    if kind == "teachers":
        return [_teach(plan, piece, stop) for piece in pieces]
    return [_live(plan, piece, networks, stop) for piece in pieces]


def table_of(plan: Plan, kind: Kind, lived: Iterable[Lived]) -> pa.Table:
    """Return what is told of lives, a row each."""
    told = _teacher_rows if kind == "teachers" else _life_rows
    return joined(told(plan, one) for one in lived)


def _teach(plan: Plan, piece: Piece, stop: Event | None) -> Lived:
    each = plan.classes[piece.place]
    curve = "learning_curve" in plan.study.measures
    setting = plan.setting_of_class(piece.place)
    batch = Batch(setting, plan.study.seed, each.teacher.steps, curve, stop=stop)
    robots = np.arange(piece.start, piece.stop, dtype=np.uint64)
    return Lived(piece, batch, robots, None, batch.run(robots))


def _live(plan: Plan, piece: Piece, networks: Networks, stop: Event | None) -> Lived:
    case = plan.lived[piece.place]
    setting = plan.setting(piece.place)
    curve = "learning_curve" in plan.study.measures and setting.mind.nature.learns
    choice = _choice(plan)
    back = (choice.last or 0) if choice and recorded(plan, piece) else 0
    batch = Batch(setting, case.seed, case.steps, curve, back, stop)
    lives = np.arange(case.first + piece.start, case.first + piece.stop, dtype=np.uint64)
    place = plan.class_of(piece.place)
    if place is None or case.teacher is None:
        return Lived(piece, batch, lives, None, batch.run(lives))
    robots = lives % np.uint64(case.teacher.robots)
    weights = networks[place][robots]
    return Lived(piece, batch, lives, weights, _live_taught(batch, lives, weights, robots))


def _live_taught(
    batch: Batch,
    lives: NDArray[np.uint64],
    weights: NDArray[np.float64],
    robots: NDArray[np.uint64],
) -> BatchResult:
    """Live lives that have the networks of robots; those of a robot that failed fail too."""
    taught = np.asarray(np.isfinite(weights).all(axis=(1, 2)))
    if taught.all():
        return batch.run(lives, weights)
    result = batch.run(lives[taught], weights[taught])
    states = np.zeros(len(lives), result.states.dtype)
    states[taught] = result.states
    errors = iter(result.errors)
    return BatchResult(
        states,
        [
            next(errors) if there else f"robot {robot}, whose networks it has, failed"
            for there, robot in zip(taught, robots, strict=True)
        ],
    )


def _life_rows(plan: Plan, lived: Lived) -> pa.Table:
    case, setting = plan.lived[lived.piece.place], lived.batch.setting
    columns = life_columns(plan, setting, case.seed, lived.lives, lived.result.states)
    columns["case"] = pa.array(np.full(len(lived.lives), case.number))
    return rows(columns, lived.result.errors, schema(plan, "lives"))


def _teacher_rows(plan: Plan, lived: Lived) -> pa.Table:
    columns = teacher_columns(lived.batch.setting, lived.lives, lived.result.states)
    columns["identity"] = _identities(plan, lived, len(lived.lives))
    return rows(columns, lived.result.errors, schema(plan, "teachers"))


def _identities(plan: Plan, lived: Lived, count: int) -> pa.Array:
    return pa.array([plan.classes[lived.piece.place].identity] * count, pa.string())


def _curves(plan: Plan, kind: Kind, lived: Iterable[Lived]) -> pa.Table:
    """Return what networks say of object types after each episode, of lives that learn."""
    tables = []
    for one in lived:
        if one.result.curve is None:
            continue
        whole = np.array([error is None for error in one.result.errors], bool)
        index = one.lives[whole].astype(np.int64)
        name = {"lives": "life", "teachers": "robot"}[kind]
        axes = {name: index, "episode": np.arange(EPISODES + 1)}
        table = long_table(one.batch.setting, one.result.curve[whole], axes)
        if kind == "lives":
            number = plan.lived[one.piece.place].number
            named = pa.field("case", pa.int64()), pa.array(np.full(table.num_rows, number))
        else:
            named = pa.field("identity", pa.string()), _identities(plan, one, table.num_rows)
        tables.append(table.add_column(0, *named))
    return joined(tables)


def _traces(plan: Plan, lived: Iterable[Lived]) -> tuple[Iterator[pa.Table], pa.Schema]:
    """Return the traces of the lives that are recorded, and their columns."""
    choice = _choice(plan)
    assert choice is not None
    traced = [
        Traced(
            plan.lived[one.piece.place].number,
            one.batch,
            one.result,
            one.lives,
            one.weights,
            recorded(plan, one.piece),
        )
        for one in lived
        if recorded(plan, one.piece)
    ]
    wanted = pa.unify_schemas([one.schema() for one in traced])
    return (table for one in traced for table in one.tables(choice, wanted)), wanted


def _choice(plan: Plan) -> TraceChoice | None:
    return TraceChoice.parse(plan.study.record.what) if plan.study.record else None

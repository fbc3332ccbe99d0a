"""Robots that teach in one study and have been lived in another: lent, not lived again.

Experiment 2 of the paper has the networks that the robots of Experiment 1 learnt.
"""

from __future__ import annotations

import pyarrow as pa
import pyarrow.compute as pc

from animat.study.plan.columns import joined, schema
from animat.study.plan.numbering import Part, Piece
from animat.study.plan.plan import Plan
from animat.study.plan.shard import Made, file_names, part_identity, shard_file
from animat.study.store.results import Results


def borrowed(plan: Plan, part: Part, lender: Results) -> Made | None:
    """Return a part of robots that teach from the results of a study in which they were lived.

    None where they were not, where one of them failed, or where more is wanted of them.
    """
    if part.kind != "teachers" or len(file_names(plan, part)) > 1:
        return None
    wanted = schema(plan, "teachers")
    tables, steps = [], 0
    for piece in plan.pieces(part):
        lives = _lives(plan.classes[piece.place].identity, piece, lender)
        if lives is None or not {"weights", "error"} <= set(lives.column_names):
            return None
        if lives.num_rows < piece.stop - piece.start or lives["error"].null_count < len(lives):
            return None
        steps += int(lives["lifespan"].to_numpy().sum())
        tables.append(_as_teachers(lives, plan.classes[piece.place].identity, wanted))
    table = joined(tables)
    content = shard_file([table], wanted, part_identity(plan, part), steps)
    return Made({part.file: content}, table.num_rows, steps, 0)


def _lives(identity: str, piece: Piece, lender: Results) -> pa.Table | None:
    """Return the lives of a piece from the results of another study, by their index."""
    cases = lender.cases.filter(pc.field("identity") == identity)
    if not cases.num_rows:
        return None
    life = pc.field("life")
    of_case = pc.field("case") == cases["same_as"][0].as_py()
    where = of_case & (life >= piece.start) & (life < piece.stop)
    return lender.dataset().to_table(filter=where).sort_by("life")


def _as_teachers(lives: pa.Table, identity: str, wanted: pa.Schema) -> pa.Table:
    columns = {
        **dict(zip(lives.column_names, lives.columns, strict=True)),
        "identity": pa.array([identity] * lives.num_rows),
        "robot": lives["life"],
    }
    return pa.table([columns[name] for name in wanted.names], schema=wanted)

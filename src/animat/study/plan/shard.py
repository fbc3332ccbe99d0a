"""A shard of a study: its files, its identity, whose networks it needs, and how it is stored."""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import pyarrow as pa

from animat.files.checksummed import header, verified, writing
from animat.files.settings import SettingsError
from animat.life.engine import ENGINE
from animat.study.file.study import Study
from animat.study.plan.numbering import Part, Piece
from animat.study.plan.plan import Plan

KIND_OF_FILE = "table of results"

RUN_AGAIN = "take it away, and animat run with the same study simulates it again"
OTHERS = f"holds the lives of another part or study, not its own; {RUN_AGAIN}"


class ShardHeader(NamedTuple):
    """What a file of a shard says of itself: identity, steps simulated, lives that failed, rows."""

    identity: str
    steps: int
    failed: int
    rows: int


class Made(NamedTuple):
    """A part that was lived: its files by their paths, the one that completes it last."""

    files: dict[str, bytes]
    lives: int
    steps: int
    failed: int


def classes_needed(plan: Plan, part: Part) -> list[int]:
    """Return the classes of teachers whose networks lives of a part have."""
    if part.kind == "teachers":
        return []
    found = [plan.class_of(piece.place) for piece in plan.pieces(part)]
    return sorted({place for place in found if place is not None})


def file_names(plan: Plan, part: Part) -> list[str]:
    """Return the paths of the files of a part; the last one completes it."""
    names = []
    if "learning_curve" in plan.study.measures and any(
        part.kind == "teachers" or plan.lived[piece.place].settings.mind.nature.learns
        for piece in plan.pieces(part)
    ):
        names.append(f"curves/{part.kind}-{part.number:06d}.parquet")
    if part.kind == "lives" and any(recorded(plan, piece) for piece in plan.pieces(part)):
        names.append(part.file.replace("lives/", "traces/"))
    return [*names, part.file]


def part_identity(plan: Plan, part: Part) -> str:
    """Return the identity of the lives of a part, and of what is told of them."""
    lived: list[list[Any]] = []
    for place, start, stop in plan.pieces(part):
        if part.kind == "teachers":
            lived.append([plan.classes[place].identity, start, stop])
        else:
            number = plan.lived[place].number
            lived.append([number, plan.identities[number], start, stop])
    return identity_of(ENGINE, plan.study, part, lived)


def identity_of(engine: int, study: Study, part: Part, lived: list[list[Any]]) -> str:
    """Return the identity of a part of which it is known who `lived` in it, piece by piece."""
    record = study.record and study.record.model_dump()
    told = [engine, part.kind, part.number, study.measures, record, lived]
    return hashlib.sha256(json.dumps(told).encode()).hexdigest()[:32]


def recorded(plan: Plan, piece: Piece) -> int:
    """Return how many lives of a piece, from its first on, are recorded."""
    wanted = plan.study.record.lives if plan.study.record else 0
    return max(0, min(piece.stop, wanted) - piece.start)


def shard_file(
    tables: Iterable[pa.Table], schema: pa.Schema, identity: str, steps: int = 0, failed: int = 0
) -> bytes:
    """Return tables of one schema as the content of a file of a shard, a row group each."""
    file = io.BytesIO()
    rows = 0
    with writing(file, schema) as writer:
        for table in tables:
            writer.write(table, f"rows {rows:,} to {rows + table.num_rows - 1:,}")
            rows += table.num_rows
        writer.close(json.dumps({"identity": identity, "steps": steps, "failed": failed}))
    return file.getvalue()


def shard_header(path: Path) -> ShardHeader:
    """Return what a file says of itself, its values unread. Raises SettingsError."""
    text, rows = header(path, KIND_OF_FILE)
    try:
        return ShardHeader(**json.loads(text), rows=rows)
    except (ValueError, TypeError):
        raise SettingsError(f"{path}: is no {KIND_OF_FILE}") from None


def stored(path: Path) -> ShardHeader | None:
    """Return what a file says of itself; None if there is none, or it is damaged."""
    try:
        return shard_header(path)
    except SettingsError:
        return None


def problem_of(
    path: Path, identity: str, rows: int | None = None, *, unread: bool = False
) -> str | None:
    """Return what is wrong with a file that should hold lives of an identity; None if nothing is.

    `rows` are those it should have, if that is known. `unread` leaves its values out.
    """
    if not path.exists():
        return f"{path}: is missing"
    try:
        said = shard_header(path)
        if said.identity != identity or rows not in {None, said.rows}:
            return f"{path}: {OTHERS}"
        if not unread:
            verified(path, KIND_OF_FILE)[1].close()
    except SettingsError as error:
        return f"{error.problems[0]}; {RUN_AGAIN}"
    return None

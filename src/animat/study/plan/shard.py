"""A shard of a study as it is planned: its files, its identity, and whose networks it needs."""

from __future__ import annotations

import hashlib
import json
from typing import Any, NamedTuple

from animat.life.engine import ENGINE
from animat.study.file.study import Study
from animat.study.plan.numbering import Part, Piece
from animat.study.plan.plan import Plan


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

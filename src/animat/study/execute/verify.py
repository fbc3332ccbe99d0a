"""Whether a results directory still holds what was lived, and whether that was right.

Every part is read and its checksums taken again, which finds whatever has changed since; and some
lives, spread over all, are simulated again, which finds what was wrong from the beginning.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyarrow as pa

from animat.files.checksummed import read_parquet
from animat.files.settings import SettingsError
from animat.life.engine import ENGINE
from animat.progress import Telling
from animat.study.execute.shard import live_pieces, table_of
from animat.study.plan.columns import schema
from animat.study.plan.numbering import KINDS, Kind, Part, Piece
from animat.study.plan.plan import Plan, plan_of
from animat.study.plan.shard import classes_needed, file_names, part_identity, problem_of
from animat.study.plan.training import read_networks
from animat.study.store.manifest import (
    CASES,
    COLUMNS,
    FOLDERS,
    INPUTS,
    OTHER_LIVES,
    WRITTEN_ANEW,
    changed_inputs,
    file_hash,
    place_of_copy,
    read_columns,
    read_text,
)
from animat.study.store.results import Results

SAMPLE = 64
"""Parts of a kind from which a life is lived again; they lie evenly spread over all there are."""


class Verified(NamedTuple):
    """What was looked at: parts read of all there are to be, lives lived again; what is wrong."""

    parts: int
    all_parts: int
    lives: int
    problems: list[str]


def verify(results: Results, tell: Telling) -> Verified:
    """Read everything a results directory holds, and live some of its lives again.

    Raises SettingsError where the study cannot be lived here at all.
    """
    directory = results.directory
    if results.manifest["engine"] != ENGINE:
        was = results.manifest["engine"]
        wrong = (
            f"{directory}: was lived by engine {was}; this is engine {ENGINE}, whose lives differ"
        )
        return Verified(0, 0, 0, [wrong])
    try:
        text = read_text(directory, results.manifest)
    except SettingsError as error:
        return Verified(0, 0, 0, list(error.problems))
    if changed := changed_inputs(directory, results.manifest):
        return Verified(0, 0, 0, changed)
    plan = plan_of(text)
    if results.cases["identity"].to_pylist() != plan.identities:
        return Verified(0, 0, 0, [f"{directory}: {OTHER_LIVES}"])
    if not results.cases.equals(plan.case_table()):
        return Verified(0, 0, 0, [f"{directory / CASES}: has other cases than the study"])
    problems: list[str] = []
    good: set[Part] = set()
    parts = list(plan.all_parts())
    problems += _wrong_descriptions(results, plan)
    problems += _strays(directory, plan, parts)
    for part in parts:
        found = _read_again(directory, plan, part)
        problems += found or []
        good |= {part} if found == [] else set()
        tell("Parts read", 1, len(parts))
    problems += _missing_teachers(directory, plan, good)
    sample = [part for kind in KINDS for part in _sample(plan, kind, good)]
    for part in sample:
        problems += _live_again(directory, plan, part)
        tell("Lives lived again", 1, len(sample))
    return Verified(len(good), len(parts), len(sample), problems)


def _wrong_descriptions(results: Results, plan: Plan) -> Iterator[str]:
    """Yield what is wrong with the columns told, and with the copies of the user's files."""
    directory = results.directory
    for kind in KINDS:
        try:
            columns = read_columns(directory, kind)
        except SettingsError as error:
            yield from error.problems
            continue
        if plan.numbering[kind].total and not columns.equals(schema(plan, kind)):
            yield f"{directory / kind / COLUMNS}: has other columns than the study; {WRITTEN_ANEW}"
    for path, was in results.manifest["inputs"].items():
        kept = directory / place_of_copy(path)
        if not kept.is_file() or file_hash(kept) != was:
            yield f"{kept}: is no copy of {path} any more; {WRITTEN_ANEW}"


def _strays(directory: Path, plan: Plan, parts: list[Part]) -> Iterator[str]:
    """Yield the files among the parts that are none, which nobody reads."""
    ours = {directory / name for part in parts for name in file_names(plan, part)}
    ours |= {directory / kind / COLUMNS for kind in KINDS}
    for folder in FOLDERS:
        if folder != INPUTS:
            for path in sorted((directory / folder).glob("[!.]*")):
                if path not in ours:
                    yield f"{path}: is none of the files of the study"


def _read_again(directory: Path, plan: Plan, part: Part) -> list[str] | None:
    """Return what is wrong with the files of a part; None if it is not finished."""
    if not (directory / part.file).exists():
        return None
    return list(_wrong(directory, plan, part))


def _wrong(directory: Path, plan: Plan, part: Part) -> Iterator[str]:
    identity = part_identity(plan, part)
    found = (problem_of(directory / name, identity) for name in file_names(plan, part))
    yield from filter(None, found)


def _taught_by(plan: Plan, part: Part) -> set[Part]:
    """Return the parts of those who teach in a part."""
    return {one for place in classes_needed(plan, part) for one in plan.parts_of_class(place)}


def _missing_teachers(directory: Path, plan: Plan, good: set[Part]) -> list[str]:
    """Return what is missing because lives that are finished were taught by it."""
    needed = {one for part in good for one in _taught_by(plan, part)}
    missing = [one for one in sorted(needed) if not (directory / one.file).exists()]
    return [f"{directory / one.file}: is missing, and lives were taught by it" for one in missing]


def _sample(plan: Plan, kind: Kind, good: set[Part]) -> list[Part]:
    """Return some parts that lie evenly among those of which a life can be lived again."""
    own = sorted(p for p in good if p.kind == kind and _taught_by(plan, p) <= good)
    chosen = np.unique(np.linspace(0, len(own) - 1, min(SAMPLE, len(own))).round().astype(int))
    return [own[n] for n in chosen]


def _live_again(directory: Path, plan: Plan, part: Part) -> list[str]:
    """Live a life of a part again, and return in what it differs from what is written."""
    path = directory / part.file
    numbering = plan.numbering[part.kind]
    row = (part.number * 7919) % numbering.rows(part.number)
    piece = _life_at(plan.pieces(part), row)
    needed = classes_needed(plan, part)
    networks = {place: read_networks(directory, plan, place) for place in needed}
    now = table_of(plan, part.kind, live_pieces(plan, part.kind, [piece], networks))
    then = read_parquet(path).slice(row, 1)
    differing = [name for name in now.column_names if _differ(now, then, name)]
    if not differing:
        return []
    return [f"{path}: row {row} is another when it is lived again, in {', '.join(differing)}"]


def _life_at(pieces: list[Piece], row: int) -> Piece:
    """Return the piece of the one life that has a row of a part."""
    for place, start, stop in pieces:
        if row < stop - start:
            return Piece(place, start + row, start + row + 1)
        row -= stop - start
    raise IndexError(row)


def _differ(now: pa.Table, then: pa.Table, name: str) -> bool:
    """Whether two tables differ in a column; texts of numbers tell -0 from 0, and NaN is NaN."""
    return name not in then.column_names or str(now[name].to_pylist()) != str(
        then[name].to_pylist()
    )

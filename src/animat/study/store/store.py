"""The results directory of a study: what stands in it, and how it comes there.

Every file is written whole, so that a directory holds finished work and nothing else, whenever and
however its writer ends. What of the work is finished is what is there: no list is kept beside it
that could say otherwise. docs/running.md describes the directory.
"""

from __future__ import annotations

import hashlib
import io
import json
import tomllib
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
from numpy.typing import NDArray

from animat.files import sync_directory, write_whole
from animat.life.engine import ENGINE
from animat.settings import SettingsError
from animat.study.living.columns import schema
from animat.study.living.numbering import KINDS, Part
from animat.study.living.parts import Made, file_names, part_identity
from animat.study.living.plan import Plan
from animat.study.living.seal import Seal, seal_of
from animat.study.living.teachers import read_networks
from animat.study.provenance import provenance
from animat.study.store.differences import differences
from animat.study.store.lock import Holder, RunError, hold
from animat.study.store.log import Log, logging_to

STUDY, MANIFEST, CASES = "study.toml", "manifest.json", "cases.parquet"
LOCK, LOG, INPUTS = "lock", "log.jsonl", "inputs"
COLUMNS = "_common_metadata"
"""The file that tells the columns of parts before there is any; Parquet's own name for it."""

FOLDERS = ("lives", "teachers", "curves", "traces", INPUTS)


class StoreError(RunError):
    """A results directory cannot be written any more; what is finished is kept."""


@dataclass(frozen=True)
class Store:
    """A results directory that this process holds, and the plan of its study.

    `dead` held it before and died.
    """

    directory: Path
    plan: Plan
    log: Log
    dead: Holder | None

    def finished(self, part: Part) -> Seal | None:
        """Return the seal of a part that is finished; None for one that is not, or is torn.

        Raises SettingsError for a part of other lives.
        """
        wanted = part_identity(self.plan, part)
        seal = None
        for name in file_names(self.plan, part):
            path = self.directory / name
            seal = seal_of(path)
            if seal is None:
                if path.exists():
                    self.note("torn", file=name)
                return None
            if seal.identity != wanted:
                raise SettingsError(f"{path}: holds lives of another study; take it away")
        return seal

    def put(self, part: Part, made: Made) -> None:
        """Write the files of a part. Raises StoreError."""
        with _kept(self.directory):
            for name, content in made.files.items():
                write_whole(self.directory / name, content)
        facts = {"lives": made.lives, "steps": made.steps, "failed": made.failed}
        self.note("part", kind=part.kind, number=part.number, **facts)

    def note(self, event: str, /, **facts: Any) -> None:
        """Take down an event in the log. Raises StoreError."""
        with _kept(self.directory / LOG):
            self.log(event, **facts)

    def networks(self, place: int) -> NDArray[np.float64]:
        """Return the weights [robots, B, W] of a class of teachers; NaN of robots that failed."""
        return read_networks(self.directory, self.plan, place)


@contextmanager
def open_store(directory: Path, plan: Plan) -> Iterator[Store]:
    """Hold the results directory of a study, a new one or one to go on with.

    Raises:
        SettingsError: it holds something else, or cannot be written.
        HeldError: another process holds it.
    """
    with ExitStack() as stack:
        try:
            _refuse_what_is_not_ours(directory)
            _make(directory)
            dead = stack.enter_context(hold(directory / LOCK))
            log = stack.enter_context(logging_to(directory / LOG))
            _clear(directory)
            _begin(directory, plan)
        except OSError as error:
            why = error.strerror or error
            raise SettingsError(f"{directory}: cannot be written: {why}") from None
        yield Store(directory, plan, log, dead)


def read_manifest(directory: Path) -> dict[str, Any]:
    """Return the manifest of a results directory. Raises SettingsError where there is none."""
    try:
        return json.loads((directory / MANIFEST).read_text("utf-8"))
    except (OSError, ValueError):
        raise SettingsError(
            f"{directory}: is no results directory: it has no whole {MANIFEST}"
        ) from None


def _refuse_what_is_not_ours(directory: Path) -> None:
    if not directory.exists() or (directory / MANIFEST).is_file():
        return
    if not directory.is_dir():
        raise SettingsError(f"{directory}: is a file; give a directory with --out")
    ours = {STUDY, CASES, LOCK, LOG, *FOLDERS}
    for path in directory.iterdir():
        if path.name not in ours and not path.match(".*.part"):
            raise SettingsError(
                f"{directory}: is no results directory: it holds {path.name};"
                " give another with --out"
            )


def _make(directory: Path) -> None:
    missing = [one for one in (directory, *directory.parents) if not one.exists()]
    directory.mkdir(parents=True, exist_ok=True)
    for one in missing:
        sync_directory(one.parent)


def _begin(directory: Path, plan: Plan) -> None:
    """Say what the directory is for, or see that it is for this."""
    made = provenance()
    if (directory / MANIFEST).exists():
        manifest = read_manifest(directory)
        found = differences_from(directory, plan)
        if found:
            raise SettingsError(
                *(f"{directory}: {line}" for line in found),
                f"{directory}: is left as it is; --out gives this study a directory of its own",
            )
    else:
        _describe(directory, plan)
        manifest = {
            "study": plan.study.name,
            "hash": text_hash(plan.text),
            "engine": ENGINE,
            **{kind: plan.numbering[kind].written() for kind in KINDS},
            "steps_to_learn": plan.steps_to_learn,
            "inputs": _inputs(plan),
            "runs": [],
        }
    manifest["runs"].append(made)
    _write(directory / MANIFEST, json.dumps(manifest, indent=2) + "\n")


def _describe(directory: Path, plan: Plan) -> None:
    inputs = _inputs(plan)
    for folder in _folders(plan):
        (directory / folder).mkdir(exist_ok=True)
    sync_directory(directory)
    for path, copy in inputs.items():
        write_whole(directory / INPUTS / copy, Path(path).read_bytes())
    _write(directory / STUDY, plan.text)
    cases = io.BytesIO()
    pq.write_table(plan.case_table(), cases)
    write_whole(directory / CASES, cases.getvalue())
    for kind in KINDS:
        if (directory / kind).exists():
            columns = io.BytesIO()
            pq.write_metadata(schema(plan, kind), columns)
            write_whole(directory / kind / COLUMNS, columns.getvalue())


def _folders(plan: Plan) -> list[str]:
    """Return the folders that the results of a study need."""
    needed = {
        "lives": True,
        "teachers": bool(plan.classes),
        "curves": "learning_curve" in plan.study.measures,
        "traces": plan.study.record is not None,
        INPUTS: bool(plan.inputs),
    }
    return [folder for folder in FOLDERS if needed[folder]]


def differences_from(directory: Path, plan: Plan) -> list[str]:
    """Return a line for everything in which a study is not the one of a results directory.

    Raises SettingsError where it is none.
    """
    manifest = read_manifest(directory)
    if manifest["engine"] != ENGINE:
        return [f"was lived by engine {manifest['engine']}, and this is engine {ENGINE}"]
    there = (directory / STUDY).read_text("utf-8")
    if there != plan.text:
        found = differences(tomllib.loads(there), tomllib.loads(plan.text))
        return found or ["has its factors in another order"]
    now = _inputs(plan)
    changed = [path for path, copy in manifest["inputs"].items() if now.get(path) != copy]
    if changed:
        return [
            f"{path} has changed since; as it was it is in {directory / INPUTS}" for path in changed
        ]
    cases = pq.read_table(directory / CASES)
    if cases["identity"].to_pylist() != plan.identities:
        return ["its lives are not those that this animat lives of the same study"]
    return []


def _inputs(plan: Plan) -> dict[str, str]:
    """Return the files a study draws on beside its own, each with the name of its copy."""
    return {
        path: f"{hashlib.sha256(Path(path).read_bytes()).hexdigest()[:8]}-{Path(path).name}"
        for path in sorted(plan.inputs)
    }


def _write(path: Path, text: str) -> None:
    write_whole(path, text.encode())


def _clear(directory: Path) -> None:
    """Take away what writers that were killed left unfinished."""
    for folder in (directory, *(directory / name for name in FOLDERS)):
        for path in folder.glob(".*.part"):
            path.unlink()


@contextmanager
def _kept(path: Path) -> Iterator[None]:
    """Say of what cannot be written that what is finished is kept."""
    try:
        yield
    except (OSError, SettingsError) as error:
        what = str(error)
        if isinstance(error, OSError):
            what = f"{path}: cannot be written: {error.strerror or error}"
        raise StoreError(
            f"{what}; what is finished is kept, and the same command goes on with it"
        ) from None


def text_hash(text: str) -> str:
    """Return the hash by which a study is known."""
    return hashlib.sha256(text.encode()).hexdigest()

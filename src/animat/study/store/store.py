"""The results directory of a study: what stands in it, and how it comes there.

Every file is written whole, so that a directory holds finished work and nothing else, whenever and
however its writer ends. What of the work is finished is what is there: no list is kept beside it
that could say otherwise. docs/running.md describes the directory.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from animat.files.atomic import RunError, sync_directory, unwritable, write_whole
from animat.files.lock import Holder, hold
from animat.files.settings import SettingsError
from animat.study.plan.numbering import Part
from animat.study.plan.plan import Plan
from animat.study.plan.shard import OTHERS, Made, ShardHeader, file_names, part_identity, stored
from animat.study.plan.training import read_networks
from animat.study.store.log import Log, logging_to
from animat.study.store.manifest import CASES, FOLDERS, MANIFEST, STUDY, begin

LOCK, LOG = "lock", "log.jsonl"


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

    def finished(self, part: Part) -> ShardHeader | None:
        """Return the header of a part that is finished; None for one that is not, or is damaged.

        Raises SettingsError for a part of other lives.
        """
        wanted = part_identity(self.plan, part)
        said = None
        for name in file_names(self.plan, part):
            path = self.directory / name
            said = stored(path)
            if said is None:
                if path.exists():
                    if not path.is_file():
                        raise SettingsError(f"{path}: is no file; take it away")
                    self.note("torn", file=name)
                return None
            if said.identity != wanted:
                raise SettingsError(f"{path}: {OTHERS}")
        return said

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
        RunError: the disk is full, or fails.
    """
    with ExitStack() as stack:
        try:
            _refuse_what_is_not_ours(directory)
            _make(directory)
            dead = stack.enter_context(hold(directory / LOCK))
            log = stack.enter_context(logging_to(directory / LOG))
            _clear(directory)
            begin(directory, plan)
        except OSError as error:
            raise unwritable(error.filename or directory, error) from None
        yield Store(directory, plan, log, dead)


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
    except (OSError, SettingsError, RunError) as error:
        what = unwritable(path, error) if isinstance(error, OSError) else error
        raise StoreError(
            f"{what}; what is finished is kept, and the same command goes on with it"
        ) from None

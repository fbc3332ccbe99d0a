"""What a worker of a cluster does: it says what it has, and lives parts.

The scheduler reads the names of these functions as it passes them on, so nothing heavy is imported
before a worker needs it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path
from threading import Event, Lock
from typing import TYPE_CHECKING, Any, NamedTuple

from animat.files.atomic import RunError
from animat.files.provenance import versions
from animat.life.engine import ENGINE
from animat.study.plan.numbering import Part

if TYPE_CHECKING:
    from animat.study.execute.shard import Networks
    from animat.study.plan.shard import Made

DRAWS_ONLY = "matplotlib"
"""The package whose version has no part in what is lived or written of it."""

_PLANNING = Lock()


class ClusterError(RunError):
    """A cluster cannot be used, or not any more; what is finished is kept."""


class OtherLivesError(ClusterError):
    """A worker reads other lives from a study than the client does."""


class Equipment(NamedTuple):
    """What decides whether processes live the same lives and write the same bytes of them.

    `versions` by what has them; `source`, the hash of animat's source files, which can change
    without its version; `files`, the hash of each file that the study draws on, None where there
    is none; `folder`, which their paths start from.
    """

    versions: dict[str, str]
    source: str
    files: dict[str, str | None]
    folder: str

    def lacks(self, wanted: Equipment) -> list[str]:
        """Return in what this differs from what is wanted, a text for each difference."""
        found = [
            f"{name} {self.versions.get(name, 'none')} and not {version}"
            for name, version in wanted.versions.items()
            if self.versions.get(name) != version
        ]
        if self.source != wanted.source:
            found.append("other source files of animat")
        for path, content in wanted.files.items():
            if self.files[path] is None:
                found.append(f"no file {path} in {self.folder}")
            elif self.files[path] != content:
                found.append(f"another {path} in {self.folder}")
        return found


def equipment(paths: Iterable[str]) -> Equipment:
    """Return what this process has, and what it finds at the paths that a study draws on."""
    used = {name: version for name, version in versions().items() if name != DRAWS_ONLY}
    # Results do not depend on the last number of Python's version, and machines often differ in it.
    used["python"] = used["python"].rpartition(".")[0]
    used["engine"] = str(ENGINE)
    used["distributed"] = version("distributed")
    files = {path: _hash(Path(path)) for path in paths}
    return Equipment(used, _source_hash(), files, str(Path.cwd()))


def live(text: str, part: Part, networks: Networks, identity: str) -> Made:
    """Live a part as `live_part` does, on a worker.

    `identity` is that of the part, as the client reads the study. Raises OtherLivesError where it
    is not the same here, and StoppedError once nobody wants the part any more.
    """
    from animat.study.execute.shard import live_part
    from animat.study.plan.plan import forget, plan_of
    from animat.study.plan.shard import part_identity

    with _PLANNING:
        if part_identity(plan_of(text), part) != identity:
            # A file that the study draws on was another when this process read it.
            forget()
            if part_identity(plan_of(text), part) != identity:
                raise OtherLivesError(
                    "a worker reads other lives from this study: do files that functions of yours"
                    " import differ there?"
                )
    return live_part(text, part, networks, _Unwanted())


def begun(dask_worker: Any) -> list[str]:
    """Return the keys of the tasks that a worker is at."""
    return [task.key for task in dask_worker.state.executing]


class _Unwanted(Event):
    """Is set once nobody wants any more what this thread works at."""

    def __init__(self) -> None:
        from distributed import get_worker

        super().__init__()
        self._worker: Any = get_worker()
        self._key = self._worker.get_current_task()

    def is_set(self) -> bool:
        task = self._worker.state.tasks.get(self._key)
        return task is None or task.state == "cancelled"


def _source_hash() -> str:
    root = Path(__file__).parents[2]
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(f"{path.relative_to(root).as_posix()} {_hash(path)}\n".encode())
    return digest.hexdigest()


def _hash(path: Path) -> str | None:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None

"""Runs of a study that are broken off: a driver that imports everything once, and forks for each.

    python faults.py

For every line on its input, [how, folder, number] as JSON, one on its output tells what came of it.
`Faults` counts every call that changes the
disk, and can make one of them the last.
"""

from __future__ import annotations

import errno
import hashlib
import io
import json
import os
import pathlib
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from animat.files.atomic import RunError
from animat.files.settings import SettingsError
from animat.study.execute.run import run, threads
from animat.study.file.study import Study
from animat.study.plan.plan import Plan, plan_of

SMALL = """
name = "small"
lives = 8
steps = 150
measures = ["likelihoods", "learning_curve"]
[teacher]
robots = 3
steps = 600
[record]
what = "last:20"
lives = 1
[design.grid]
"mind.agent" = ["LEARNING", "AF"]
"""
"""A study that writes files of every kind, and few of them."""

LARGER = SMALL.replace("lives = 8", "lives = 100")
"""A few hundred lives."""

DONE, FAILED, WRONG, UNDISTURBED = 0, 3, 4, 5
"""How a run ended: complete, told that the disk fails, told that the directory cannot be written,
complete before there was a fault."""


class Faults:
    """Every call that changes the disk, counted; at number `last` comes the `end`."""

    def __init__(self, last: int, end: Callable[[], None]) -> None:
        self.count, self.last, self.end = 0, last, end

    def reached(self) -> bool:
        self.count += 1
        return self.count == self.last

    def install(self) -> None:
        """Stand between the package and the system."""
        for name in ("fsync", "replace", "mkdir", "unlink", "ftruncate"):
            setattr(os, name, self._whole(getattr(os, name)))
        for name, place in (("write", 1), ("pwrite", 1)):
            setattr(os, name, self._torn(getattr(os, name), place))
        own_open = io.open

        def opened(file: Any, mode: str = "r", *rest: Any, **more: Any) -> Any:
            if set(mode) & set("wxa+") and self.reached():
                self.end()
            return own_open(file, mode, *rest, **more)

        def write_bytes(path: Path, content: bytes) -> int:
            with path.open("wb", buffering=0) as handle:
                if self.reached():
                    handle.write(content[: len(content) // 2])
                    self.end()
                return handle.write(content)

        io.open = opened
        pathlib.Path.write_bytes = write_bytes

    def _whole(self, call: Callable[..., Any]) -> Callable[..., Any]:
        def counted(*arguments: Any, **more: Any) -> Any:
            if self.reached():
                self.end()
            return call(*arguments, **more)

        return counted

    def _torn(self, call: Callable[..., Any], place: int) -> Callable[..., Any]:
        def counted(*arguments: Any) -> Any:
            if self.reached():
                half = list(arguments)
                half[place] = half[place][: len(half[place]) // 2]
                call(*half)
                self.end()
            return call(*arguments)

        return counted


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def no_room() -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def forked(work: Callable[[], int], after: float | None = None) -> int:
    """Do work in a process of its own, kill it `after` some seconds, and return how it ended.

    That is its exit code, or minus the signal that ended it.
    """
    child = os.fork()
    if not child:
        code = 99
        try:
            code = work()
        except BaseException as error:
            sys.stderr.write(f"{type(error).__name__}: {error}\n")
        finally:
            os._exit(code)
    if after is not None:
        time.sleep(after)
        with suppress(ProcessLookupError):
            os.kill(child, signal.SIGKILL)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def lived(study: Plan, directory: Path) -> int:
    """Live a study, and tell how that ended."""
    try:
        with threads(2) as workers:
            outcome = run(study, directory, workers, lambda *_, **__: None)
    except RunError as error:
        sys.stderr.write(f"{error}\n")
        return FAILED
    except SettingsError as error:
        sys.stderr.write(f"{error}\n")
        return WRONG
    assert outcome.complete
    return DONE


def told_of(directory: Path) -> dict[str, str]:
    """The hash of every file of a results directory but those that tell of runs."""
    return {
        str(path.relative_to(directory)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(directory.rglob("*"))
        if path.is_file() and path.name not in {"manifest.json", "log.jsonl", "lock"}
    }


def at_writes(folder: Path, step: int, end: Callable[[], None]) -> dict[str, Any]:
    """End runs at the first call that changes the disk, at the one `step` later, ..., and go on
    with each.
    """
    study = plan(SMALL)
    whole = _undisturbed(study, folder)
    different, ends, last = [], [], 1

    def disturbed(directory: Path, last: int) -> int:
        faults = Faults(last, end)
        faults.install()
        ended = lived(study, directory)
        return ended if faults.count >= last else UNDISTURBED

    while UNDISTURBED not in ends:
        directory = folder / str(last)
        ends.append(forked(lambda to=directory, at=last: disturbed(to, at)))
        assert forked(lambda to=directory: lived(study, to)) == DONE
        if told_of(directory) != whole:
            different.append(last)
        last += step
    return {"points": last - step - 1, "ends": sorted(set(ends)), "different": different}


def at_any_moment(folder: Path, number: int) -> dict[str, Any]:
    """Kill runs at so many random moments, and go on with each until it is complete or killed
    again.
    """
    study = plan(LARGER)
    whole = _undisturbed(study, folder)
    started = time.monotonic()
    assert forked(lambda: lived(study, folder / "timed")) == DONE
    longest = time.monotonic() - started
    moments = random.Random(1)
    kills, complete, different = 0, 0, 0
    directory = folder / "0"
    while kills < number or directory.exists():
        after = moments.uniform(0.0, longest / 2) if kills < number else None
        ended = forked(lambda to=directory: lived(study, to), after)
        kills += ended == -signal.SIGKILL
        if ended == DONE:
            complete += 1
            different += told_of(directory) != whole
            directory = folder / str(complete)
        elif ended != -signal.SIGKILL:
            return {"ended": ended}
    return {"kills": kills, "complete": complete, "different": different}


def on_full_disks(folder: Path) -> dict[str, Any]:
    """Live where files cannot grow, and where there is no room, and go on where there is some."""
    study = plan(SMALL)
    whole = _undisturbed(study, folder)

    limited = folder / "limited"

    def with_a_limit() -> int:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (9_000, 9_000))
        return lived(study, limited)

    ends = {"limit": forked(with_a_limit)}
    assert forked(lambda: lived(study, limited)) == DONE
    different = [] if told_of(limited) == whole else ["limit"]
    small = folder / "disk"
    small.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=48k", "tmpfs", str(small)],
        check=False,
        capture_output=True,
    )
    if mounted.returncode == 0:
        try:
            ends["disk"] = forked(lambda: lived(study, small / "results"))
            subprocess.run(["mount", "-o", "remount,size=9m", str(small)], check=True)
            assert forked(lambda: lived(study, small / "results")) == DONE
            different += [] if told_of(small / "results") == whole else ["disk"]
        finally:
            subprocess.run(["umount", str(small)], check=True)
    return {"ends": ends, "different": different}


def where_nothing_may_be_written(folder: Path) -> dict[str, Any]:
    """Go on in a directory that is read only, as somebody who has no special rights."""
    study = plan(SMALL)
    whole = _undisturbed(study, folder)
    directory = folder / "results"
    assert forked(lambda: lived(study, directory)) == DONE
    (directory / "lives" / "part-000001.parquet").unlink()
    before = told_of(directory)
    folders = [directory, *(path for path in directory.iterdir() if path.is_dir())]

    def as_nobody() -> int:
        if os.geteuid() == 0:
            os.setgid(65534)
            os.setuid(65534)
        return lived(study, directory)

    for path in [folder, *folder.parents]:
        if path != path.parent and path.stat().st_uid == os.getuid():
            path.chmod(path.stat().st_mode | 0o111)
    for path in folders:
        path.chmod(0o555)
    (directory / "lock").chmod(0o444)
    (directory / "log.jsonl").chmod(0o444)
    ended = forked(as_nobody)
    untouched = told_of(directory) == before
    for path in [*folders, directory / "lock", directory / "log.jsonl"]:
        path.chmod(0o755)
    again = forked(lambda: lived(study, directory))
    return {
        "ended": ended,
        "untouched": untouched,
        "again": again,
        "different": told_of(directory) != whole,
    }


def go_on(study: Plan, directory: Path) -> None:
    """Live what a directory lacks of a study."""
    assert lived(study, directory) == DONE


def planned(study: Study) -> Plan:
    """The plan of a study."""
    return plan_of(study.to_toml())


def plan(text: str) -> Plan:
    """The plan of the study that a text describes."""
    return planned(Study.model_validate_json(json.dumps(tomllib.loads(text))))


def _undisturbed(study: Plan, folder: Path) -> dict[str, str]:
    """Live the study once from its beginning to its end, here, which loads all code there is."""
    with tempfile.TemporaryDirectory(dir=folder) as directory:
        assert lived(study, Path(directory)) == DONE
        return told_of(Path(directory))


HOW: dict[str, Callable[[Path, int], dict[str, Any]]] = {
    "killed at writes": lambda folder, step: at_writes(folder, step, die),
    "no room at writes": lambda folder, step: at_writes(folder, step, no_room),
    "killed at any moment": at_any_moment,
    "full disks": lambda folder, _: on_full_disks(folder),
    "read only": lambda folder, _: where_nothing_may_be_written(folder),
}


if __name__ == "__main__":
    for line in sys.stdin:
        how, directory, number = json.loads(line)
        sys.stdout.write(json.dumps(HOW[how](Path(directory), number)) + "\n")
        sys.stdout.flush()

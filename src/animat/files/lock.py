"""Who holds a results directory: one process at a time.

The lock is the kernel's (flock) and goes with the process, however that ends. What stands in the
file is for people: who holds it, on which machine, since when. A holder that ended in an orderly
way takes its words back; words that nobody holds are those of one that died.
"""

from __future__ import annotations

import fcntl
import json
import os
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

from animat.files.atomic import RunError

PATIENCE = 1.0
"""Seconds to wait for one who only looks, as `holder` does for a moment."""

PAUSE = 0.02

LONGEST = 4096
"""Bytes of a lock file that are worth reading."""


class Holder(NamedTuple):
    """A process that holds, or held, a results directory."""

    pid: int
    host: str
    since: str

    def __str__(self) -> str:
        """Return who it is in words."""
        return f"process {self.pid} on {self.host}, since {self.since}"


class HeldError(RunError):
    """Another process holds the directory; `str` says who."""


@contextmanager
def hold(lock: Path) -> Iterator[Holder | None]:
    """Hold a directory by its lock file; yield the holder before this one if it died holding it.

    Raises:
        HeldError: another process holds it.
        OSError: the lock file cannot be written.
    """
    file = os.open(lock, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        if not _taken(file):
            who = _words(file) or "another process"
            raise HeldError(f"{lock.parent}: is held by {who}; wait for it or stop it")
        dead = _words(file)
        now = datetime.now(UTC).isoformat(timespec="seconds")
        _say(file, json.dumps(Holder(os.getpid(), socket.gethostname(), now)._asdict()) + "\n")
        try:
            yield dead
        finally:
            with suppress(OSError):
                os.ftruncate(file, 0)
    finally:
        os.close(file)


def holder(lock: Path) -> tuple[Holder | None, bool]:
    """Return who holds a directory and True, or who held it last and died, or None, and False.

    A lock that cannot be looked at, or is no file, is held by nobody.
    """
    try:
        file = os.open(lock, os.O_RDONLY | os.O_NONBLOCK)
    except OSError:
        return None, False
    try:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return _words(file), True
        except OSError:
            return None, False
        return _words(file), False
    finally:
        os.close(file)


def _taken(file: int) -> bool:
    deadline = time.monotonic() + PATIENCE
    while True:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > deadline:
                return False
            time.sleep(PAUSE)
        else:
            return True


def _words(file: int) -> Holder | None:
    """Return the holder a lock file names; None for none, and for words that are torn."""
    try:
        return Holder(**json.loads(os.pread(file, LONGEST, 0)))
    except (OSError, ValueError, TypeError, RecursionError):
        return None


def _say(file: int, text: str) -> None:
    os.ftruncate(file, 0)
    os.pwrite(file, text.encode(), 0)

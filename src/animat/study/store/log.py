"""What happened in a results directory, a line of JSON for each event.

`at` is the time of day, for people; whatever is reckoned is reckoned with `seconds`, which come
from a clock that never goes back and count from the start of the run. A line torn by the end of
its writer is passed over.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Protocol


class Log(Protocol):
    """Takes down an event with what belongs to it."""

    def __call__(self, event: str, /, **facts: Any) -> None:
        """Take it down. Raises OSError."""


@contextmanager
def logging_to(path: Path) -> Iterator[Log]:
    """Yield what takes down the events of a run at the end of a log. Raises OSError."""
    started = time.monotonic()
    file = os.open(path, os.O_RDWR | os.O_APPEND | os.O_CREAT, 0o666)

    def log(event: str, /, **facts: Any) -> None:
        entry = {
            "event": event,
            "at": datetime.now(UTC).isoformat(timespec="seconds"),
            "seconds": round(time.monotonic() - started, 3),
            **facts,
        }
        os.write(file, json.dumps(entry).encode() + b"\n")

    try:
        size = os.fstat(file).st_size
        if size and os.pread(file, 1, size - 1) != b"\n":
            os.write(file, b"\n")
        yield log
    finally:
        os.close(file)


def entries(path: Path) -> Iterator[dict[str, Any]]:
    """Yield the events of a log, torn ones left out; none if there is no log. Raises OSError."""
    if not path.is_file():
        return
    with path.open("rb") as file:
        for line in file:
            try:
                entry = json.loads(line)
            except (ValueError, RecursionError):
                continue
            if isinstance(entry, dict) and "event" in entry:
                yield entry

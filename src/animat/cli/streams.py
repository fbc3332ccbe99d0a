"""The standard streams of a command: one that is closed, full or not read stops no work."""

from __future__ import annotations

import errno
import io
import os
import sys
from typing import Any


class Steady(io.FileIO):
    """A stream to write to; from the first write that fails on, what comes is dropped."""

    lost: OSError | None = None

    def write(self, data: Any, /) -> int:
        """Write bytes, and return how many."""
        if self.lost is None:
            try:
                return super().write(data)
            except OSError as error:
                self.lost = error
        return memoryview(data).nbytes


def steady_streams() -> None:
    """Make the standard streams steady, but those that somebody has replaced."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free: this one
    for number, name in ((1, "stdout"), (2, "stderr")):
        stream, own = getattr(sys, name), getattr(sys, f"__{name}__")
        if stream is own:
            raw = Steady(number, "w", closefd=False)
            setattr(
                sys,
                name,
                io.TextIOWrapper(
                    io.BufferedWriter(raw),
                    getattr(own, "encoding", None),
                    "replace" if name == "stdout" else "backslashreplace",
                    line_buffering=raw.isatty() or name == "stderr",
                ),
            )
        elif name == "stdout" and isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def why_output_was_lost() -> str | None:
    """Return why the output could not be written; None if it was, or if its reader went away."""
    sys.stdout.flush()
    raw = getattr(getattr(sys.stdout, "buffer", None), "raw", None)
    lost = raw.lost if isinstance(raw, Steady) else None
    return lost.strerror if lost and lost.errno != errno.EPIPE else None

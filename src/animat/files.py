"""Files written whole: under a temporary name first, so that nothing is ever half-written."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from animat.settings import SettingsError


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """Yield a temporary name beside `path`; what is written there takes the name at the end.

    What was at `path` stays as it was if anything goes wrong. Afterwards the file is on the disk
    and not only under way to it: a power cut loses neither its content nor its name.

    Raises:
        SettingsError: the file cannot be written.
    """
    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        yield partial
        with partial.open("rb+") as file:
            os.fsync(file.fileno())
        partial.replace(path)
        sync_directory(path.parent)
    except OSError as error:
        raise SettingsError(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        with suppress(OSError):
            partial.unlink()


def sync_directory(path: Path) -> None:
    """Bring the names of the files in a directory to the disk. Raises OSError."""
    directory = os.open(path, os.O_RDONLY)
    try:
        os.fsync(directory)
    finally:
        os.close(directory)


def write_whole(path: Path, content: bytes) -> None:
    """Write `content` to `path`, replacing what was there. Raises SettingsError."""
    with whole(path) as partial:
        partial.write_bytes(content)

"""Output directories: whole or not at all, and never over another without being asked."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from animat.files.atomic import unwritable
from animat.files.lock import hold
from animat.files.settings import SettingsError

LOCK = "lock"

HOW_MADE = "how_made.json"
"""The file that every result holds: only a directory with it is replaced by another."""


@contextmanager
def fresh_directory(out: Path, *, force: bool) -> Iterator[Path]:
    """Yield a directory to fill; it takes the name `out` once it is filled without an error.

    What comes to nothing is kept, hidden beside `out`, and yielded again the next time. With
    `force` the directory takes the place of an earlier result, which stays until it is whole.

    Raises:
        SettingsError: `out` is there already and not `force`, is no result, or cannot be made.
        HeldError: another process fills it.
        RunError: the disk is full, or fails.
    """
    try:
        # Where a link leads to, so that the link stays one.
        place = Path(os.path.realpath(out))
        _refuse_what_is_there(out, place, force)
        partial = place.with_name(f".{place.name}.partial")
        new = [one for one in (partial, *partial.parents) if not one.exists()]
        partial.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritable(out, error) from None
    lock = partial / LOCK
    try:
        with hold(lock):
            yield partial
            lock.unlink()
            _put(partial, place, force)
    except OSError as error:
        raise unwritable(out, error) from None
    finally:
        _leave_nothing_empty(lock, new)


def _refuse_what_is_there(out: Path, place: Path, force: bool) -> None:
    another = "give another directory with --out"
    if not place.exists():
        return
    if not place.is_dir():
        raise SettingsError(f"{out}: is a file; {another}")
    here = Path.cwd()
    if os.path.ismount(place) or place in (here, *here.parents):
        raise SettingsError(f"{out}: cannot be replaced as a whole; give one inside it with --out")
    if not any(place.iterdir()):
        return
    if not force:
        raise SettingsError(f"{out}: is there already; --force replaces it, --out names another")
    if not (place / HOW_MADE).is_file():
        raise SettingsError(f"{out}: is no earlier result, so it is not replaced; {another}")


def _put(partial: Path, place: Path, force: bool) -> None:
    """Give a directory its final name, in place of an empty one or, with `force`, of a full one."""
    with suppress(OSError):
        place.rmdir()
    if not (force and place.exists()):
        partial.rename(place)
        return
    old = Path(tempfile.mkdtemp(prefix=f".{place.name}.old-", dir=place.parent))
    try:
        place.rename(old / place.name)
        partial.rename(place)
    except BaseException:
        if not place.exists():
            (old / place.name).rename(place)
        old.rmdir()
        raise
    shutil.rmtree(old, ignore_errors=True)


def _leave_nothing_empty(lock: Path, new: list[Path]) -> None:
    """Take away the directories that were made, from the innermost on, if nothing is in them."""
    with suppress(OSError):
        if [*lock.parent.iterdir()] == [lock]:
            lock.unlink()
        for directory in new:
            directory.rmdir()

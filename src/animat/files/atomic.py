"""Files written whole: under a temporary name first, so that nothing is ever half-written."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import NamedTemporaryFile

from animat.errors import Error
from animat.files.settings import SettingsError

WRONG_PATH = {
    *(errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.EEXIST, errno.ENOTEMPTY),
    *(errno.EACCES, errno.EPERM, errno.EROFS, errno.ENAMETOOLONG, errno.ELOOP, errno.EINVAL),
    *(errno.ENXIO, errno.ESPIPE),
}
"""Errors for which another path is the remedy; after any other the same path will do later."""


class RunError(Error):
    """Something that stops a run and is no mistake of its user; `str` says in a line what."""


def unwritable(path: Path | str, error: OSError) -> SettingsError | RunError:
    """Return what to raise of a path that cannot be written.

    That is SettingsError for a path that will not do, RunError for a disk that is full or fails.
    """
    what = f"{path}: cannot be written: {error.strerror or ' '.join(str(error).split())}"
    return SettingsError(what) if error.errno in WRONG_PATH else RunError(what)


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """Yield a temporary name beside `path`; what is written there takes the name at the end.

    What was at `path` stays as it was if anything goes wrong. Afterwards the file is on the disk
    and not only under way to it: a power cut loses neither its content nor its name.

    Raises:
        SettingsError: the file cannot be written there.
        RunError: the disk is full, or fails.
    """
    if not path.name:
        raise SettingsError(f"{path}: is a directory; give the name of a file")
    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        yield partial
        with partial.open("rb+") as file:
            os.fsync(file.fileno())
        partial.replace(path)
        sync_directory(path.parent)
    except OSError as error:
        raise unwritable(path, error) from None
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
    """Write `content` to `path`, replacing what was there. Raises as `whole` does."""
    with whole(path) as partial:
        partial.write_bytes(content)


def check_writable(path: Path, suffixes: tuple[str, ...], *, force: bool) -> None:
    """Refuse, before any work, a file that could not be written at its end.

    Its name must end in one of `suffixes`; only with `force` may it be there already. Raises
    SettingsError, or RunError where the disk is full or fails.
    """
    if path.suffix.lower() not in suffixes:
        raise SettingsError(f"{path}: give a name that ends in {' or '.join(suffixes)}")
    try:
        if path.is_dir():
            raise SettingsError(f"{path}: is a directory; give the name of a file")
        if path.exists() and not force:
            raise SettingsError(f"{path}: is there already; --force replaces it")
        if not path.parent.is_dir():
            raise SettingsError(f"{path}: there is no directory {path.parent}; make it first")
        # Only writing tells: permissions say nothing of a full or a read-only disk.
        with NamedTemporaryFile(prefix=f".{path.name}.", suffix=".part", dir=path.parent):
            pass
    except OSError as error:
        raise unwritable(path, error) from None

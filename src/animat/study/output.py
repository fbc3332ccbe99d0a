"""Output directories: whole or not at all, and never over another without being asked."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from animat.settings import SettingsError


@contextmanager
def fresh_directory(out: Path, *, force: bool) -> Iterator[Path]:
    """Yield a directory to fill; it takes the name `out` once it is filled without an error.

    Raises SettingsError if `out` is there already and not `force`, is no directory, or cannot be
    made. With `force` the old directory stays until the new one is whole.
    """
    if out.exists() and not out.is_dir():
        raise SettingsError(f"{out}: is a file; give another directory with --out")
    if out.exists() and not force and any(out.iterdir()):
        raise SettingsError(f"{out}: is there already; --force replaces it, --out names another")
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        partial = Path(tempfile.mkdtemp(prefix=f".{out.name}.partial-", dir=out.parent))
    except OSError as error:
        raise SettingsError(f"{out}: cannot be made: {error.strerror}") from None
    try:
        yield partial
        partial.chmod(0o777 & ~_umask())
        if out.exists():
            old = Path(tempfile.mkdtemp(prefix=f".{out.name}.old-", dir=out.parent))
            out.rename(old / out.name)
            partial.rename(out)
            shutil.rmtree(old)
        else:
            partial.rename(out)
    except OSError as error:
        raise SettingsError(
            f"{error.filename or out}: cannot be written: {error.strerror}"
        ) from None
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _umask() -> int:
    """Return the mask of this process; there is no way to read it but to set it."""
    mask = os.umask(0)
    os.umask(mask)
    return mask

"""The studies that come with animat, by name."""

from __future__ import annotations

import re
from pathlib import Path

from animat.files import arguments
from animat.files.atomic import check_writable, write_whole
from animat.files.settings import SettingsError, nearest

LONGEST_NAME = 80

FOLDER = Path(__file__).parent / "data"


def is_name(text: str) -> bool:
    """Tell whether a study may be called so: results go to a directory of its name."""
    return len(text) <= LONGEST_NAME and bool(re.fullmatch(r"\w([\w .-]*\w)?", text))


def shipped(name: str) -> Path:
    """Return the file of a study that comes with animat. Raises SettingsError for no such name."""
    known = {path.stem: path for path in sorted(FOLDER.glob("*.toml"))}
    if name not in known:
        raise SettingsError(f'"{name}": no such study, and no .toml file{nearest(name, known)}')
    return known[name]


def study_file(study: str) -> Path:
    """Return the file of a study, given by its path or, if it comes with animat, by its name.

    Raises SettingsError for what is neither; whether a .toml file is there shows on reading.
    """
    path = arguments.path("study", study)
    is_path = path.suffix == ".toml" or path.parent != Path() or path.is_file()
    return path if is_path else shipped(str(path))


def write_starter(path: Path, *, force: bool) -> None:
    """Write a study to start from, with many comments. Raises SettingsError where it cannot.

    The study is called by the name of the file, if that can be one.
    """
    check_writable(path, (".toml",), force=force)
    text = shipped("starter").read_text("utf-8")
    if is_name(path.stem):
        text = text.replace('name = "starter"     ', f'name = "{path.stem}"'.ljust(21), 1)
    write_whole(path, text.encode())

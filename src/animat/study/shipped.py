"""The studies that come with animat, by name."""

from __future__ import annotations

from pathlib import Path

from animat.settings import SettingsError, nearest

FOLDER = Path(__file__).parent / "files"


def shipped(name: str) -> Path:
    """Return the file of a study that comes with animat. Raises SettingsError for no such name."""
    known = {path.stem: path for path in sorted(FOLDER.glob("*.toml"))}
    if name not in known:
        raise SettingsError(f'"{name}": no such study, and no .toml file{nearest(name, known)}')
    return known[name]


def study_file(study: str) -> Path:
    """Return the file of a study, given by its name or by the path of a .toml file.

    Raises SettingsError for a name that no study has; whether the file is there shows on reading.
    """
    path = Path(study)
    return path if path.suffix == ".toml" or path.parent != Path() else shipped(study)

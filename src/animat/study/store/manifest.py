"""What a results directory says of itself: study, cases, columns, and how all of it was made.

All of this but the list of runs is a function of the study. So what of it is lost or torn is
written anew when the study goes on; who only reads is told what is missing.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import tomllib
from pathlib import Path
from typing import Annotated, Any

import pyarrow as pa
import pyarrow.parquet as pq
from pydantic import BaseModel, Field, PositiveInt

from animat.files.atomic import sync_directory, write_whole
from animat.files.checksummed import read_parquet
from animat.files.provenance import provenance
from animat.files.settings import SettingsError, opened
from animat.life.engine import ENGINE
from animat.study.plan.columns import schema
from animat.study.plan.numbering import KINDS, Kind
from animat.study.plan.plan import Plan
from animat.study.store.differences import differences

STUDY, MANIFEST, CASES = "study.toml", "manifest.json", "cases.parquet"
COLUMNS = "_common_metadata"
"""The file that tells the columns of parts before there is any; Parquet's own name for it."""

INPUTS = "inputs"
FOLDERS = ("lives", "teachers", "curves", "traces", INPUTS)

OTHER_LIVES = (
    "its lives are not those that are lived now of the same study: animat or the version of Python"
    " has changed, or what a custom function computes by"
)
WRITTEN_ANEW = "animat run with the same study writes it anew"

_Count = Annotated[int, Field(ge=0)]
_Pair = Annotated[list[_Count], Field(min_length=2, max_length=2)]


class _Numbering(BaseModel):
    in_a_part: PositiveInt
    places: list[_Pair]


class _Run(BaseModel):
    made: str
    command: str
    versions: dict[str, str]
    machine: dict[str, Any]


class _Manifest(BaseModel):
    """What is in a manifest at least."""

    study: str
    hash: str
    engine: int
    teachers: _Numbering
    lives: _Numbering
    steps_to_learn: _Count
    inputs: dict[str, str]
    runs: Annotated[list[_Run], Field(min_length=1)]


def read_manifest(directory: Path) -> dict[str, Any]:
    """Return the manifest of a results directory. Raises SettingsError where there is none."""
    path = directory / MANIFEST
    try:
        if path.exists() and not path.is_file():
            raise OSError  # reading it might never end
        content = path.read_bytes()
        _Manifest.model_validate_json(content)
        return json.loads(content)
    except OSError:
        if not directory.exists():
            raise SettingsError(f"{directory}: no such directory") from None
        why = f"it has no {MANIFEST}"
    except ValueError:
        why = f"it has no whole {MANIFEST}; without that file, {WRITTEN_ANEW}"
    raise SettingsError(f"{directory}: is no results directory: {why}")


def read_text(directory: Path, manifest: dict[str, Any]) -> str:
    """Return the text of the study. Raises SettingsError where it is not what it was."""
    path = directory / STUDY
    try:
        with opened(path, "study file") as file:
            text = file.read().decode("utf-8")
    except (OSError, ValueError):
        raise _unreadable(path) from None
    if text_hash(text) != manifest["hash"]:
        raise SettingsError(f"{path}: has changed since; {WRITTEN_ANEW}")
    return text


def read_cases(directory: Path) -> pa.Table:
    """Return the table of cases. Raises SettingsError where it cannot be read."""
    path = directory / CASES
    try:
        opened(path, "table").close()
        cases = read_parquet(path)
        cases.validate(full=True)
    except (OSError, ValueError, pa.ArrowException):
        raise _unreadable(path) from None
    if not {"case", "identity", "same_as"} <= set(cases.column_names):
        raise _unreadable(path)
    return cases


def read_columns(directory: Path, kind: Kind) -> pa.Schema:
    """Return the columns of the lives, or of the robots that teach, none where nobody teaches.

    Raises SettingsError where they cannot be read.
    """
    path = directory / kind / COLUMNS
    try:
        opened(path, "table").close()
        return pq.read_schema(path)
    except (OSError, ValueError, pa.ArrowException):
        if kind == "teachers" and not path.parent.exists():
            return pa.schema([])
        raise _unreadable(path) from None


def begin(directory: Path, plan: Plan) -> None:
    """Say what a directory is for, or see that it is for this study, and that one more run begins.

    Raises:
        SettingsError: it is for something else, and is left as it is.
        OSError: it cannot be written.
    """
    found = differences_from(directory, plan) if _is_begun(directory) else []
    if found:
        raise SettingsError(
            *(f"{directory}: {line}" for line in found),
            f"{directory}: is left as it is; --out gives this study a directory of its own",
        )
    if (directory / MANIFEST).exists():
        manifest = read_manifest(directory)
    else:
        manifest = {
            "study": plan.study.name,
            "hash": text_hash(plan.text),
            "engine": ENGINE,
            **{kind: plan.numbering[kind].written() for kind in KINDS},
            "steps_to_learn": plan.steps_to_learn,
            "inputs": _inputs(plan),
            "runs": [],
        }
    _describe(directory, plan)
    manifest["runs"].append(provenance())
    write_whole(directory / MANIFEST, (json.dumps(manifest, indent=2) + "\n").encode())


def differences_from(directory: Path, plan: Plan) -> list[str]:
    """Return a line for everything in which a study is not the one of a results directory.

    Raises SettingsError where it is none.
    """
    if not (directory / MANIFEST).exists():
        return _differences_of_texts(_text_there(directory), plan.text)
    manifest = read_manifest(directory)
    if manifest["engine"] != ENGINE:
        return [f"was lived by engine {manifest['engine']}, and this is engine {ENGINE}"]
    if manifest["hash"] != text_hash(plan.text):
        there = _text_there(directory)
        was = there if there and text_hash(there) == manifest["hash"] else None
        return _differences_of_texts(was, plan.text)
    if changed := changed_inputs(directory, manifest):
        return changed
    try:
        identities = read_cases(directory)["identity"].to_pylist()
    except SettingsError:
        # Lost; every part says for itself which lives it holds.
        identities = plan.identities
    numbered = {kind: plan.numbering[kind].written() for kind in KINDS}
    if identities != plan.identities or any(manifest[kind] != numbered[kind] for kind in KINDS):
        return [OTHER_LIVES]
    return []


def changed_inputs(directory: Path, manifest: dict[str, Any]) -> list[str]:
    """Return a line for every file of the user's that is not any more as it was."""
    lines = []
    for path, content in manifest["inputs"].items():
        there = Path(path).is_file()
        if not there or file_hash(Path(path)) != content:
            what = "has changed since" if there else "is not there any more"
            if not there and not Path(path).is_absolute():
                what += f" (looked for in {Path.cwd()})"
            lines.append(f"{path} {what}; as it was it is in {directory / INPUTS}")
    return lines


def file_hash(path: Path) -> str:
    """Return the hash of what a file holds."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def place_of_copy(path: str) -> Path:
    """Return where in a results directory the copy of a file of the user's is.

    Files keep their places to one another, so that a study can be run again in `inputs/`: those
    named from the folder that the program ran in as they are, the others below `outside/`.
    """
    plain = Path(os.path.normpath(path))
    if plain.is_absolute() or plain.parts[0] == "..":
        plain = Path(os.path.abspath(plain))  # noqa: PTH100
        plain = Path("outside", *plain.parts[1:])
    return Path(INPUTS) / plain


def text_hash(text: str) -> str:
    """Return the hash by which a study is known."""
    return hashlib.sha256(text.encode()).hexdigest()


def _is_begun(directory: Path) -> bool:
    """Tell whether there is a manifest, or lives that have lost theirs."""
    return (directory / MANIFEST).exists() or any(directory.glob("*/part-*.parquet"))


def _differences_of_texts(there: str | None, here: str) -> list[str]:
    if there is None:
        return [f"holds a study, and {STUDY} does not tell any more which it was"]
    if there == here:
        return []
    found = differences(tomllib.loads(there), tomllib.loads(here))
    return found or ["has its factors in another order"]


def _text_there(directory: Path) -> str | None:
    """Return the text of the study that a directory is said to hold; None if it is no study."""
    try:
        text = (directory / STUDY).read_text("utf-8")
        tomllib.loads(text)
    except (OSError, ValueError):
        return None
    return text


def _describe(directory: Path, plan: Plan) -> None:
    """Write whatever tells of the study, but what is there already."""
    for folder in _folders(plan):
        (directory / folder).mkdir(exist_ok=True)
    sync_directory(directory)
    for path in sorted(plan.inputs):
        copy = directory / place_of_copy(path)
        copy.parent.mkdir(parents=True, exist_ok=True)
        _see_to_it(copy, Path(path).read_bytes())
    _see_to_it(directory / STUDY, plan.text.encode())
    cases = io.BytesIO()
    pq.write_table(plan.case_table(), cases)
    _see_to_it(directory / CASES, cases.getvalue())
    for kind in KINDS:
        if kind in _folders(plan):
            columns = io.BytesIO()
            pq.write_metadata(schema(plan, kind), columns)
            _see_to_it(directory / kind / COLUMNS, columns.getvalue())


def _folders(plan: Plan) -> list[str]:
    """Return the folders that the results of a study need."""
    needed = {
        "lives": True,
        "teachers": bool(plan.classes),
        "curves": "learning_curve" in plan.study.measures,
        "traces": plan.study.record is not None,
        INPUTS: bool(plan.inputs),
    }
    return [folder for folder in FOLDERS if needed[folder]]


def _inputs(plan: Plan) -> dict[str, str]:
    """Return the files a study draws on beside its own, each with the hash of what it holds."""
    return {path: file_hash(Path(path)) for path in sorted(plan.inputs)}


def _see_to_it(path: Path, content: bytes) -> None:
    """Write a file, unless that is what it holds."""
    if not path.is_file() or path.read_bytes() != content:
        write_whole(path, content)


def _unreadable(path: Path) -> SettingsError:
    return SettingsError(f"{path}: is missing or torn; {WRITTEN_ANEW}")

"""A study run from Python, as `animat run` does on the command line.

done = animat.run("lifespan.toml")
done.to_pandas()
done.report()
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
from pydantic import BaseModel

from animat.files.settings import SettingsError
from animat.files.validation_errors import plain, written
from animat.progress import Telling, telling
from animat.study.execute.run import run as live
from animat.study.execute.run import threads as workers_of
from animat.study.file.builtin import study_file
from animat.study.file.read import read_study, study_of
from animat.study.file.study import Study
from animat.study.plan.plan import plan_of
from animat.study.plan.preflight import check_livable
from animat.study.store.manifest import MANIFEST
from animat.study.store.results import Results

if TYPE_CHECKING:
    import pandas as pd

TOML = (str, int, float, bool, type(None))

Progress = Callable[[str, int, int], None]
"""Called with a task, how many are done of it, and how many there are."""


@dataclass(frozen=True)
class StudyRun:
    """A study that was run: its results, and how many of its lives failed."""

    results: Results
    failed: int

    @property
    def directory(self) -> Path:
        """Where the results are."""
        return self.results.directory

    @property
    def lives(self) -> pa.Table:
        """The lives with the factors of their cases, a row each."""
        return self.results.lives()

    def to_pandas(self) -> pd.DataFrame:
        """Return the lives as a pandas table; needs pandas (`pip install animat[pandas]`).

        Raises SettingsError without it.
        """
        return self.results.to_pandas()

    def report(self, out: Path | str | None = None) -> Path:
        """Write the page on the study, DIRECTORY/report.html unless given, and return its path.

        Raises SettingsError where it cannot be written.
        """
        from animat.report.study_page import write_report

        path, _ = write_report(
            self.results, None if out is None else Path(out), None, lambda *_, **__: None
        )
        return path


def run(
    study: str | Path | Mapping[str, Any] | Study,
    out: Path | str | None = None,
    *,
    threads: int | None = None,
    progress: Progress | bool = True,
) -> StudyRun:
    """Run a study, or what its results directory still lacks, and return its results.

    `study` is a file, the name of a study that comes with animat, what such a file says as a dict,
    or a Study. Results go to `out`, results/NAME unless given; the same call resumes there.
    `progress` is True for bars in a terminal or notebook and lines elsewhere, False for nothing, or
    a function, called with a task, how many are done of it, and how many there are. Ctrl-C once
    finishes the parts that are under way, twice stops at once.

    Raises:
        SettingsError: the study or the directory is no good, with a line for each mistake.
        RunError: the directory is held by another process, or cannot be written any more.
        KeyboardInterrupt: it was interrupted; what is finished is in the directory.
    """
    _check(out, threads, progress)
    plan = plan_of(_study(study).to_toml())
    directory = Path("results") / plan.study.name if out is None else Path(out)
    with _told(progress) as tell, workers_of(threads) as workers:
        if not (directory / MANIFEST).exists():
            check_livable(plan)
        outcome = live(plan, directory, workers, tell)
    lives = outcome.tally.counts["lives"]
    if not outcome.complete:
        raise KeyboardInterrupt(
            f"{lives.rows:,} of {plan.numbering['lives'].total:,} lives are in {directory};"
            " the same call resumes"
        )
    return StudyRun(Results(directory), lives.failed)


def _check(out: Any, threads: Any, progress: Any) -> None:
    problems = []
    if not isinstance(out, str | Path | None):
        problems.append(f"out is of type {type(out).__name__}; allowed is the path of a directory")
    if threads is not None and not (isinstance(threads, int | np.integer) and threads >= 1):
        problems.append(f"threads = {plain(threads)}; allowed are whole numbers from 1")
    if not (isinstance(progress, bool) or callable(progress)):
        problems.append(
            f"progress = {plain(progress)}; allowed are True, False and a function of three"
        )
    if problems:
        raise SettingsError(*problems)


def _study(study: Any) -> Study:
    if isinstance(study, Study):
        return study
    if isinstance(study, str | Path):
        return read_study(study_file(str(study)))
    if isinstance(study, Mapping):
        problems: list[str] = []
        data = _as_toml(study, (), problems)
        if problems:
            raise SettingsError(*problems)
        return study_of(data, "study")
    raise SettingsError(
        f"study is of type {type(study).__name__}; allowed are a path, a name, a dict and a Study"
    )


def _as_toml(value: Any, key: tuple[str | int, ...], problems: list[str]) -> Any:
    """Return a value as TOML would have it; NumPy's numbers and paths are taken for what they say.

    Of what has no place in a study file a line is added to `problems`.
    """
    if isinstance(value, BaseModel):
        return value.model_dump(mode="json", exclude_unset=True)
    if isinstance(value, Mapping):
        return {str(k): _as_toml(each, (*key, str(k)), problems) for k, each in value.items()}
    if isinstance(value, list | tuple):
        return [_as_toml(each, (*key, n), problems) for n, each in enumerate(value)]
    if isinstance(value, np.ndarray | np.generic):
        return _as_toml(value.tolist(), key, problems)
    if isinstance(value, Path):
        return str(value)
    if not isinstance(value, TOML):
        what = "a function; give it as FILE.py:NAME" if callable(value) else "nothing for a study"
        problems.append(f"study: key {written(key)}: {type(value).__name__} is {what}")
    return value


@contextmanager
def _told(progress: Progress | bool) -> Iterator[Telling]:
    """Yield what the run reports to."""
    if progress is True:
        with telling() as tell:
            yield tell
    elif callable(progress):
        so_far: dict[str, int] = {}

        def pass_on(task: str, done: int, total: int, note: str = "") -> None:
            so_far[task] = so_far.get(task, 0) + done
            progress(task, so_far[task], total)

        yield pass_on
    else:
        yield lambda *_, **__: None

"""A study run from Python, as `animat run` does on the command line.

done = animat.run("lifespan.toml")
done.to_pandas()
done.report()
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
from pydantic import BaseModel

from animat.files import arguments
from animat.files.arguments import DEEPEST, MOST_THREADS, as_python, number, together, whole
from animat.files.settings import SettingsError
from animat.files.validation_errors import plain, written
from animat.progress import Telling, telling
from animat.study.execute.run import run as live
from animat.study.execute.run import threads as workers_of
from animat.study.file.builtin import study_file
from animat.study.file.read import read_study, study_of
from animat.study.file.study import Study
from animat.study.plan.plan import forget, plan_of
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

        where = None if out is None else arguments.file("out", out)
        path, _ = write_report(self.results, where, None, lambda *_, **__: None)
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
    directory, threads, progress = together(
        SettingsError,
        lambda: out if out is None else arguments.path("out", out),
        lambda: threads if threads is None else whole("threads", threads, 1, MOST_THREADS),
        lambda: _progress(progress),
    )
    forget()  # files may have changed since the last run in this process
    plan = plan_of(_study(study).to_toml())
    directory = directory or Path("results") / plan.study.name
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


def _progress(progress: Any) -> Any:
    """Return what is to be told of progress. Raises SettingsError for what cannot be."""
    found = number(progress)
    if isinstance(found, bool):
        return found
    if callable(progress) and _takes_three(progress):
        return progress
    raise SettingsError(
        f"progress = {plain(progress)}; allowed are True, False and a function of three"
    )


def _takes_three(function: Any) -> bool:
    """Tell whether a function can be called as progress is told; a class is none."""
    try:
        signature(function).bind("", 0, 0)
    except TypeError:
        return False
    except ValueError:  # some of Python's own do not tell
        pass
    return not isinstance(function, type)


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
        value = value.model_dump(exclude_unset=True)
    elif isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, Mapping | list | tuple) and len(key) > DEEPEST:
        problems.append(f"study is nested too deeply: more than {DEEPEST} levels")
    elif isinstance(value, Mapping):
        strange = [type(k).__name__ for k in value if not isinstance(k, TOML)]
        problems += [f"study: key {written(key)}: a key of it is a {name}" for name in strange]
        keys = [k for k in value if isinstance(k, TOML)]
        return {str(k): _as_toml(value[k], (*key, str(k)), problems) for k in keys}
    elif isinstance(value, list | tuple):
        return [_as_toml(each, (*key, n), problems) for n, each in enumerate(value)]
    elif isinstance(value, Path):
        return str(value)
    elif not isinstance(value := as_python(value), TOML):
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

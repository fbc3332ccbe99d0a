"""One small multiverse, lived, analysed and published once, for all tests of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest

if TYPE_CHECKING:
    from animat.experiments.multiverse import Multiverse
    from animat.study.file.study import Study

SMALL = (
    "lives=3",
    "steps=600",
    "teacher.robots=2",
    "teacher.steps=900",
    "design.sample.points=32",
)


class Lived(NamedTuple):
    """A multiverse, where it was lived, and what was told meanwhile."""

    found: Multiverse
    directory: Path
    told: list[tuple[str, int, int]]


def small_study() -> Study:
    """The study that is lived."""
    from animat.study.file.builtin import shipped
    from animat.study.file.read import read_study

    return read_study(shipped("multiverse"), SMALL)


@pytest.fixture(scope="session")
def lived(tmp_path_factory: pytest.TempPathFactory) -> Lived:
    # The process that only starts the workers of pytest does without these.
    from animat.experiments.multiverse import Size, run_multiverse
    from animat.report.multiverse_page import publish
    from animat.study.execute.run import threads

    directory = tmp_path_factory.mktemp("multiverse")
    told: list[tuple[str, int, int]] = []

    def tell(task: str, done: int, total: int, note: str = "") -> None:
        told.append((task, done, total))

    size = Size(confirming=4, longer=4, late=1_200)
    with threads(2) as workers:
        found = run_multiverse(small_study(), directory, size, workers, tell, full=False)
    publish(found, directory, "animat multiverse", lambda: tell("Figures and page", 1, 7))
    return Lived(found, directory, told)

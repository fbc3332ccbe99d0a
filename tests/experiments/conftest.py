"""Studies of small multiverses, and one that was lived, analysed and published."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest

from animat.experiments.multiverse import Multiverse, Size, run_multiverse
from animat.report.multiverse_page import publish
from animat.study.execute.run import threads
from animat.study.file.builtin import shipped
from animat.study.file.read import read_study
from animat.study.file.study import Study

from ..study.conftest import faults  # noqa: F401

SMALL = (
    "lives=3",
    "steps=600",
    "teacher.robots=2",
    "teacher.steps=900",
    "design.sample.points=32",
)

SIZE = Size(confirming=4, longer=4, late=1_200)


class Lived(NamedTuple):
    """A multiverse, where it was lived, and what was told meanwhile."""

    found: Multiverse
    directory: Path
    told: list[tuple[str, int, int]]


def small_study(*changes: str) -> Study:
    return read_study(shipped("multiverse"), [*SMALL, *changes])


@pytest.fixture(scope="session")
def small() -> Study:
    return small_study()


@pytest.fixture(scope="session")
def lived(small, tmp_path_factory) -> Lived:
    directory = tmp_path_factory.mktemp("multiverse")
    told: list[tuple[str, int, int]] = []

    def tell(task: str, done: int, total: int, note: str = "") -> None:
        told.append((task, done, total))

    with threads(2) as workers:
        found = run_multiverse(small, directory, SIZE, workers, tell, full=False)
    publish(found, directory, "animat multiverse", lambda: tell("Figures and page", 1, 7))
    return Lived(found, directory, told)

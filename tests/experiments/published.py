"""One small reproduction, run and published once, for all tests of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest

if TYPE_CHECKING:
    from animat.experiments.reproduction import Reproduction

Told = list[tuple[str, int, int]]


class Published(NamedTuple):
    """A reproduction, where it was published, and what was told meanwhile."""

    result: Reproduction
    directory: Path
    told: Told


@pytest.fixture(scope="session")
def published(tmp_path_factory: pytest.TempPathFactory) -> Published:
    # The process that only starts the workers of pytest does without these.
    from animat.experiments.reproduction import Size, reproduce
    from animat.report.reproduction_page import publish
    from animat.study.file.settings import LifeSettings

    directory = tmp_path_factory.mktemp("reproduction")
    told: Told = []

    def tell(task: str, done: int, total: int, note: str = "") -> None:
        told.append((task, done, total))

    size = Size(robots=4, lives=24, steps=3_000)
    result = reproduce(LifeSettings(), seed=1, size=size, directory=directory, tell=tell)
    publish(result, directory, lambda: tell("Pages", 1, 8))
    return Published(result, directory, told)


@pytest.fixture(scope="session")
def reproduced(published: Published) -> Reproduction:
    return published.result

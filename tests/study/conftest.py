"""One small reproduction, run and published once, for all tests of studies."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from animat.experiments.reproduction import Reproduction, Size, reproduce
from animat.report.reproduction_page import publish
from animat.study.execute.run import run, threads
from animat.study.file.settings import LifeSettings
from animat.study.plan.plan import Plan

Told = list[tuple[str, int, int]]


class Published(NamedTuple):
    """A reproduction, where it was published, and what was told meanwhile."""

    result: Reproduction
    directory: Path
    told: Told


@pytest.fixture(scope="session")
def published(tmp_path_factory: pytest.TempPathFactory) -> Published:
    directory = tmp_path_factory.mktemp("reproduction")
    told: Told = []

    def tell(task: str, done: int, total: int, note: str = "") -> None:
        told.append((task, done, total))

    size = Size(robots=4, lives=24, steps=3_000)
    result = reproduce(LifeSettings(), seed=1, size=size, directory=directory, tell=tell)
    publish(result, directory, lambda: tell("Pages", 1, 8))
    return Published(result, directory, told)


@pytest.fixture(scope="session")
def faults() -> Any:
    """The driver that breaks off runs, as a module."""
    file = Path(__file__).with_name("faults.py")
    spec = importlib.util.spec_from_file_location("faults", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def small(faults: Any) -> Plan:
    """The plan of a study that writes files of every kind, and few of them."""
    return faults.plan(faults.SMALL)


@pytest.fixture(scope="session")
def finished(small: Plan, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of the small study; copy them to change them."""
    directory = tmp_path_factory.mktemp("small") / "results"
    with threads(2) as workers:
        assert run(small, directory, workers, lambda *_, **__: None).complete
    return directory


@pytest.fixture(scope="session")
def reproduced(published: Published) -> Reproduction:
    return published.result

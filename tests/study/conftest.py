"""A small study, run once, and the driver that breaks off runs, for all tests of studies."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest

from animat.study.execute.run import run, threads
from animat.study.plan.plan import Plan


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

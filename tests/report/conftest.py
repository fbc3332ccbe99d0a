"""The fixtures of the tests of reports: tables with a known answer, and a study."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from animat.study.store.results import Results
from animat.study.store.results import open as open_results

from ..statistics.tables import likelihoods_table, lives_table, paper_table  # noqa: F401
from .small import FOUR, ran


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    """The results of a study of four cases."""
    return ran(FOUR, tmp_path_factory.mktemp("four"))


@pytest.fixture
def copied(results: Results, tmp_path: Path) -> Callable[..., Results]:
    """The same once more, of which the last `without` parts are not lived yet."""

    def copied(without: int = 0) -> Results:
        directory = tmp_path / "four"
        shutil.copytree(results.directory, directory)
        for part in sorted((directory / "lives").glob("part-*.parquet"))[::-1][:without]:
            part.unlink()
        return open_results(directory)

    return copied

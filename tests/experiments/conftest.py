"""The study of a small multiverse, and the driver that breaks off runs."""

from __future__ import annotations

import pytest

from animat.study.file.study import Study

from ..study.conftest import faults  # noqa: F401
from .lived import small_study


@pytest.fixture(scope="session")
def small() -> Study:
    return small_study()

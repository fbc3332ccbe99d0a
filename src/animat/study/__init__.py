"""Studies: the file that describes one, its cases, and the experiments of the paper.

    study = animat.study.read_study("lifespan.toml")
    for case in animat.study.cases(study):
        print(case.number, case.factors)
    results = animat.study.open("results/lifespan")

Everything public is named here and loaded when it is first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from animat.study.file.builtin import study_file
    from animat.study.file.cases import Case, Excluded, cases, excluded
    from animat.study.file.design import Design
    from animat.study.file.read import read_study
    from animat.study.file.settings import CaseSettings, LifeSettings, Teacher, WorldChoice
    from animat.study.file.study import Study
    from animat.study.store.results import Results
    from animat.study.store.results import open as open  # noqa: A004

_HOMES = {
    "Case": "animat.study.file.cases",
    "CaseSettings": "animat.study.file.settings",
    "Design": "animat.study.file.design",
    "Excluded": "animat.study.file.cases",
    "LifeSettings": "animat.study.file.settings",
    "Results": "animat.study.store.results",
    "Study": "animat.study.file.study",
    "Teacher": "animat.study.file.settings",
    "WorldChoice": "animat.study.file.settings",
    "cases": "animat.study.file.cases",
    "excluded": "animat.study.file.cases",
    "open": "animat.study.store.results",
    "read_study": "animat.study.file.read",
    "study_file": "animat.study.file.builtin",
}

__all__ = [
    "Case",
    "CaseSettings",
    "Design",
    "Excluded",
    "LifeSettings",
    "Results",
    "Study",
    "Teacher",
    "WorldChoice",
    "cases",
    "excluded",
    "open",
    "read_study",
    "study_file",
]


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module 'animat.study' has no attribute '{name}'")
    return getattr(importlib.import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """Return the public names."""
    return __all__

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
    from animat.study.design import Case, Design, Excluded, cases, excluded
    from animat.study.results import Results
    from animat.study.results import open as open  # noqa: A004
    from animat.study.settings import CaseSettings, LifeSettings, Teacher, WorldChoice
    from animat.study.shipped import study_file
    from animat.study.study import Study, read_study

_HOMES = {
    "Case": "animat.study.design",
    "CaseSettings": "animat.study.settings",
    "Design": "animat.study.design",
    "Excluded": "animat.study.design",
    "LifeSettings": "animat.study.settings",
    "Results": "animat.study.results",
    "Study": "animat.study.study",
    "Teacher": "animat.study.settings",
    "WorldChoice": "animat.study.settings",
    "cases": "animat.study.design",
    "excluded": "animat.study.design",
    "open": "animat.study.results",
    "read_study": "animat.study.study",
    "study_file": "animat.study.shipped",
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

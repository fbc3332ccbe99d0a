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
    from animat.study.design.design import Case, Design, Excluded, cases, excluded
    from animat.study.design.settings import CaseSettings, LifeSettings, Teacher, WorldChoice
    from animat.study.design.shipped import study_file
    from animat.study.design.study import Study, read_study
    from animat.study.store.results import Results
    from animat.study.store.results import open as open  # noqa: A004

_HOMES = {
    "Case": "animat.study.design.design",
    "CaseSettings": "animat.study.design.settings",
    "Design": "animat.study.design.design",
    "Excluded": "animat.study.design.design",
    "LifeSettings": "animat.study.design.settings",
    "Results": "animat.study.store.results",
    "Study": "animat.study.design.study",
    "Teacher": "animat.study.design.settings",
    "WorldChoice": "animat.study.design.settings",
    "cases": "animat.study.design.design",
    "excluded": "animat.study.design.design",
    "open": "animat.study.store.results",
    "read_study": "animat.study.design.study",
    "study_file": "animat.study.design.shipped",
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

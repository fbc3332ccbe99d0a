"""Small studies, read from text and run, for the tests of the report."""

from __future__ import annotations

from pathlib import Path

from animat.study.execute.run import run, threads
from animat.study.file.read import read_study
from animat.study.file.study import Study
from animat.study.plan.plan import Plan
from animat.study.store.results import Results
from animat.study.store.results import open as open_results

FOUR = """
name = "four"
seed = 3
lives = 25
steps = 3_000
measures = ["likelihoods"]
[teacher]
robots = 3
steps = 1_500
[design.grid]
"world.layout" = ["abundant", "scarce"]
"mind.agent" = ["BLIND", "AF"]
"""

FAILING = """
name = "failing"
lives = 12
steps = 4_000
[mind]
agent = "RANDOM"
[mind.drives]
hunger = { a = { nutrition = 4e305 } }
fatigue = { a = { stamina = 1.0 } }
curiosity = { a = { restlessness = 1.0 } }
[design.grid]
"mind.gate" = ["positive", "always"]
"""
"""Lives longer than some 1,000 steps fail: the sum of their drives passes every number."""


def study_of(text: str, directory: Path) -> Study:
    file = directory / "study.toml"
    file.write_text(text)
    return read_study(file)


def ran(text: str, directory: Path) -> Results:
    """The results of a study."""
    plan = Plan(study_of(text, directory))
    out = directory / plan.study.name
    with threads(2) as workers:
        run(plan, out, workers, lambda *_: None)
    return open_results(out)

"""Robots lent from one study to another are the robots that would have been lived."""

from __future__ import annotations

import pytest

from animat.study.execute.reuse import borrowed
from animat.study.execute.shard import live_part
from animat.study.plan.numbering import Part
from animat.study.store.results import Results

FIRST = """
name = "first"
lives = 12
steps = 700
measures = ["likelihoods"]
[mind]
agent = "LEARNING"
"""

SECOND = """
name = "second"
lives = 4
steps = 20
[mind]
agent = "AF"
[teacher]
robots = 10
steps = 700
"""

PARTS = [Part("teachers", 0), Part("teachers", 1)]


@pytest.fixture(scope="module")
def lender(faults, tmp_path_factory):
    directory = tmp_path_factory.mktemp("lender") / "results"
    faults.go_on(faults.plan(FIRST), directory)
    return Results(directory)


def test_they_are_those_that_would_have_been_lived(faults, lender):
    plan = faults.plan(SECOND)
    for part in PARTS:
        assert borrowed(plan, part, lender) == live_part(plan.text, part, {})


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("steps = 700", "steps = 701"),
        ("robots = 10", "robots = 13"),
        ('agent = "AF"', 'agent = "AF"\nlearning = { cycles = 3 }'),
        ("lives = 4", "lives = 4\nseed = 1"),
        ("lives = 4", 'lives = 4\nmeasures = ["learning_curve"]'),
    ],
)
def test_others_are_not_lent(faults, lender, old, new):
    plan = faults.plan(SECOND.replace(old, new))
    assert borrowed(plan, PARTS[1], lender) is None


def test_lives_are_not_lent_and_those_that_told_too_little_neither(faults, lender, tmp_path):
    plan = faults.plan(SECOND)
    assert borrowed(plan, Part("lives", 0), lender) is None
    faults.go_on(faults.plan(FIRST.replace('["likelihoods"]', "[]")), tmp_path)
    assert borrowed(plan, PARTS[0], Results(tmp_path)) is None


def test_what_is_not_finished_is_not_lent(faults, tmp_path):
    faults.go_on(faults.plan(FIRST), tmp_path)
    (tmp_path / "lives" / "part-000001.parquet").unlink()
    plan = faults.plan(SECOND)
    assert borrowed(plan, PARTS[0], Results(tmp_path)) is not None
    assert borrowed(plan, PARTS[1], Results(tmp_path)) is None

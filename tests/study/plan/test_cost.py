"""What a study is said to cost, held against what it then costs."""

from __future__ import annotations

import tomllib
from itertools import count
from types import SimpleNamespace

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.files.settings import validated
from animat.life.lives import live_many
from animat.mind.mind import Mind
from animat.study.file.study import Study
from animat.study.plan import cost as module
from animat.study.plan.cost import STEPS, Measured, Range, expect
from animat.study.plan.plan import Plan
from animat.world.world import World


def plan_of(text: str) -> Plan:
    return Plan(validated({"name": "x", **tomllib.loads(text)}, Study))


def measured(lifespans: list[int], cap: int) -> Measured:
    steps = np.minimum(lifespans, cap)
    table = pa.table({"lifespan": steps, "censored": np.array(lifespans) > cap})
    return Measured(table, cap, 1.0, [None] * len(steps))


@given(st.lists(st.integers(1, 200), min_size=1), st.integers(1, 100), st.integers(0, 300))
def test_a_mean_lifespan_lies_between_what_was_seen_and_the_cap(lifespans, cap, more):
    seen = measured(lifespans, cap)
    low, high = seen.mean_lifespan(cap + more)
    assert np.minimum(lifespans, cap).mean() <= low <= high * (1 + 1e-12)
    assert high <= cap + more
    assert high == pytest.approx(np.where(np.array(lifespans) > cap, cap + more, lifespans).mean())


def test_what_no_step_has_killed_lives_to_the_cap():
    assert measured([500, 500], 100).mean_lifespan(300) == Range(300.0, 300.0)
    assert measured([50, 50], 100).mean_lifespan(300) == Range(50.0, 50.0)


def test_a_life_that_fails_lives_no_longer():
    seen = measured([500, 50], 100)._replace(errors=["it raises", None])
    assert seen.mean_lifespan(300) == Range(75.0, 75.0)


def test_lives_that_die_at_a_constant_rate_are_foretold():
    lifespans = np.random.default_rng(0).geometric(1e-3, 20_000)
    low, high = measured(lifespans.tolist(), 1_000).mean_lifespan(5_000)
    assert low == pytest.approx(np.minimum(lifespans, 5_000).mean(), rel=0.05)
    assert high > low


def test_those_who_die_early_do_not_foretell_the_others():
    late = np.random.default_rng(0).geometric(1e-4, 20_000)
    lifespans = np.concatenate((np.full(20_000, 10), 500 + late))
    low, _ = measured(lifespans.tolist(), 1_000).mean_lifespan(20_000)
    assert low == pytest.approx(np.minimum(lifespans, 20_000).mean(), rel=0.05)


STUDY = """
lives = 30
steps = 2_000
[mind]
physiology = "linear"
[teacher]
robots = 3
steps = 500
[record]
what = "every:2"
lives = 4
[design.grid]
"mind.agent" = ["BLIND", "AF", "ORACLE"]
"mind.learning.rate" = [0.5, 0.25]
"""


@pytest.fixture(autouse=True)
def clock(monkeypatch):
    """Let a second pass between every two looks at the clock."""
    monkeypatch.setattr(module, "time", SimpleNamespace(perf_counter=count().__next__))


def test_what_can_be_counted_is_counted():
    plan = plan_of(STUDY)
    expected = expect(plan)
    lived = 4  # the rate of learning is read for no life of BLIND or ORACLE
    assert expected.lives == lived * 30
    assert expected.most_steps == lived * 30 * 2_000
    assert (expected.robots, expected.learning_steps) == (2 * 3, 2 * 3 * 500)
    assert expected.measured_cases == lived
    assert expected.seconds.low == expected.seconds.high > 0.0
    assert STEPS > 2_000


def test_rows_of_a_trace_are_those_of_the_steps_recorded():
    def room(what: str, lives: int = 1) -> Range:
        text = f'steps = 40_000\n[mind]\ndeath = false\n[record]\nwhat = "{what}"\nlives = {lives}'
        return expect(plan_of(text)).trace_bytes

    every = room("all")
    assert every.low == every.high
    assert room("every:10").low == pytest.approx(every.low / 10)
    assert room("last:500").low == pytest.approx(every.low / 80)
    assert room("last:500", 7).low == pytest.approx(7 * every.low / 80)
    assert expect(plan_of("steps = 10")).trace_bytes == Range(0.0, 0.0)


def test_the_mean_lifespan_is_near_that_of_the_lives_then_lived():
    """At the rate of the lives that were measured, in the second that they took."""
    plan = plan_of('lives = 1_000\nsteps = 20_000\n[mind]\nphysiology = "linear"')
    expected = expect(plan)
    lives = live_many(Mind(physiology="linear"), World.abundant(), lives=expected.measured_lives)
    steps = np.minimum(lives.table["lifespan"].to_numpy(), STEPS)
    assert expected.most_steps == 1_000 * 20_000
    assert steps.mean() * 1_000 / expected.seconds.low == pytest.approx(steps.sum())


@pytest.mark.parametrize("turn", [1, 5])
def test_lives_that_fail_are_told_of(tmp_path, turn, lost):
    own = tmp_path / "own.py"
    own.write_text(lost)
    mind = f'[mind]\nwander = "{own}:walk"\nturn_speed = {turn}\n'
    expected = expect(plan_of(f'steps = 500\n{mind}[record]\nwhat = "all"'))
    assert 0 < len(expected.errors) <= expected.measured_lives
    assert (len(expected.errors) == expected.measured_lives) == (turn == 1)
    assert all(
        error.startswith("wander: walk raised ValueError: lost, in step")
        for error in expected.errors
    )

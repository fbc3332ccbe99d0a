"""What a study would cost, from a handful of short lives of a few of its cases."""

from __future__ import annotations

import math
import os
import time
from io import BytesIO
from typing import NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from animat.life.batch import Batch
from animat.life.failure import FailedLifeError
from animat.life.life import Moment, TraceChoice, lived
from animat.life.lives import CHUNK
from animat.life.scenario import Setting, bring_together
from animat.life.summary import summary
from animat.life.trace import table
from animat.numerics.threads import KernelThreads
from animat.study.plan.plan import Plan, world_of

CASES = 6
"""Cases that are measured, spread over the design."""

STEPS = 20_000
"""Steps a life is measured for at most."""

TRACED = 1_000
"""Steps of the trace that is measured."""


class Range(NamedTuple):
    """What is expected: at least, if lives go on ending as they do, and at most, if none does."""

    low: float
    high: float

    def __mul__(self, factor: float) -> Range:
        """Return both times a factor."""
        return Range(self.low * factor, self.high * factor)


class Expectation(NamedTuple):
    """What a study would cost: steps, seconds and bytes; equal lives are lived once.

    `learning_steps` are those of the `robots` whose networks AF has. `measured_lives` of
    `measured_cases` cases gave the speed of all cores, how long lives are, and the room of a row;
    `errors` are those of them that failed.
    """

    lives: int
    most_steps: int
    robots: int
    learning_steps: int
    seconds: Range
    tables_bytes: float
    trace_bytes: Range
    measured_lives: int
    measured_cases: int
    errors: list[str]


class Measured(NamedTuple):
    """Some lives of a case: their table, the steps they were measured for, and the seconds.

    `errors`, an entry for each life, are None for those that did not fail.
    """

    table: pa.Table
    cap: int
    seconds: float
    errors: list[str | None]

    @property
    def steps(self) -> int:
        """Steps lived."""
        return int(self.table["lifespan"].to_numpy().sum())

    def mean_lifespan(self, cap: int) -> Range:
        """Return the mean lifespan up to `cap`.

        At least, if later steps are as deadly as those of the second half, which are less deadly
        than the first; at most, if whoever was still alive lives up to the cap. A life that fails
        ends there.
        """
        lifespans = self.table["lifespan"].to_numpy()
        dead = ~self.table["censored"].to_numpy() | np.array(self.errors, bool)
        half = self.cap // 2
        hazard = int((dead & (lifespans > half)).sum()) / max((lifespans - half).clip(0).sum(), 1)
        left = float(cap - self.cap)
        further = -math.expm1(-hazard * left) / hazard if hazard else left
        mean, alive = float(lifespans.mean()), float((~dead).mean())
        return Range(mean + alive * further, mean + alive * left)


def expect(plan: Plan) -> Expectation:
    """Return what a study would cost. Raises SettingsError for what cannot be lived."""
    study = plan.study
    places = sorted({round(place) for place in np.linspace(0, len(plan.lived) - 1, CASES)})
    measured = [_measure(plan, place) for place in places]
    # All may fail in their first step.
    speed = max(1, sum(one.steps for one in measured)) / sum(one.seconds for one in measured)
    means = [
        one.mean_lifespan(plan.lived[place].steps)
        for one, place in zip(measured, places, strict=True)
    ]
    mean = Range(*(sum(ends) / len(means) for ends in zip(*means, strict=True)))
    lives = plan.numbering["lives"].total
    return Expectation(
        lives=lives,
        most_steps=sum(case.steps for case in plan.lived) * study.lives,
        robots=plan.numbering["teachers"].total,
        learning_steps=plan.steps_to_learn,
        seconds=Range(*((steps * lives + plan.steps_to_learn) / speed for steps in mean)),
        tables_bytes=_tables(plan, measured[0].table),
        trace_bytes=_traces(plan, mean),
        measured_lives=sum(one.table.num_rows for one in measured),
        measured_cases=len(measured),
        errors=[error for one in measured for error in one.errors if error is not None],
    )


def _measure(plan: Plan, place: int) -> Measured:
    """Live some lives of a case on all cores, each a short while."""
    case, setting = plan.lived[place], _setting(plan, place)
    steps = min(case.steps, STEPS)
    cores = os.cpu_count() or 1
    lives = case.first + np.arange(CHUNK * cores, dtype=np.uint64)
    # The first life is not counted: it compiles what is not on disk yet.
    Batch(setting, case.seed, 1).run(lives[:1])
    started = time.perf_counter()
    with KernelThreads(cores) as threads:
        lived = list(threads.map(Batch(setting, case.seed, steps).run, np.split(lives, cores)))
    seconds = time.perf_counter() - started
    states = np.concatenate([one.states for one in lived])
    errors = [error for one in lived for error in one.errors]
    return Measured(pa.table(summary(setting, case.seed, lives, states)), steps, seconds, errors)


def _setting(plan: Plan, place: int) -> Setting:
    """Return the setting of a case; AF, which has not learnt yet, knows the truth instead."""
    setting = plan.setting(place)
    if setting.mind.agent != "AF":
        return setting
    mind = setting.mind.model_copy(update={"agent": "ORACLE"})
    return bring_together(mind, setting.world, setting.robot, setting.functions)


def _tables(plan: Plan, lives: pa.Table) -> float:
    """Return the room of the tables of lives and of networks, each in as many files as parts."""
    parts = sum(numbering.parts for numbering in plan.numbering.values())
    room = parts * _size(lives.slice(0, 0)) + _bytes_of_a_row(lives) * plan.numbering["lives"].total
    for each in plan.classes:
        features = len(world_of(each.teacher.world).feature_names)
        weights = len(each.mind.behaviours) * each.mind.weight_count(features)
        room += each.robots * weights * np.float64().nbytes
    return room


def _traces(plan: Plan, lifespan: Range) -> Range:
    """Return the room of the traces of lives of so many steps."""
    record = plan.study.record
    choice = TraceChoice.parse(record.what) if record is not None else None
    if record is None or choice is None:
        return Range(0.0, 0.0)
    rows = lifespan * (1.0 / choice.every)
    if choice.last is not None:
        rows = Range(*(min(choice.last, steps) for steps in lifespan))
    case, setting = plan.lived[0], _setting(plan, 0)
    states, present = setting.begin(case.seed, np.array([case.first], np.uint64))
    birth = Moment(setting, case.seed, case.first, states, present)
    try:
        parts = list(lived(birth, TRACED, TraceChoice()))
    except FailedLifeError:
        # Of that `errors` tell; this life leaves no trace.
        return Range(0.0, 0.0)
    trace = pa.concat_tables(table(part, setting.mind, setting.world) for part in parts)
    return rows * (record.lives * len(plan.lived) * _bytes_of_a_row(trace.unify_dictionaries()))


def _bytes_of_a_row(table: pa.Table) -> float:
    """Return what a row takes on disk, without what the file takes that has none."""
    return (_size(table) - _size(table.slice(0, 0))) / table.num_rows


def _size(table: pa.Table) -> int:
    file = BytesIO()
    pq.write_table(table, file)
    return file.tell()

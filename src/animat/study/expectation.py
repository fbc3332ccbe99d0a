"""What a study would cost, from a handful of short lives of a few of its cases."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Sequence
from io import BytesIO
from typing import NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from animat.life.life import Recording, live
from animat.life.lives import CHUNK, live_chunks
from animat.life.setting import Setting, bring_together
from animat.study.design import Case
from animat.study.study import Record, Study

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
    """What a study would cost: steps, seconds and bytes.

    `learning_steps` are those of the `robots` whose networks AF has. `measured_lives` of
    `measured_cases` cases gave the speed of all cores, how long lives are, and the room of a row.
    """

    most_steps: int
    robots: int
    learning_steps: int
    seconds: Range
    lives_bytes: float
    trace_bytes: Range
    measured_lives: int
    measured_cases: int


class Measured(NamedTuple):
    """Some lives of a case: their table, the steps they were measured for, and the seconds."""

    table: pa.Table
    cap: int
    seconds: float

    @property
    def steps(self) -> int:
        """Steps lived."""
        return int(self.table["lifespan"].to_numpy().sum())

    def mean_lifespan(self, cap: int) -> Range:
        """Return the mean lifespan up to `cap`.

        At least, if later steps are as deadly as those of the second half, which are less deadly
        than the first; at most, if whoever was still alive lives up to the cap.
        """
        lifespans = self.table["lifespan"].to_numpy()
        dead = ~self.table["censored"].to_numpy()
        half = self.cap // 2
        hazard = int((dead & (lifespans > half)).sum()) / max((lifespans - half).clip(0).sum(), 1)
        left = float(cap - self.cap)
        further = -math.expm1(-hazard * left) / hazard if hazard else left
        mean, alive = float(lifespans.mean()), float((~dead).mean())
        return Range(mean + alive * further, mean + alive * left)


def expect(study: Study, cases: Sequence[Case]) -> Expectation:
    """Return what the cases of a study would cost, cases that cannot be told apart not spared.

    Raises SettingsError for what cannot be lived.
    """
    places = sorted({round(place) for place in np.linspace(0, len(cases) - 1, CASES)})
    measured = [_measure(cases[place]) for place in places]
    speed = sum(one.steps for one in measured) / sum(one.seconds for one in measured)
    means = [
        one.mean_lifespan(cases[place].steps) for one, place in zip(measured, places, strict=True)
    ]
    mean = Range(*(sum(ends) / len(means) for ends in zip(*means, strict=True)))
    classes = _classes(cases).values()
    learning_steps = sum(robots * steps for robots, steps in classes)
    lives = study.lives * len(cases)
    return Expectation(
        most_steps=sum(case.steps for case in cases) * study.lives,
        robots=sum(robots for robots, _ in classes),
        learning_steps=learning_steps,
        seconds=Range(*((steps * lives + learning_steps) / speed for steps in mean)),
        lives_bytes=_bytes_of_a_row(measured[0].table) * lives,
        trace_bytes=_traces(study.record, mean, cases),
        measured_lives=sum(one.table.num_rows for one in measured),
        measured_cases=len(measured),
    )


def _measure(case: Case) -> Measured:
    """Live some lives of a case on all cores, each a short while."""
    setting = _setting(case)
    steps = min(case.steps, STEPS)
    lives = CHUNK * (os.cpu_count() or 1)
    # The first life is not counted: it compiles what is not on disk yet.
    list(live_chunks(setting, case.seed, case.first, 1, 1))
    started = time.perf_counter()
    chunks = list(live_chunks(setting, case.seed, case.first, lives, steps))
    seconds = time.perf_counter() - started
    table = pa.concat_tables(map(pa.table, chunks)).unify_dictionaries()
    return Measured(table, steps, seconds)


def _setting(case: Case) -> Setting:
    """Return the setting of a case; AF, which has not learnt yet, knows the truth instead."""
    mind = case.settings.mind
    if mind.agent == "AF":
        mind = mind.model_copy(update={"agent": "ORACLE"})
    return bring_together(mind, case.settings.world.world(), case.settings.robot)


def _classes(cases: Sequence[Case]) -> dict[str, tuple[int, int]]:
    """Return robots and steps of everyone who teaches, by what makes them learn the same."""
    classes: dict[str, tuple[int, int]] = {}
    for case in cases:
        if case.teacher is not None:
            mind = case.settings.mind.model_dump_json(exclude={"agent"})
            mark = mind + case.settings.robot.model_dump_json() + case.teacher.model_dump_json()
            classes[mark] = case.teacher.robots, case.teacher.steps
    return classes


def _traces(record: Record | None, lifespan: Range, cases: Sequence[Case]) -> Range:
    """Return the room of the traces of lives of so many steps."""
    recording = Recording.parse(record.what) if record is not None else None
    if record is None or recording is None:
        return Range(0.0, 0.0)
    rows = lifespan * (1.0 / recording.every)
    if recording.last is not None:
        rows = Range(*(min(recording.last, steps) for steps in lifespan))
    setting = _setting(cases[0])
    life = live(
        setting.mind,
        setting.world,
        robot=setting.robot,
        seed=cases[0].seed,
        life=cases[0].first,
        steps=TRACED,
        record="all",
    )
    assert life.trace is not None
    return rows * (record.lives * len(cases) * _bytes_of_a_row(life.trace))


def _bytes_of_a_row(table: pa.Table) -> float:
    """Return what a row takes on disk, without what the file takes that has none."""
    return (_size(table) - _size(table.slice(0, 0))) / table.num_rows


def _size(table: pa.Table) -> int:
    file = BytesIO()
    pq.write_table(table, file)
    return file.tell()

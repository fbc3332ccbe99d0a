"""Traces of the lives of a study, held against traces of single lives."""

from __future__ import annotations

import numpy as np
import pytest

from animat.life import batch as module
from animat.life.batch import Batch
from animat.life.life import TraceChoice, live
from animat.life.scenario import bring_together
from animat.mind.mind import Mind
from animat.study.execute.traces import Traced
from animat.world.world import World

LIVES = np.arange(4, 9, dtype=np.uint64)


@pytest.mark.parametrize("what", ["all", "every:7", "last:1", "last:300", "last:5000"])
@pytest.mark.parametrize("every", [100, 10_000])
@pytest.mark.parametrize("settings", [{}, {"death": False}])
def test_they_are_those_of_single_lives(what, every, settings, monkeypatch):
    """However often lives were looked at, whether or not they died before the cap."""
    monkeypatch.setattr(module, "LOOK_EVERY", every)
    mind, steps = Mind(**settings), 2_500
    recording = TraceChoice.parse(what)
    assert recording is not None
    batch = Batch(bring_together(mind, World.abundant()), 3, steps, back=recording.last or 0)
    result = batch.run(LIVES)
    result.errors[2] = "it failed"
    traced = Traced(7, batch, result, LIVES, None, 4)
    schema = traced.schema()
    rows = [row for table in traced.tables(recording, schema) for row in table.to_pylist()]
    alone = []
    for life in (4, 5, 7):
        trace = live(mind, World.abundant(), seed=3, life=life, steps=steps, record=what).trace
        assert trace is not None
        alone += [{"case": 7, "life": life, **row} for row in trace.to_pylist()]
    assert rows == alone
    assert result.states["dead"].any() == (not settings)


def test_columns_that_a_mind_has_not_are_null():
    batch = Batch(bring_together(Mind(), World.abundant()), 3, 50)
    traced = Traced(0, batch, batch.run(LIVES), LIVES, None, 1)
    wanted = traced.schema()
    wider = wanted.append(wanted.field("hunger").with_name("thirst"))
    (table,) = traced.tables(TraceChoice(), wider)
    assert table["thirst"].null_count == table.num_rows == 50
    assert table["hunger"].null_count == 0

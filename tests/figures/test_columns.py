"""However long a trace and however it is cut into parts, nothing of it is lost."""

from itertools import pairwise

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from animat.figures import columns
from animat.figures.columns import condensed, envelope
from animat.statistics.lives import column

BEHAVIOURS = ("wander", "eat", "leave")
EVENTS = ("", "encounter", "failure trained", "death")


@st.composite
def traces(draw):
    """A trace of few rows, each of `every` steps, drawn over even fewer columns."""
    rows = draw(st.integers(1, 60))
    every = draw(st.integers(1, 7))

    def some(values):
        return draw(st.lists(values, min_size=rows, max_size=rows))

    first = draw(st.integers(0, 20))
    return pa.table(
        {
            "step": first + every * np.arange(rows),
            "hunger": pa.array(some(st.none() | st.integers(-5, 5).map(float)), pa.float64()),
            "behaviour": pa.array(some(st.sampled_from(BEHAVIOURS))),
            "event": pa.array(some(st.sampled_from(EVENTS))),
            "reward": np.array(some(st.sampled_from([0, 0, 1, -1]))),
            "x": np.array(some(st.floats(0, 500))),
            "y": np.array(some(st.floats(0, 500))),
        }
    )


@settings(max_examples=60, deadline=None)
@given(traces(), st.integers(1, 70), st.integers(1, 60))
def test_all_that_occurs_in_a_column_is_drawn_in_it(trace, most, part):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(columns, "COLUMNS", most)
        step = column(trace, "step")
        span = int(step[0]), int(step[-1]) + 1
        parts = [trace.slice(at, part) for at in range(0, trace.num_rows, part)]
        seen = condensed(iter(parts), span, ["hunger"])
    edges = seen.edges
    assert (edges[0], edges[-1]) == span
    assert len(edges) - 1 <= most
    assert np.sum(list(seen.shares.values()), axis=0) == pytest.approx(1.0)
    steps, drawn = seen.curves["hunger"]
    assert (np.diff(steps) > 0).all()
    hunger, behaviour = column(trace, "hunger"), column(trace, "behaviour")
    begun = np.isnan(hunger) & ~np.isnan(np.concatenate([[0.0], hunger[:-1]]))
    told = [set(text.split()) for text in column(trace, "event")]
    for place, (low, past) in enumerate(pairwise(edges.tolist())):
        here = np.flatnonzero((step >= low) & (step < past))
        if not len(here):
            assert all(share[place] == share[place - 1] for share in seen.shares.values())
            continue
        runs = {name for name, share in seen.shares.items() if share[place] > 0}
        assert runs == set(behaviour[here])
        events = {name for name, at in seen.events.items() if ((at >= low) & (at < past)).any()}
        assert events == set().union(*(told[row] for row in here))
        values = drawn[(steps >= low) & (steps < past)]
        known = hunger[here][~np.isnan(hunger[here])]
        assert np.isnan(values).any() >= begun[here].any()
        values = values[~np.isnan(values)]
        assert len(values) == 0 or set(values) <= set(known)
        if len(known):
            ends = [values[0], values.min(), values.max(), values[-1]]
            assert ends == [known[0], known.min(), known.max(), known[-1]]
    for reward, marked in seen.rewards.items():
        got = np.column_stack([trace["x"], trace["y"]])[column(trace, "reward") == reward]
        near = np.abs(got[:, None] - marked[None]).max(axis=2) <= columns.GRAIN
        assert near.any(axis=1).all()
        assert not len(marked) or near.any(axis=0).all()
    np.testing.assert_array_equal(seen.path[[0, -1], 0], column(trace, "x")[[0, -1]])


def test_a_short_trace_is_drawn_as_it_is(trace):
    table = trace(700)
    seen = condensed([table], (0, 700), ["nutrition"])
    np.testing.assert_array_equal(seen.curves["nutrition"][1], column(table, "nutrition"))
    np.testing.assert_array_equal(seen.path[:700, 0], column(table, "x"))


def test_a_curve_keeps_no_more_than_four_values_of_a_column():
    values = np.random.default_rng(1).random(10_000)
    assert len(envelope(np.arange(10_000) // 100, values)) <= 4 * 100


def test_a_long_path_is_drawn_through_fewer_places(trace, monkeypatch):
    monkeypatch.setattr(columns, "PATH_POINTS", 100)
    parts = [trace(400, start=at) for at in (0, 400)]
    seen = condensed(parts, (0, 800), [])
    x = np.concatenate([column(part, "x") for part in parts])
    assert {*x[::8], x[-1]} <= set(seen.path[:, 0])
    assert len(seen.path) == 101

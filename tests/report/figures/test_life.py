from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from animat.report.figures.life import life_figure, runs
from animat.report.lives import column

SET_POINTS = {"nutrition": 0.9, "stamina": 0.2, "restlessness": 0.1}
DRIVES = ("hunger", "fatigue", "curiosity")


@given(st.lists(st.sampled_from(["eat", "wander", "leave"]), min_size=1, max_size=40))
def test_runs_spell_the_labels(labels):
    found = runs(np.array(labels, dtype=object))
    assert [label for a, b, label in found for _ in range(b - a)] == labels
    assert all(one[2] != other[2] for one, other in pairwise(found))


def test_variables_have_their_set_points_and_drives_the_same_colours(trace):
    table = trace(800)
    needs, urges, _, _ = life_figure(table, set_points=SET_POINTS, drives=DRIVES).axes
    curves, points = needs.lines[::2], needs.lines[1::2]
    for curve, point, (name, value) in zip(curves, points, SET_POINTS.items(), strict=True):
        np.testing.assert_array_equal(curve.get_ydata(), column(table, name))
        assert point.get_ydata()[0] == value
        assert point.get_color() == curve.get_color()
    for curve, urge, name in zip(curves, urges.lines, DRIVES, strict=False):
        np.testing.assert_array_equal(urge.get_ydata(), column(table, name))
        assert urge.get_color() == curve.get_color()


def test_the_strip_covers_the_life_without_gap_or_overlap(trace):
    table = trace(800)
    strip = life_figure(table, set_points=SET_POINTS, drives=DRIVES).axes[2]
    pieces = sorted(
        (path.vertices[:, 0].min(), path.vertices[:, 0].max())
        for collection in strip.collections
        for path in collection.get_paths()
    )
    assert pieces[0][0] == 0
    assert pieces[-1][1] == 800
    assert all(one[1] == other[0] for one, other in pairwise(pieces))


def test_every_event_is_marked_in_its_row_even_if_the_curves_are_thinned(trace):
    table = trace(9000)
    events = life_figure(table, set_points=SET_POINTS, drives=DRIVES).axes[3]
    names = [label.get_text() for label in events.get_yticklabels()]
    assert names == ["encounter", "success", "failure", "trained", "death"]
    for line, name in zip(events.lines, names, strict=True):
        np.testing.assert_array_equal(
            line.get_xdata(),
            [t for t, told in enumerate(column(table, "event")) if name in told.split()],
        )


def test_the_path_is_drawn_where_there_is_a_world(trace, world):
    table = trace(800)
    fig = life_figure(table, set_points=SET_POINTS, drives=DRIVES, world=world("World", 4))
    (ax,) = [ax for ax in fig.axes if ax.get_xlabel() == "x (mm)"]
    lines = {line.get_label(): line for line in ax.lines}
    path = ax.lines[0]
    np.testing.assert_array_equal(path.get_xdata(), column(table, "x"))
    won = column(table, "reward") == 1
    np.testing.assert_array_equal(lines["success"].get_xdata(), column(table, "x")[won])
    assert lines["end"].get_ydata()[0] == column(table, "y")[-1]
    assert len(life_figure(table, set_points=SET_POINTS, drives=DRIVES).axes) == 4

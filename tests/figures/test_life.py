from itertools import pairwise

import numpy as np
import pytest
from matplotlib.colors import to_hex

from animat.figures import style
from animat.figures.life import life_figure
from animat.statistics.lives import column

SET_POINTS = {"nutrition": 0.9, "stamina": 0.2, "restlessness": 0.1}
DRIVES = {"hunger": "nutrition", "fatigue": "stamina", "curiosity": "restlessness"}
BEHAVIOURS = {"eat": "nutrition", "shelter": "stamina", "interact": "restlessness"}
MIND = {"set_points": SET_POINTS, "drives": DRIVES, "behaviours": BEHAVIOURS}


def test_variables_have_their_set_points(trace):
    table = trace(800)
    needs, urges, _, _ = life_figure(table, **MIND).axes
    curves, points = needs.lines[::2], needs.lines[1::2]
    for curve, point, (name, value) in zip(curves, points, SET_POINTS.items(), strict=True):
        np.testing.assert_array_equal(curve.get_ydata(), column(table, name))
        assert point.get_ydata()[0] == value
        assert point.get_color() == curve.get_color()
    for urge, name in zip(urges.lines, DRIVES, strict=False):
        np.testing.assert_array_equal(urge.get_ydata(), column(table, name))


@pytest.mark.parametrize("backwards", [False, True])
def test_a_variable_its_drive_and_what_serves_it_have_one_colour(trace, backwards):
    """In whatever order they are listed, and the same in every figure."""
    turn = (lambda named: dict(reversed(named.items()))) if backwards else dict
    fig = life_figure(
        trace(800),
        set_points=SET_POINTS,
        drives=turn(DRIVES),
        behaviours=turn(BEHAVIOURS),
    )
    lines = {line.get_label(): line.get_color() for ax in fig.axes[:2] for line in ax.lines}
    strip = fig.axes[3].get_legend()
    for patch, text in zip(strip.get_patches(), strip.get_texts(), strict=True):
        lines[text.get_text()] = to_hex(patch.get_facecolor()).upper()
    for named in (DRIVES, BEHAVIOURS):
        for name, variable in named.items():
            assert lines[name] == lines[variable] == style.need_colours(SET_POINTS)[variable]
    assert len({lines[name] for name in (*SET_POINTS, "wander", "approach", "leave")}) == 6


def test_two_drives_and_two_behaviours_of_one_need_differ(trace):
    fig = life_figure(
        trace(800),
        set_points={"nutrition": 0.9},
        drives=dict.fromkeys(DRIVES, "nutrition"),
        behaviours=dict.fromkeys(BEHAVIOURS, "nutrition"),
    )
    assert len({line.get_linestyle() for line in fig.axes[1].lines[:3]}) == 3
    patches = fig.axes[3].get_legend().get_patches()
    assert len({(patch.get_facecolor(), patch.get_hatch()) for patch in patches}) == len(patches)


@pytest.mark.parametrize("steps", [800, 30_000])
def test_the_strip_is_filled_without_gap_or_overlap(trace, steps):
    """And shows all that runs in a column, however little of it; the legend names all of it."""
    table = trace(steps)
    fig = life_figure(table, **MIND)
    boxes = sorted(
        (*path.vertices.min(axis=0), *path.vertices.max(axis=0))
        for collection in fig.axes[2].collections
        for path in collection.get_paths()
    )
    assert sum((x1 - x0) * (y1 - y0) for x0, y0, x1, y1 in boxes) == pytest.approx(steps)
    edges = sorted({box[0] for box in boxes} | {steps})
    assert edges[0] == 0
    for low, past in pairwise(edges):
        here = [box for box in boxes if box[0] == low]
        assert all(box[2] == past and box[3] - box[1] > 0.04 for box in here)
        assert len(here) == len(set(column(table, "behaviour")[int(low) : int(past)]))
    told = [text.get_text() for text in fig.axes[3].get_legend().get_texts()]
    assert sorted(told) == sorted(set(column(table, "behaviour")))


def test_every_event_is_marked_in_its_row(trace):
    table = trace(900)
    events = life_figure(table, **MIND).axes[3]
    names = [label.get_text() for label in events.get_yticklabels()]
    assert names == ["encounter", "success", "failure", "trained", "death"]
    for line, name in zip(events.lines, names, strict=True):
        np.testing.assert_array_equal(
            line.get_xdata(),
            [t for t, told in enumerate(column(table, "event")) if name in told.split()],
        )


def test_the_path_is_drawn_where_there_is_a_world(trace, world):
    table = trace(800)
    fig = life_figure(table, **MIND, world=world("World", 4))
    (ax,) = [ax for ax in fig.axes if ax.get_xlabel() == "x (mm)"]
    lines = {line.get_label(): line for line in ax.lines}
    path = ax.lines[0]
    np.testing.assert_array_equal(path.get_xdata()[:800], column(table, "x"))
    won = column(table, "reward") == 1
    assert set(lines["success"].get_xdata()) <= set(column(table, "x")[won])
    assert lines["end"].get_ydata()[0] == column(table, "y")[-1]
    assert len(life_figure(table, **MIND).axes) == 4


def test_object_types_are_named_and_no_mark_looks_like_one(trace, world):
    types = ["TS", "cube", "star", "CL", "cone"]
    drawn = world("World", 5)._replace(types=types)
    fig = life_figure(trace(800), **MIND, world=drawn)
    (legend,) = fig.subfigs[1].legends
    told = [text.get_text() for text in legend.get_texts()]
    assert told == ["TS, small triangle", "CL, large circle", "cone", "cube", "star"]
    fills = {to_hex(patch.get_facecolor()) for patch in legend.get_patches()}
    (ax,) = fig.subfigs[1].axes
    marks = {to_hex(line.get_markerfacecolor()) for line in ax.lines[1:]}
    assert len(fills) == 5
    assert marks == {"#000000", "#ffffff"}
    assert not fills & marks


def test_a_trace_in_parts_is_drawn_alike_and_needs_its_span(trace, world):
    table = trace(5_000)
    parts = [table.slice(at, 1_300) for at in range(0, 5_000, 1_300)]
    one, other = (life_figure(given, **MIND, span=(0, 5_000)) for given in (table, iter(parts)))
    assert style.svg(one) == style.svg(other)
    with pytest.raises(ValueError, match="span"):
        life_figure(iter(parts), **MIND)

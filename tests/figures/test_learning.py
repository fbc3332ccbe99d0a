import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.figures.learning import curves, learning_curve_figure, learning_figure, spans
from animat.statistics.lives import column


@given(st.lists(st.booleans(), max_size=60))
def test_spans_are_exactly_where_the_flags_are(flags):
    marked = np.zeros(len(flags), dtype=bool)
    found = spans(np.array(flags, dtype=bool))
    for start, stop in found:
        assert start < stop
        assert not marked[max(0, start - 1) : stop].any()
        marked[start:stop] = True
    assert marked.tolist() == flags


def test_five_signals_in_the_papers_order_over_the_last_steps(trace):
    table = trace(1200, start=298_800)
    fig = learning_figure(table)
    labels = [ax.get_ylabel().replace("\n", " ") for ax in fig.axes]
    assert labels == [
        "object type", "nutrition", "hunger", "learning reward", "grasp likelihood",
    ]  # fmt: skip
    last = table.slice(700)
    for place, name in ((1, "nutrition"), (2, "hunger"), (4, "likelihood_eat")):
        line = fig.axes[place].lines[0]
        np.testing.assert_array_equal(line.get_xdata(), np.arange(299_500, 300_000))
        np.testing.assert_array_equal(line.get_ydata(), column(last, name))


def test_rewards_and_objects_are_those_of_the_trace(trace):
    table = trace(3000).slice(0, 500)
    fig = learning_figure(table)
    reward = column(table, "reward")
    ends = [path.vertices[1].tolist() for path in fig.axes[3].collections[0].get_paths()]
    assert ends == [[step, reward[step]] for step in np.flatnonzero(reward)]
    for level, kind in enumerate(("TS", "TL", "CS", "CL")):
        paths = fig.axes[0].collections[level].get_paths()
        expected = spans(column(table, "object") == kind)
        assert [(round(p.vertices[:, 0].min() + 0.5), round(p.vertices[:, 0].max() + 0.5))
                for p in paths] == expected  # fmt: skip


def test_figure_4_is_the_same_for_shelter(trace):
    fig = learning_figure(
        trace(600), variable="stamina", drive="fatigue", behaviour="shelter", affordance="shelter"
    )
    assert [ax.get_ylabel() for ax in fig.axes][1:3] == ["stamina", "fatigue"]
    assert fig.axes[4].get_ylabel() == "shelter\nlikelihood"


def rows(*entries):
    names = ("seed", "episode", "network", "object", "likelihood")
    return pa.Table.from_pylist([dict(zip(names, entry, strict=True)) for entry in entries])


def test_a_network_keeps_its_value_until_it_has_another():
    table = rows(
        (1, 4, "eat", "TS", 0.8), (1, 0, "eat", "TS", 0.5), (2, 2, "eat", "TS", 0.1),
        (1, 0, "eat", "TL", 0.9),
    )  # fmt: skip
    episodes, values = curves(table, "eat", "TS")
    assert episodes.tolist() == [0, 2, 4]
    np.testing.assert_array_equal(values, [[0.5, 0.5, 0.8], [np.nan, 0.1, 0.1]])


def test_line_and_band_are_those_of_numpy(learning):
    table, _ = learning(30)
    fig = learning_curve_figure(table)
    assert [ax.get_title() for ax in fig.axes] == ["eat", "shelter", "interact"]
    _, values = curves(table, "shelter", "TL")
    line = fig.axes[1].lines[1]
    np.testing.assert_allclose(line.get_ydata(), values.mean(axis=0))
    band = fig.axes[1].collections[1].get_paths()[0].vertices[:, 1]
    low, high = np.percentile(values, [5, 95], axis=0)
    assert band.min() == pytest.approx(low.min())
    assert band.max() == pytest.approx(high.max())


def test_the_error_is_the_distance_to_what_is_afforded(learning):
    table, afforded = learning(5)
    fig = learning_curve_figure(table, afforded=afforded, show="error")
    _, values = curves(table, "eat", "TS")
    np.testing.assert_allclose(fig.axes[0].lines[0].get_ydata(), (1 - values).mean(axis=0))
    assert fig.axes[0].get_ylabel() == "error of the likelihood"


def test_an_error_without_a_truth_is_refused(learning):
    with pytest.raises(ValueError, match="what is afforded"):
        learning_curve_figure(learning(2)[0], show="error")

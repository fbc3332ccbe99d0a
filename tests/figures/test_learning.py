import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from animat.figures.learning import learning_figure, spans
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

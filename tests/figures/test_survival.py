import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from animat.figures.survival import POINTS, level_curves_figure, survival_figure, thinned
from animat.statistics import survival


@given(st.integers(1, 20_000))
def test_thinning_keeps_both_ends_and_the_order(length):
    kept = thinned(length)
    assert kept[0] == 0
    assert kept[-1] == length - 1
    assert len(kept) == min(length, POINTS)
    assert (np.diff(kept) > 0).all()


def curves(lives_table, cap):
    cells = {("abundant", "AF"): [10, 20, 40], ("scarce", "AF"): [5, 6, 7]}
    table = lives_table(cells, cap=cap)
    return {key: survival.kaplan_meier(rows) for key, rows in survival.cells(table)}


def test_a_line_is_the_curve_colour_the_agent_style_the_world(lives_table):
    drawn = curves(lives_table, None)
    (ax,) = survival_figure(drawn).axes
    rich, poor = ax.lines
    np.testing.assert_array_equal(rich.get_xdata(), [0, 10, 20, 40])
    np.testing.assert_allclose(rich.get_ydata(), [1, 2 / 3, 1 / 3, 0])
    assert rich.get_color() == poor.get_color()
    assert rich.get_linestyle() != poor.get_linestyle()


def test_only_curves_of_lives_that_reached_the_cap_end_in_a_dot(lives_table):
    def dots(cap):
        fig = survival_figure(curves(lives_table, cap))
        drawn = [line for line in fig.axes[0].lines if line.get_marker() == "o"]
        labels = [text.get_text() for text in fig.legends[0].get_texts()]
        return [line.get_xdata().tolist() for line in drawn if len(line.get_xdata())], labels

    points, labels = dots(30)
    assert points == [[30.0]]
    assert "alive at the cap" in labels
    points, labels = dots(None)
    assert points == []
    assert "alive at the cap" not in labels


def test_every_level_has_a_look_of_its_own(lives_table):
    (curve, *_) = curves(lives_table, None).values()
    for ordered in (True, False):
        (ax,) = level_curves_figure({str(k): curve for k in range(8)}, ordered=ordered).axes
        assert len({(line.get_color(), line.get_linestyle()) for line in ax.lines}) == 8

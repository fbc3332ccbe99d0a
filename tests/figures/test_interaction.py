import numpy as np

from animat.figures.interaction import InteractionLine, interaction_figure
from animat.statistics.estimates import Estimate

LINES = [
    InteractionLine("BLIND", {k: Estimate(300.0 + k, 250.0, 350.0) for k in range(3)}),
    InteractionLine("AF", {k: Estimate(900.0 - 100 * k, 600.0, 1000.0) for k in range(3)}),
]


def drawn(places, lines=LINES, levels=("0.1", "0.2", "0.9")):
    (ax,) = interaction_figure("effect", levels, places, lines, "agent").axes
    return ax


def test_numbers_stand_where_they_are_with_their_means_and_intervals():
    ax = drawn((0.1, 0.2, 0.9))
    bars = ax.containers[1]
    np.testing.assert_allclose(bars[0].get_xdata(), [0.1, 0.2, 0.9])
    np.testing.assert_allclose(bars[0].get_ydata(), [900.0, 800.0, 700.0])
    (segments,) = (each.get_segments() for each in bars[2])
    np.testing.assert_allclose(segments[0], [[0.1, 600.0], [0.1, 1000.0]])
    assert [text.get_text() for text in ax.get_xticklabels()] == ["0.1", "0.2", "0.9"]


def test_words_stand_evenly_and_lines_beside_each_other():
    ax = drawn(None, levels=("rich", "poor", "empty"))
    places = [bars[0].get_xdata() for bars in ax.containers]
    np.testing.assert_allclose(np.mean(places, axis=0), [0.0, 1.0, 2.0])
    assert not np.array_equal(*places)


def test_a_level_that_is_not_set_stands_apart_and_is_not_joined():
    ax = drawn((0.1, 0.9, np.nan), levels=("0.1", "0.9", "not set"))
    joined = [line.get_xdata() for line in ax.lines if len(line.get_xdata()) == 2]
    assert any(np.allclose(x, [0.1, 0.9]) for x in joined)
    assert ax.containers[0][0].get_xdata()[2] > 0.9


def test_numbers_and_means_far_apart_have_logarithmic_axes():
    far = [InteractionLine("AF", {0: Estimate(10, 9, 11), 1: Estimate(9000, 8000, 10_000)})]
    ax = drawn((0.001, 1.0), far, ("0.001", "1"))
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert (drawn((0.1, 0.2, 0.9)).get_yscale()) == "linear"


def test_of_numbers_close_together_not_every_one_is_written():
    ax = drawn((0.0, 0.001, 1.0), levels=("0", "0.001", "1"))
    assert [text.get_text() for text in ax.get_xticklabels()] == ["0", "", "1"]


def test_a_level_that_a_line_has_not_and_what_is_unknown_are_left_out():
    nan = float("nan")
    ax = drawn(
        (0.1, 0.2, 0.9), [InteractionLine("AF", {0: Estimate(5, nan, nan), 2: LINES[0].means[2]})]
    )
    np.testing.assert_allclose(ax.containers[0][0].get_xdata(), [0.1, 0.9])

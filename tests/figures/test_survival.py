import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from animat.figures.survival import (
    POINTS,
    Bar,
    Panel,
    level_curves_figure,
    lifespans_figure,
    survival_figure,
    thinned,
)
from animat.statistics import survival
from animat.statistics.estimates import Estimate


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


BARS = [
    Bar("abundant", "BLIND", Estimate(100.0, 90.0, 120.0)),
    Bar("abundant", "AF", Estimate(200.0, 190.0, 215.0)),
    Bar("scarce", "BLIND", Estimate(50.0, 45.0, 60.0)),
    Bar("scarce", "AF", Estimate(75.0, 70.0, 80.0)),
]


def test_bars_are_paired_by_world_with_blind_left():
    (ax,) = lifespans_figure([Panel("20 lives", BARS)]).axes
    bars = [bar for container in ax.containers if hasattr(container, "patches")
            for bar in container.patches]  # fmt: skip
    middles = [bar.get_x() + bar.get_width() / 2 for bar in bars]
    assert [round(middle) for middle in middles] == [0, 0, 1, 1]
    edges = [edge for bar in bars for edge in (bar.get_x(), bar.get_x() + bar.get_width())]
    assert edges == sorted(edges)
    assert [bar.get_height() for bar in bars] == [100, 200, 50, 75]


def test_whiskers_are_the_intervals():
    (ax,) = lifespans_figure([Panel("20 lives", BARS)]).axes
    whiskers = [path.vertices[:, 1].tolist() for c in ax.collections for path in c.get_paths()]
    assert whiskers == [[b.mean.low, b.mean.high] for b in BARS]


def test_panels_share_a_scale_that_starts_at_nothing():
    twice = [bar._replace(mean=Estimate(*(2 * v for v in bar.mean))) for bar in BARS]
    first, second = lifespans_figure([Panel("a", BARS), Panel("b", twice)]).axes
    assert first.get_ylim() == second.get_ylim()
    assert first.get_ylim()[0] == 0
    assert first.get_ylim()[1] > 430


def test_a_mean_without_an_interval_is_drawn_without_whiskers_past_it():
    one = [Bar("abundant", "AF", Estimate(10.0, 10.0, 10.0))]
    (ax,) = lifespans_figure([Panel("one life", one)]).axes
    assert ax.collections[0].get_paths()[0].vertices[:, 1].tolist() == [10.0, 10.0]

from animat.figures.lifespans import Bar, Panel, lifespans_figure
from animat.statistics.estimates import Estimate

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

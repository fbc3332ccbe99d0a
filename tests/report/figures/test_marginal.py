import numpy as np
import pyarrow as pa
import pytest
from matplotlib.colors import to_rgba

from animat.report.figures.marginal import factors_figure, points_figure
from animat.report.figures.style import BLUE, GREY

GAINS = {"gain": "factor on the abundant gain", "other": "factor on the scarce gain"}


@pytest.fixture
def effects():
    rows = []
    for value, points, factor in (("lethal", -0.49, 0.3), ("burst", 0.001, 1.05)):
        named = {"reading": "overflow", "value": value, "against": "clamp"}
        rows.append({**named, "outcome": "C1", "effect": points, "low": points - 0.1,
                     "high": points + 0.1})  # fmt: skip
        for gain in GAINS:
            rows.append({**named, "outcome": gain, "effect": factor, "low": factor * 0.9,
                         "high": factor * 1.1})  # fmt: skip
    return pa.Table.from_pylist(rows)


def test_points_are_told_and_those_that_may_be_nothing_are_grey(effects, legible):
    fig = points_figure(effects, ["C1"])
    (ax,) = fig.axes
    assert [text.get_text() for text in ax.texts] == ["-49", "+0"]
    assert [text.get_color() == GREY for text in ax.texts] == [False, True]
    rows = [label.get_text() for label in ax.get_yticklabels()]
    assert rows == ["overflow: lethal, not clamp", "overflow: burst, not clamp"]
    np.testing.assert_allclose(ax.images[0].get_array(), [[-0.49], [0.001]])
    legible(fig)


def test_factors_have_their_intervals_on_a_logarithmic_axis(effects, legible):
    fig = factors_figure(effects, GAINS)
    ax, _ = fig.axes
    assert ax.get_xscale() == "log"
    sure, unsure = ax.collections
    np.testing.assert_allclose(sure.get_segments()[0], [[0.27, 0], [0.33, 0]])
    np.testing.assert_allclose(unsure.get_segments()[0], [[0.945, 1], [1.155, 1]])
    assert tuple(sure.get_color()[0]) == to_rgba(BLUE)
    legible(fig)


def test_what_could_not_be_compared_is_left_blank(effects, legible):
    nothing = [
        {**row, "effect": np.nan, "low": np.nan, "high": np.nan} for row in effects.to_pylist()
    ]
    wide = [{**row, "low": row["effect"] / 1e9, "high": 1e9} for row in effects.to_pylist()]
    for rows in (nothing, wide):
        table = pa.Table.from_pylist(rows)
        legible(factors_figure(table, GAINS))
        legible(points_figure(table, ["C1"]))
    assert not points_figure(pa.Table.from_pylist(nothing), ["C1"]).axes[0].texts

import numpy as np
import pyarrow as pa
import pytest
from matplotlib.colors import to_rgba

from animat.figures.marginal import factors_figure, points_figure
from animat.figures.style import BLUE

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
    assert [text.get_fontweight() == "bold" for text in ax.texts] == [True, False]
    rows = [label.get_text() for label in ax.get_yticklabels()]
    assert rows == ["overflow: lethal, not clamp", "overflow: burst, not clamp"]
    np.testing.assert_allclose(ax.images[0].get_array(), [[-0.49], [0.0]])
    legible(fig)


def luminance(colour):
    """How light a colour is, by the Web Content Accessibility Guidelines."""
    rgb = np.array(to_rgba(colour)[:3])
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4) @ (
        0.2126, 0.7152, 0.0722,
    )  # fmt: skip


@pytest.mark.parametrize("width", [0.0, 2.0])
def test_every_number_stands_out_from_its_ground(width):
    rows = [
        {"reading": "overflow", "value": f"{effect}", "against": "clamp", "outcome": "C1",
         "effect": effect, "low": effect - width, "high": effect + width}
        for effect in np.linspace(-1.0, 1.0, 21)
    ]  # fmt: skip
    (ax,) = points_figure(pa.Table.from_pylist(rows), ["C1"]).axes
    (image,) = ax.images
    grounds = image.to_rgba(image.get_array())[:, 0]
    for text, ground in zip(ax.texts, grounds, strict=True):
        dark, light = sorted([luminance(text.get_color()), luminance(ground)])
        assert (light + 0.05) / (dark + 0.05) > 4.0


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


def test_long_words_leave_room_for_the_drawing(effects, legible):
    rows = [
        {**row, "reading": "what is meant by overflow " * 3, "against": "clamped at its bound " * 2}
        for row in effects.to_pylist()
    ]
    table = pa.Table.from_pylist(rows)
    for fig in (points_figure(table, ["C1"]), factors_figure(table, GAINS)):
        legible(fig)
        assert all(ax.get_window_extent().width > 0.12 * fig.bbox.width for ax in fig.axes)
        lethal, burst = (label.get_text() for label in fig.axes[0].get_yticklabels())
        assert "lethal" in lethal
        assert "burst" in burst

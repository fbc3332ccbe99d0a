import numpy as np
import pyarrow as pa
import pytest

from animat.figures import specification
from animat.figures.specification import specification_figure

READINGS = {"overflow": ("clamp", "lethal"), "physiology": ("excess", "decay", "linear")}


def universes(count=60, seed=1):
    """Universes whose gain is small just where overflow is lethal."""
    rng = np.random.default_rng(seed)
    overflow = np.repeat(["lethal", "clamp"], count // 2)
    gain = np.where(overflow == "clamp", 4.0, 0.5) * rng.uniform(0.9, 1.1, count)
    order = rng.permutation(count)
    return pa.table(
        {
            "gain": gain[order],
            "gain_low": gain[order] * 0.8,
            "gain_high": gain[order] * 1.2,
            "C1": np.where(gain > 1.0, "holds", "fails")[order],
            "overflow": overflow[order],
            "physiology": rng.choice(READINGS["physiology"], count),
        }
    )


def draw(**settings):
    return specification_figure(
        universes(**settings), READINGS, "gain", "C1", label="AF / BLIND, abundant world"
    )


def test_universes_are_sorted_and_coloured_by_their_verdict(legible):
    fig = draw()
    above, _ = fig.axes
    lines = {line.get_label(): line for line in above.lines}
    holds, fails = lines["C1 holds"], lines["C1 fails"]
    assert len(holds.get_xdata()) == len(fails.get_xdata()) == 30
    assert max(fails.get_xdata()) < min(holds.get_xdata())
    for line in (holds, fails):
        assert np.all(np.diff(line.get_ydata()) >= 0.0)
    assert above.get_yscale() == "log"
    legible(fig)


@pytest.mark.parametrize("most", [100, 10])
def test_the_dashboard_shows_where_each_value_was_taken(monkeypatch, most):
    monkeypatch.setattr(specification, "MOST_COLUMNS", most)
    _, below = draw().axes
    (mesh,) = below.collections[:1]
    shares = np.asarray(mesh.get_array()).reshape(5, -1)
    columns = shares.shape[1]
    assert columns == min(most, 60)
    labels = [label.get_text() for label in below.get_yticklabels()]
    clamp, lethal = (labels.index(f"overflow: {value}") for value in READINGS["overflow"])
    np.testing.assert_allclose(shares[lethal], np.repeat([1.0, 0.0], columns // 2))
    np.testing.assert_allclose(shares[clamp], np.repeat([0.0, 1.0], columns // 2))
    np.testing.assert_allclose(shares[2:].sum(axis=0), 1.0)


def test_long_words_leave_room_for_the_drawing(legible):
    long = {
        name: name if name not in READINGS else "what is meant by it " * 3 + name
        for name in universes().column_names
    }
    table = universes().rename_columns(long)
    words = {long[name]: values for name, values in READINGS.items()}
    fig = specification_figure(table, words, "gain", "C1", label="AF / BLIND")
    legible(fig)
    assert all(ax.get_window_extent().width > 0.4 * fig.bbox.width for ax in fig.axes)
    assert "lethal" in fig.axes[1].get_yticklabels()[1].get_text()

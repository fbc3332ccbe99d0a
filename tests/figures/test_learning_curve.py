import numpy as np
import pyarrow as pa
import pytest

from animat.figures.learning_curve import curves, learning_curve_figure


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

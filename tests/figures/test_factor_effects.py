import numpy as np

from animat.figures.factor_effects import factor_effects_figure, trend_figure
from animat.statistics.estimates import UNKNOWN, Estimate

FACTORS = {
    "agent": {"BLIND": Estimate(400.0, 350.0, 450.0), "AF": Estimate(800.0, 700.0, 900.0)},
    "gate": {"positive": Estimate(600.0, np.nan, np.nan)},
}


def test_a_dot_is_a_mean_and_a_line_its_interval_under_the_name_of_the_factor():
    (ax,) = factor_effects_figure(FACTORS, 600.0).axes
    labels = [text.get_text() for text in ax.get_yticklabels()]
    assert labels == ["agent", "BLIND", "AF", "gate", "positive"]
    dots = {line.get_ydata()[0]: line.get_xdata()[0] for line in ax.lines
            if line.get_marker() == "o"}  # fmt: skip
    assert {labels[int(row)]: x for row, x in dots.items()} == {
        "BLIND": 400.0, "AF": 800.0, "positive": 600.0,
    }  # fmt: skip
    spans = [tuple(line.get_xdata()) for line in ax.lines if line.get_marker() == "None"]
    assert (350.0, 450.0) in spans
    assert (600.0, 600.0) not in spans or ax.lines[0].get_xdata()[0] == 600.0
    assert ax.get_xscale() == "linear"


def test_means_far_apart_are_drawn_on_a_logarithmic_axis():
    far = {"agent": {"BLIND": Estimate(10.0, 9.0, 11.0), "AF": Estimate(9000.0, 1.0, 9001.0)}}
    assert factor_effects_figure(far, 100.0).axes[0].get_xscale() == "log"


def test_what_is_not_known_is_not_drawn():
    assert factor_effects_figure({"agent": {"BLIND": UNKNOWN}}, 100.0).axes


QUARTERS = [(0.2, Estimate(300.0, 200.0, 400.0)), (0.8, Estimate(500.0, np.nan, np.nan))]


def test_a_dot_is_a_case_and_a_square_a_quarter():
    values, means = np.array([0.1, 0.3, 0.9]), np.array([100.0, 400.0, 500.0])
    (ax,) = trend_figure("gap", values, means, QUARTERS).axes
    dots, squares = (line for line in ax.lines if line.get_marker() in ("o", "s"))
    np.testing.assert_array_equal(dots.get_xydata(), np.stack([values, means], axis=1))
    np.testing.assert_array_equal(squares.get_xydata(), [[0.2, 300.0], [0.8, 500.0]])
    assert ax.get_xlabel() == "gap"
    assert (ax.get_xscale(), ax.get_yscale()) == ("linear", "linear")


def test_values_far_apart_are_drawn_on_logarithmic_axes():
    values, means = np.array([1e-5, 1e-2]), np.array([10.0, 9000.0])
    (ax,) = trend_figure("rate", values, means, QUARTERS).axes
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")

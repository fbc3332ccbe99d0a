import numpy as np

from animat.figures.trend import trend_figure
from animat.statistics.estimates import Estimate

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

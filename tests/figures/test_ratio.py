import numpy as np
import pyarrow as pa

from animat.figures.ratio import Mark, ratio_figure


def test_the_line_is_the_median_and_the_bands_hold_the_layouts():
    table = pa.table({"objects": [3, 3, 3, 5, 5, 5], "layout": [0, 1, 2] * 2,
                      "ratio": [1.0, 2.0, 9.0, 2.0, 4.0, 3.0]})  # fmt: skip
    (ax,) = ratio_figure(table).axes
    lines = {line.get_label(): line for line in ax.lines}
    assert lines["median"].get_ydata().tolist() == [2.0, 3.0]
    assert lines["one random layout"].get_ydata().tolist() == table.column("ratio").to_pylist()
    whole, middle = (c.get_paths()[0].vertices for c in ax.collections)
    assert (whole[:, 1].min(), whole[:, 1].max()) == (1.0, 9.0)
    assert (middle[:, 1].min(), middle[:, 1].max()) == (1.5, 5.5)
    low, high = ax.get_ylim()
    assert low < 1.0
    assert high > 9.0


def test_the_papers_figures_and_the_worlds_are_marked(ratios):
    (ax,) = ratio_figure(ratios(4), marks=[Mark("World 1", 8, 200.0)]).axes
    lines = {line.get_label(): line for line in ax.lines}
    assert lines["paper, abundant: nearly 100%"].get_ydata()[0] == 2.0
    assert lines["paper, scarce: nearly 50%"].get_ydata()[0] == 1.5
    np.testing.assert_array_equal(lines["World 1"].get_xydata(), [[8, 200.0]])
    assert ax.get_ylim()[1] > 200

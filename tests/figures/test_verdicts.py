import numpy as np
import pyarrow as pa

from animat.figures.verdicts import verdicts_figure

CLAIMS = {"C1": "AF outlives BLIND", "C2": "the same, scarce"}


def shares(*of_claims):
    rows = []
    for claim, parts in zip(CLAIMS, of_claims, strict=True):
        for verdict, share in zip(("holds", "undecided", "fails"), parts, strict=True):
            rows.append(
                {"claim": claim, "verdict": verdict, "share": share, "low": share * 0.9,
                 "high": share * 1.05, "share_by_value": share * 1.1}
            )  # fmt: skip
    return pa.Table.from_pylist(rows)


def test_each_bar_is_cut_into_the_shares(legible):
    fig = verdicts_figure(shares((0.5, 0.3, 0.2), (0.02, 0.0, 0.98)), CLAIMS)
    (ax,) = fig.axes
    widths = np.array([bar.get_width() for bar in ax.patches]).reshape(2, 3)
    np.testing.assert_allclose(widths, [[0.5, 0.3, 0.2], [0.02, 0.0, 0.98]])
    lefts = np.array([bar.get_x() for bar in ax.patches]).reshape(2, 3)
    np.testing.assert_allclose(lefts, [[0.0, 0.5, 0.8], [0.0, 0.02, 0.02]])
    assert [text.get_text() for text in ax.texts] == ["50%", "30%", "20%", "98%"]
    legible(fig)


def test_the_whisker_is_of_what_holds_and_the_diamond_is_by_value():
    (ax,) = verdicts_figure(shares((0.5, 0.3, 0.2), (0.4, 0.3, 0.3)), CLAIMS).axes
    whisker, diamond = ax.lines[:2]
    np.testing.assert_allclose(whisker.get_xdata(), [0.45, 0.525])
    np.testing.assert_allclose(diamond.get_xdata(), [0.55])


def test_a_diamond_at_the_end_of_the_axis_is_whole():
    (ax,) = verdicts_figure(shares((0.0, 0.0, 1.0), (0.9, 0.1, 0.0)), CLAIMS).axes
    diamonds = [line for line in ax.lines if line.get_marker() == "D"]
    assert len(diamonds) == 2
    assert not any(diamond.get_clip_on() for diamond in diamonds)

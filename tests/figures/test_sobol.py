import pyarrow as pa

from animat.figures.sobol import sobol_figure


def test_parameters_come_by_their_largest_total_with_both_orders(legible):
    rows = [
        {"agent": agent, "parameter": name, "order": order, "index": index, "low": index - 0.05,
         "high": index + 0.05}
        for agent in ("BLIND", "AF")
        for name, first, total in (("speed", 0.1, 0.2), ("rate", 0.5, 0.7 + (agent == "AF") / 10))
        for order, index in (("first", first), ("total", total))
    ]  # fmt: skip
    fig = sobol_figure(pa.Table.from_pylist(rows))
    blind, af = fig.axes
    assert [label.get_text() for label in blind.get_yticklabels()] == ["rate", "speed"]
    assert (blind.get_title(), af.get_title()) == ("BLIND", "AF")
    widths = [round(bar.get_width(), 6) for bar in af.patches]
    assert widths == [0.5, 0.1, 0.8, 0.2]
    legible(fig)

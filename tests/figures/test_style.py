import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.figures import style
from animat.files.settings import SettingsError


def luminance(colour):
    values = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    linear = [v / 12.92 if v <= 0.03928 else ((v + 0.055) / 1.055) ** 2.4 for v in values]
    return sum(w * v for w, v in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def test_what_is_known_keeps_its_colour_whoever_else_is_there():
    alone = style.agent_colours(["AF"])["AF"]
    assert style.agent_colours(["ORACLE", "RANDOM", "BLIND", "AF"])["AF"] == alone


def test_nobody_shares_a_colour_while_there_are_enough():
    for each in (style.agent_colours(["BLIND", "AF", "LEARNING", "ORACLE", "RANDOM"]),
                  style.type_colours(["TS", "cube", "TL", "CS", "CL", "star"])):  # fmt: skip
        assert len(set(each.values())) == len(each)


def test_a_hundred_types_have_a_hundred_colours_none_of_which_marks_anything_else():
    colours = set(style.type_colours([f"type {k}" for k in range(100)]).values())
    assert len(colours) == 100
    assert not {style.BLACK, style.GREEN, "#FFFFFF"} & colours


@given(st.permutations(["stamina", "thirst", "nutrition", "fear", "restlessness", "age", "heat"]))
def test_a_need_has_its_colour_in_whatever_order_they_are_listed(variables):
    colours = style.need_colours(variables)
    assert colours == style.need_colours(sorted(variables))
    assert len(set(colours.values())) == len(variables)
    assert set(style.need_colours(["nutrition", "stamina", "restlessness"]).values()) <= set(
        style.PALETTE
    )


def test_types_come_in_the_order_of_table_1():
    assert list(style.type_colours(["CL", "cube", "TS"])) == ["TS", "CL", "cube"]


def test_agents_differ_in_black_and_white_too():
    one, other = (luminance(c) for c in style.agent_colours(["BLIND", "AF"]).values())
    assert (max(one, other) + 0.05) / (min(one, other) + 0.05) > 2


def test_a_folder_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(SettingsError, match="cannot be written"):
        style.save(style.new_figure(1, 1), tmp_path / "none" / "figure")


def test_shades_darken_from_last_to_first_in_black_and_white_too():
    shades = [luminance(colour) for colour in style.shades([str(k) for k in range(8)]).values()]
    assert shades == sorted(shades)
    assert shades[-1] < 0.5  # still seen on white
    assert style.shades(["alone"])


def test_a_logarithmic_axis_is_for_positive_numbers_far_apart():
    assert style.spread_out([1.0, 21.0])
    assert not style.spread_out([1.0, 19.0])
    assert not style.spread_out([0.0, 21.0])
    assert not style.spread_out([])


def test_long_labels_take_fewer_columns():
    assert [style.legend_columns(["x" * n]) for n in (5, 30, 44)] == [3, 2, 1]

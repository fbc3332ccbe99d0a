import pytest
from matplotlib.colors import to_hex

from animat.figures.causes import causes_figure
from animat.statistics.estimates import share
from animat.statistics.survival import ALIVE, DeathCount

WAYS = [
    ("nutrition", "low", "metabolism"),
    ("nutrition", "low", "failure"),
    ("nutrition", "high", "success"),
    ("stamina", "high", "metabolism"),
    (ALIVE, "", ""),
]


def counts(*numbers):
    total = sum(numbers)
    return [DeathCount(*way, n, share(n, total)) for way, n in zip(WAYS, numbers, strict=True) if n]


def bars(fig):
    return [bar for container in fig.axes[0].containers for bar in container.patches]


def test_every_bar_adds_up_and_each_part_is_its_share():
    fig = causes_figure({"AF": counts(10, 20, 0, 30, 40), "BLIND": counts(25, 25, 25, 25, 0)})
    drawn = bars(fig)
    first = [bar.get_width() for bar in drawn if round(bar.get_y() + 0.35) == 0]
    second = [bar.get_width() for bar in drawn if round(bar.get_y() + 0.35) == 1]
    assert sorted(first) == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert second == pytest.approx([0.25] * 4)


def test_colour_is_the_variable_and_pattern_the_cause():
    fig = causes_figure({"all": counts(20, 20, 20, 20, 20)})
    legend = fig.legends[0]
    look = {
        text.get_text(): (to_hex(patch.get_facecolor()), patch.get_hatch())
        for text, patch in zip(legend.get_texts(), legend.get_patches(), strict=True)
    }
    assert len(set(look.values())) == len(look) == 5
    assert look["nutrition too low, metabolism"][0] == look["nutrition too low, failure"][0]
    assert look["nutrition too low, metabolism"][1] == look["stamina too high, metabolism"][1]
    assert list(look)[-1] == ALIVE


def test_two_sides_of_one_variable_do_not_look_alike():
    sides = [DeathCount("energy", side, "metabolism", 1, share(1, 2)) for side in ("low", "high")]
    drawn = bars(causes_figure({"all": sides}))
    assert len({bar.get_hatch() for bar in drawn}) == 2


def test_parts_too_thin_for_a_number_have_none():
    fig = causes_figure({"AF": counts(3, 97, 0, 0, 0)})
    assert [text.get_text() for text in fig.axes[0].texts] == ["97%"]

import pytest

from animat.files.settings import SettingsError
from animat.world.arena import Arena


def test_the_default_is_michels_playground():
    arena = Arena()
    assert (arena.width, arena.height) == (1000.0, 1000.0)
    assert arena.free == (22.0, 978.0, 26.0, 976.0)


def test_margins_shape_the_free_rectangle():
    arena = Arena(width=500, height=400, left=1, right=2, bottom=3, top=4)
    assert arena.free == (1.0, 498.0, 3.0, 396.0)


@pytest.mark.parametrize(
    ("settings", "word"),
    [
        ({"width": 0.0}, "width"),
        ({"height": float("inf")}, "height"),
        ({"left": -1.0}, "left"),
        ({"width": "1000"}, "width"),
        ({"depth": 1.0}, "depth"),
        ({"left": 500.0, "right": 500.0}, "left \\+ right"),
        ({"bottom": 500.0, "top": 500.0}, "bottom \\+ top"),
    ],
)
def test_impossible_arenas_are_refused(settings, word):
    with pytest.raises(SettingsError, match=word):
        Arena(**settings)

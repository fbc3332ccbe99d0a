from itertools import combinations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from animat.world import scatter as module
from animat.world.arena import Arena
from animat.world.layout import Layout, LayoutError, Placement
from animat.world.objects import TABLE_1, ObjectType
from animat.world.scatter import scattered, with_spares

MIX = {"TS": 2, "TL": 1, "CS": 3, "CL": 2}


def dropped(counts, seed=0, gap=70.0, arena=None, types=TABLE_1):
    return scattered(counts, seed, gap, arena or Arena(), types)


def shapes(layout):
    outlines = layout.outlines()
    return [shapely.Polygon(p) for p in np.split(outlines.outline, outlines.first[1:-1])]


def refused(call, *given_values):
    with pytest.raises(LayoutError) as caught:
        call(*given_values)
    return caught.value.problems


@given(st.integers(0, 2**64 - 1), st.floats(0, 80), st.integers(0, 3))
def test_objects_keep_the_gap_from_each_other_and_from_walls(seed, gap, spares):
    layout = with_spares(dropped(MIX, seed, gap), spares, seed, gap)
    found = shapes(layout)
    left, right, bottom, top = layout.arena.free
    walls = shapely.box(left, bottom, right, top).exterior
    assert min(walls.distance(shape) for shape in found) >= gap - 1e-9
    closest = min(a.distance(b) for a, b in combinations(found, 2))
    assert closest >= gap - 1e-9
    assert closest > 0
    assert [p.type for p in layout.placements] == ["TS"] * 2 + ["TL"] + ["CS"] * 3 + ["CL"] * 2
    expected = [name for name in MIX for _ in range(spares)]
    assert [p.type for p in layout.spares] == expected


def test_the_same_seed_gives_the_same_layout_in_any_order_of_counts():
    backwards = dict(reversed(MIX.items()))
    assert dropped(MIX, 5) == dropped(backwards, 5)
    assert dropped(MIX, 5) != dropped(MIX, 6)
    assert dropped(MIX, 5) != dropped(MIX, 5 + 2**32)


def test_places_and_angles_are_spread_evenly():
    placements = [dropped({"CS": 1}, seed).placements[0] for seed in range(600)]
    x, y, angle = np.array([(p.x, p.y, p.angle) for p in placements]).T
    # The corners of a square of 38 mm lie 26.9 mm from its centre, and 70 mm are kept free.
    for values, low, high in (
        (x, 22 + 95, 978 - 95), (y, 26 + 95, 976 - 95), (angle, 0, 2 * np.pi),
    ):  # fmt: skip
        counts = np.histogram(values, bins=6, range=(low, high))[0]
        assert ((counts - 100) ** 2 / 100).sum() < 25
    assert np.abs(np.corrcoef([x, y, angle]) - np.eye(3)).max() < 0.15


def test_forty_objects_fit_a_square_metre_with_a_gap_of_50():
    for seed in range(5):
        layout = dropped(dict.fromkeys(MIX, 10), seed, gap=50.0)
        assert len(layout.placements) == 40


def test_a_large_arena_takes_many():
    layout = dropped(dict.fromkeys(MIX, 120), 1, 40.0, Arena(width=4000, height=4000))
    assert len(layout.placements) == 480


def test_counts_that_do_not_fit_are_told_with_what_fits():
    (told,) = refused(dropped, {"TS": 3, "CL": 60})
    assert told.startswith("the objects do not fit into 956 x 950 mm with gaps of 70 mm: room was ")
    room = int(told.split("found for ")[1].split("3 of 3 TS, ")[-1].split(" of 60 CL")[0])
    assert 10 < room < 60
    assert "smaller gap" in told


@pytest.mark.parametrize("count", [261, 10**9, 10**400])
def test_so_many_that_they_cannot_fit_are_refused_without_a_try(count, monkeypatch):
    """Even as points, each with 35 mm round it, 260 would fill the square metre."""
    monkeypatch.setattr(module, "_dropped", None)
    (told,) = refused(dropped, {"TS": count, "CL": 1})
    assert told.startswith("the objects do not fit into 956 x 950 mm with gaps of 70 mm: by their")
    (told,) = refused(
        with_spares, Layout(placements=(Placement(type="TS", x=500, y=500),)), count, 1, 70.0
    )
    assert told.startswith("the spare sites do not fit")
    (told,) = refused(dropped, {"TS": 10**9}, 1, 1e300)
    assert told.startswith("the objects do not fit")


def test_what_just_fills_the_arena_is_tried():
    """Squares of 90 mm in rows, 10 mm apart."""
    tile = ObjectType(name="tile", shape=4, size_mm=90, features={"a": 0.0}, affords={"b": 1.0})
    room = Arena(width=1000, height=1000, left=45, right=45, bottom=45, top=45)
    module._refuse_too_many(room, {tile: 81}, 10.0, "objects")
    with pytest.raises(LayoutError, match="do not fit"):
        module._refuse_too_many(room, {tile: 100}, 10.0, "objects")


def test_every_impossible_count_is_told():
    told = refused(dropped, {"ts": 1, "TS": -1, "CL": 1.5, "CS": True}, -1, float("nan"))
    assert [line.split(":")[0].split(" =")[0] for line in told] == [
        "counts", "counts", "counts", "counts", "seed", "gap",
    ]  # fmt: skip
    assert told[0] == 'counts: unknown type ts; did you mean "TS"?'
    assert refused(dropped, {"TS": 1}, 2**64)[0].startswith("seed")


def test_no_objects_are_a_layout():
    assert dropped({}).sites == dropped({"TS": 0}).sites == ()


def test_users_types_are_dropped_too():
    arrow = ObjectType(
        name="arrow", shape=[[0, 0], [60, 20], [0, 40], [20, 20]], features={"a": 0.0},
        affords={"b": 1.0},
    )  # fmt: skip
    layout = dropped({"arrow": 12}, 3, 40.0, types=(arrow,))
    found = shapes(layout)
    assert min(a.distance(b) for a, b in combinations(found, 2)) >= 40 - 1e-9


def test_spares_are_of_the_types_that_occur_and_leave_the_objects_alone():
    layout = dropped({"TS": 2, "CL": 1}, 4)
    more = with_spares(layout, 2, 4, 70.0)
    assert more.placements == layout.placements
    assert [p.type for p in more.spares] == ["TS", "TS", "CL", "CL"]
    assert with_spares(layout, 2, 4, 70.0) == more
    assert with_spares(layout, 2, 5, 70.0) != more
    assert with_spares(layout, 0, 4, 70.0) == layout
    assert with_spares(more, 1, 9, 70.0).spares[:4] == more.spares


def test_spares_draw_from_a_stream_of_their_own():
    objects = dropped({"CS": 2}, 4).placements
    assert with_spares(dropped({"CS": 1}, 4), 1, 4, 70.0).spares[0] != objects[1]


def test_spares_with_a_gap_of_their_own_make_a_valid_layout():
    layout = Layout(placements=(Placement(type="CL", x=500, y=500),))
    more = with_spares(layout, 20, 1, 30.0)
    assert len(more.spares) == 20
    assert more.minimum_gap == 30.0


def test_spares_that_do_not_fit_are_told():
    (told,) = refused(with_spares, dropped({"TL": 10}, 1), 20, 1, 70.0)
    assert told.startswith("the spare sites do not fit")
    assert "of 20 TL" in told


@pytest.mark.parametrize("n", [-1, 1.5, True])
def test_an_impossible_number_of_spares_is_refused(n):
    (told,) = refused(with_spares, dropped({"TL": 1}, 1), n, 1, 70.0)
    assert told.startswith("spares")

import numpy as np
import pytest

from animat.files.settings import SettingsError
from animat.world.arena import Arena
from animat.world.layout import Layout, LayoutError, Placement
from animat.world.objects import TABLE_1, ObjectType


def at(kind, x, y, angle=0.0):
    return Placement(type=kind, x=x, y=y, angle=angle)


def problems(*placements, **settings):
    with pytest.raises(LayoutError) as caught:
        Layout(placements=placements, **settings)
    return caught.value.problems


def own(name, **changes):
    known = {"shape": "square", "size_mm": 38.0, "features": {"a": 1.0}, "affords": {"b": 0.5}}
    return ObjectType(**{"name": name, **known, **changes})


def test_sites_are_the_objects_then_the_spares():
    layout = Layout(
        placements=(at("CL", 300, 300), at("TS", 500, 300)), spares=(at("CS", 700, 300),)
    )
    assert [site.type for site in layout.sites] == ["CL", "TS", "CS"]
    np.testing.assert_array_equal(layout.site_types(), [3, 0, 2])
    assert layout.site_types().dtype == np.int64
    outlines = layout.outlines()
    np.testing.assert_array_equal(np.diff(outlines.first), [8, 3, 4])
    np.testing.assert_array_equal(outlines.centre, [(300, 300), (500, 300), (700, 300)])


@pytest.mark.parametrize("angle", [1e6, -1e6, 12.0])
def test_an_object_may_be_turned_however_often(angle):
    outline = Layout(placements=(at("TS", 500.0, 500.0, angle),)).outlines().outline
    sides = np.hypot(*(outline - np.roll(outline, 1, axis=0)).T)
    np.testing.assert_allclose(sides, 45.0, atol=1e-6)


@pytest.mark.parametrize("angle", [np.nextafter(1e6, 2e6), -1e7, 1e308])
def test_an_object_turned_beyond_what_has_a_sine_is_refused(angle):
    with pytest.raises(SettingsError, match="angle"):
        at("TS", 500.0, 500.0, float(angle))


def test_an_empty_arena_is_a_layout():
    assert len(Layout(placements=()).outlines().reach) == 0


def test_overlapping_objects_are_named():
    assert problems(at("CL", 500, 520), at("TL", 300, 300), at("TS", 530, 540)) == (
        "object 0 (CL at 500, 520) overlaps object 2 (TS at 530, 540); move one of them",
    )


def test_one_object_within_another_overlaps_it():
    (told,) = problems(at("CL", 500, 500), at("CS", 500, 500), minimum_gap=0.0)
    assert "overlaps" in told


def test_objects_that_touch_are_refused_whatever_the_gap():
    (told,) = problems(at("CS", 500, 500), at("CS", 538, 500), minimum_gap=0.0)
    assert "overlaps" in told
    Layout(placements=(at("CS", 500, 500), at("CS", 538.01, 500)), minimum_gap=0.0)


def test_a_gap_that_leaves_the_robot_no_room_names_both_objects():
    assert problems(at("CS", 500, 500), at("CS", 607.5, 500)) == (
        "object 0 (CS at 500, 500) is 69.5 mm from object 1 (CS at 607.5, 500); "
        "the robot needs 70 mm between them",
    )
    Layout(placements=(at("CS", 500, 500), at("CS", 608, 500)))
    Layout(placements=(at("CS", 500, 500), at("CS", 560, 500)), minimum_gap=20.0)


def test_spares_keep_the_gap_too():
    (told,) = problems(at("CS", 500, 500), spares=(at("CS", 600, 500),))
    assert told.startswith("object 0 (CS at 500, 500) is 62.0 mm from spare site 1 (CS at 600")


@pytest.mark.parametrize(
    ("x", "y"), [(40.9, 500), (959.1, 500), (500, 44.9), (500, 957.1), (-500, 500), (500, 5000)]
)
def test_an_object_that_leaves_the_arena_is_named(x, y):
    (told,) = problems(at("CS", x, y), minimum_gap=0.0)
    assert told == (
        f"object 0 (CS at {x:g}, {y:g}) leaves the free part of the arena "
        "(x 22 to 978, y 26 to 976 mm)"
    )


@pytest.mark.parametrize(("x", "y"), [(110.9, 500), (889.1, 500), (500, 114.9), (500, 887.1)])
def test_an_object_too_near_a_wall_is_named(x, y):
    (told,) = problems(at("CS", x, y))
    assert told == (
        f"object 0 (CS at {x:g}, {y:g}) is 69.9 mm from the wall; "
        "the robot needs 70 mm between them"
    )
    toward_centre = np.sign([500 - x, 500 - y])
    Layout(placements=(at("CS", *(np.array([x, y]) + 0.2 * toward_centre).tolist()),))


def test_an_unknown_type_is_named_with_the_nearest():
    assert problems(at("CL", 300, 300), at("cl", 500, 500)) == (
        'object 1 (cl at 500, 500): unknown type; did you mean "CL"?',
    )


def test_every_problem_is_told_at_once():
    told = problems(
        at("XX", 500, 500), at("CS", 0, 500), at("CL", 300, 300), at("CL", 310, 300),
        at("TS", 600, 60),
    )  # fmt: skip
    assert [line.split(" (")[0] for line in told] == [
        "object 0", "object 1", "object 4", "object 2",
    ]  # fmt: skip


def test_a_crowd_is_told_briefly():
    told = problems(*[at("CS", 500, 500)] * 20)
    assert told[-1] == "and 140 more pairs of sites are too close"
    assert len(told) == 51


@pytest.mark.parametrize(
    ("arena", "placements"),
    [
        (Arena(width=99, height=500, left=0, right=0), ()),
        (Arena(width=500, height=99, bottom=0, top=0), ()),
        (Arena(width=120, height=120, left=31, right=31), ()),
        (Arena(width=200, height=200), (at("CL", 100, 100),)),
    ],
)
def test_an_arena_without_room_to_start_is_refused(arena, placements):
    (told,) = problems(*placements, arena=arena, minimum_gap=0.0)
    assert told.startswith("no room to start")


def test_a_little_room_to_start_is_enough():
    Layout(
        placements=(at("CL", 100, 100),), minimum_gap=0.0,
        arena=Arena(width=220, height=200, left=20, right=20, bottom=20, top=20),
    )  # fmt: skip


@pytest.mark.parametrize("gap", [-1.0, float("nan"), float("inf")])
def test_an_impossible_gap_is_refused(gap):
    (told,) = problems(at("CS", 500, 500), minimum_gap=gap)
    assert told.startswith("minimum_gap")


def test_types_of_one_world_share_their_names():
    assert problems(
        types=(own("x"), own("y", features={"c": 1.0}), own("z", affords={"d": 0.0}))
    ) == (
        "type y: features are c, but those of x are a; all types of a world have the same",
        "type z: affords are d, but those of x are b; all types of a world have the same",
    )
    assert problems(types=(own("x"), own("x"))) == (
        "type x: defined 2 times; every type needs its own name",
    )
    assert problems(types=()) == ("types: there are none; a world needs at least one object type",)


def test_equal_layouts_hash_alike():
    one = Layout(placements=(at("CS", 500, 500),))
    two = Layout(placements=(at("CS", 500, 500),), types=tuple(TABLE_1))
    assert one == two
    assert hash(one) == hash(two)
    assert one != Layout(placements=(at("CS", 500, 501),))

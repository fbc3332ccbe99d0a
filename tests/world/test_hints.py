"""Likely slips in a world: what is told of them, and that the paper's worlds have none."""

import math

import pytest

from animat.world.arena import Arena
from animat.world.files import WorldFile, world_file
from animat.world.hints import IN_REACH, hints_of_file, hints_of_world, room
from animat.world.layout import Layout, Placement
from animat.world.objects import TABLE_1, ObjectType
from animat.world.world import World


def of_file(objects, types=TABLE_1, **further):
    placed = tuple(Placement(**one) for one in objects)
    return list(hints_of_file(WorldFile(name="x", objects=placed, types=types, **further)))


def kind(name, **changes):
    usual = {"shape": "square", "size_mm": 40.0, "features": {"f": 1.0}, "affords": {"grasp": 1.0}}
    return ObjectType(name=name, **(usual | changes))


def test_the_worlds_of_the_paper_have_no_slips():
    for world in (World.abundant(), World.scarce()):
        file = world_file(world.name, world.layout, world.resolution)
        assert not [*hints_of_file(file), *hints_of_world(world, world.raster(IN_REACH))]


def test_an_angle_of_more_than_a_turn_is_taken_for_degrees():
    one = kind("a")
    (hint,) = of_file([{"type": "a", "x": 1.0, "y": 2.0, "angle": 45.0}], (one,))
    assert hint == (
        "object 0 (a at 1, 2): angle = 45 rad is more than a turn; if it is in degrees,"
        " write 0.7854"
    )
    assert not of_file([{"type": "a", "x": 1.0, "y": 2.0, "angle": -2 * math.pi}], (one,))
    many = of_file(
        [{"type": "a", "x": float(n), "y": 2.0, "angle": 90.0} for n in range(30)], (one,)
    )
    assert len(many) == 11
    assert "and 19 more" in many[-1]


SLIPS = [
    ((kind("a", size_mm=1.5),), "type a: is 1.5 mm wide, less than a cell of the map"),
    ((kind("a"), kind("b", features={"f": 0.0})), "type b: no object is of this type"),
    ((kind("a", affords={"grasp": 0.0}),), "no object affords grasp"),
]


@pytest.mark.parametrize(("types", "told"), SLIPS)
def test_a_likely_slip_is_told(types, told):
    (hint,) = of_file([{"type": "a", "x": 1.0, "y": 2.0}], types)
    assert hint.startswith(told)


def test_types_that_no_network_can_tell_apart_are_told():
    types = (kind("a"), kind("b", affords={"grasp": 0.0}))
    objects = [{"type": name, "x": 1.0, "y": 2.0} for name in "ab"]
    (hint,) = of_file(objects, types)
    assert hint.startswith("types a and b have the same features")


def walled(gap, resolution=4.0):
    """A room cut in two by a wall of posts, with a way of `gap` mm, and a stone at the far end."""
    post = kind("post", shape=[[0, 0], [20, 0], [20, 400 - gap], [0, 400 - gap]], size_mm=None)
    stone = kind("stone")
    arena = Arena(width=800.0, height=400.0, left=0.0, right=0.0, bottom=0.0, top=0.0)
    objects = (
        Placement(type="post", x=400.0, y=200.0 - gap / 2 + 0.01),
        Placement(type="stone", x=700.0, y=200.0),
    )
    layout = Layout(objects, (post, stone), arena=arena, minimum_gap=0.0)
    return World(layout, resolution=resolution)


def test_parts_that_no_way_joins_are_told():
    for gap, parts in ((20.0, 1), (100.0, 0)):
        world = walled(gap)
        hints = list(hints_of_world(world, world.raster(IN_REACH)))
        assert len(hints) == parts
        assert not hints or "robots can start in 2 parts" in hints[0]


def test_an_object_in_a_corner_that_nobody_reaches_is_told():
    fence = kind("fence", shape=[[0, 0], [10, 0], [10, 400], [0, 400]], size_mm=None)
    arena = Arena(width=600.0, height=401.0, left=45.0, right=0.0, bottom=0.0, top=0.0)
    objects = (
        Placement(type="fence", x=100.0, y=200.5),
        Placement(type="stone", x=60.0, y=60.0),
    )
    types = (fence, kind("stone", size_mm=10.0))
    layout = Layout(objects, types, arena=arena, minimum_gap=0.0)
    world = World(layout)
    (hint,) = hints_of_world(world, world.raster(IN_REACH))
    assert hint == "object 1 (stone at 60, 60): is out of reach: no way of 60 mm leads there"


def test_how_much_is_free_is_measured():
    arena = Arena(width=500.0, height=400.0, left=0.0, right=0.0, bottom=0.0, top=0.0)
    world = World(Layout((Placement(type="a", x=250.0, y=200.0),), (kind("a"),), arena=arena))
    found = room(world.raster(IN_REACH))
    assert found.free == pytest.approx(0.5 * 0.4 - 0.04 * 0.04, abs=1e-4)
    round_object = 0.04**2 + 4 * 0.04 * 0.03 + math.pi * 0.03**2
    assert found.roomy == pytest.approx(0.44 * 0.34 - round_object, rel=0.02)

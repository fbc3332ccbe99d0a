"""What a world is made of shows in the lives that are lived in it."""

import math

import numpy as np
import pytest
import shapely

from animat.world.arena import Arena
from animat.world.layout import Layout, Placement
from animat.world.objects import TABLE_1
from animat.world.world import World


def world_of(types=TABLE_1, names=("TS", "TL", "CS", "CL"), **settings):
    return World.random(
        dict.fromkeys(names, 1),
        seed=1,
        arena=Arena(width=560.0, height=560.0),
        types=types,
        **settings,
    )


def with_changed(**changes):
    return tuple(kind.model_copy(update=changes) for kind in TABLE_1)


def test_world_features(lived, trained):
    same = with_changed(features={"shape": 0.0, "size": 0.0})
    c = lived(world=world_of(same), agent="AF", networks=trained, steps=6_000)
    said = set(c["likelihood_eat"][~np.isnan(c["likelihood_eat"])])
    wanted = trained.likelihoods({"shape": 0.0, "size": 0.0})["eat"]
    assert list(said) == pytest.approx([wanted])
    met = set(c["object"]) - {None}
    assert len(met) > 1


@pytest.mark.parametrize("probability", [0.0, 0.5, 1.0])
def test_world_affords(probability, lived, affording):
    c = lived(world=affording(probability), gate="always", steps=20_000)
    rewards = c["reward"][c["reward"] != 0]
    assert len(rewards) > 50
    share = (rewards == 1).mean()
    spread = 4 * math.sqrt(probability * (1 - probability) / len(rewards))
    assert abs(share - probability) <= spread


def alone(kind, x=280.0, y=280.0, angle=0.0, **changes):
    types = with_changed(**changes) if changes else TABLE_1
    layout = Layout(
        placements=(Placement(type=kind, x=x, y=y, angle=angle),),
        types=types,
        arena=Arena(width=560.0, height=560.0),
    )
    return World(layout=layout, name="alone")


@pytest.mark.parametrize(
    ("world", "least", "most"),
    [
        (alone("CS"), 19.0, 19.0 * math.sqrt(2)),
        (alone("CS", size_mm=60.0), 30.0, 30.0 * math.sqrt(2)),
        (alone("CS", shape="octagon", size_mm=60.0), 30.0, 30.0 / math.cos(math.pi / 8)),
    ],
    ids=["as it is", "size", "shape"],
)
def test_world_shape_and_size(world, least, most, lived):
    """How far the centre of the object is when it is met tells how large it is."""
    c = lived(world=world, steps=20_000)
    met = np.flatnonzero(c.happened("encounter"))
    met = met[met > 0]
    assert len(met) > 8
    away = np.hypot(c["x"][met] - 280.0, c["y"][met] - 280.0)
    assert least + 57.5 - 5.0 <= away.min()
    assert away.max() <= most + 57.5 + 2.0


def test_world_places(lived):
    for x, y in ((200.0, 300.0), (350.0, 260.0)):
        c = lived(world=alone("CL", x=x, y=y))
        met = np.flatnonzero(c.happened("encounter"))
        assert np.hypot(c["x"][met] - x, c["y"][met] - y).max() < 54.2 + 57.5 + 2.0


def test_world_counts(lived):
    c = lived(world=world_of(names=("TS", "CS")), steps=6_000)
    assert set(c["object"]) == {"TS", "CS", None}


def test_world_arena(lived):
    wide = World.random({"TS": 1}, seed=1, arena=Arena(width=900.0, height=400.0))
    c = lived(world=wide, steps=10_000)
    assert 700.0 < c["x"].max() < 878.0
    assert c["y"].max() < 376.0


def test_world_resolution(lived):
    """Where the world is drawn finer, an encounter begins nearer to its range."""
    far = {}
    for resolution in (1.0, 8.0):
        world = World(layout=alone("CL").layout, resolution=resolution)
        c = lived(world=world, steps=10_000)
        met = np.flatnonzero(c.happened("encounter"))
        met = met[met > 0]
        gap = octagon_distance(c["x"][met] - 280.0, c["y"][met] - 280.0)
        far[resolution] = np.abs(gap - 57.5).max()
    assert far[1.0] < 2.5 * 1.1 + 1.0
    assert far[8.0] > far[1.0]


def octagon_distance(x, y):
    """How far (mm) points are from an octagon 100 mm across flats at the origin."""
    [polygon] = alone("CL", 280.0, 280.0).polygons()
    return shapely.distance(shapely.points(x, y), shapely.Polygon(polygon - 280.0))

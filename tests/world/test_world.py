from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
import shapely

from animat.files.settings import SettingsError
from animat.world.arena import Arena
from animat.world.layout import Layout, LayoutError, Placement
from animat.world.objects import TABLE_1, ObjectType
from animat.world.raster import FIRST_SITE
from animat.world.world import World

SMALL = Arena(width=400, height=400)


def test_the_papers_worlds_share_an_arena_and_world_2_has_fewer_objects():
    abundant, scarce = World.abundant(), World.scarce()
    assert (abundant.name, scarce.name) == ("abundant", "scarce")
    assert abundant.arena == scarce.arena == Arena()
    assert abundant.types == scarce.types == TABLE_1
    assert scarce.n_objects < abundant.n_objects
    for world in (abundant, scarce):
        assert set(Counter(p.type for p in world.layout.placements)) == {"TS", "TL", "CS", "CL"}
        assert world.n_sites == world.n_objects
        assert world.resolution == 2.0


def test_names_stand_in_the_order_of_the_columns():
    flipped = TABLE_1[3].model_copy(
        update={
            "features": dict(reversed(TABLE_1[3].features.items())),
            "affords": dict(reversed(TABLE_1[3].affords.items())),
        }
    )
    world = World.random({"CL": 1}, types=(*TABLE_1[:3], flipped), arena=SMALL, resolution=5.0)
    assert world.feature_names == ("shape", "size")
    assert world.affordances == ("grasp", "shelter", "interact")
    raster = world.raster(20.0)
    np.testing.assert_array_equal(raster.features, [(0, 0), (0, 1), (1, 0), (1, 1)])
    np.testing.assert_array_equal(raster.affords, [(1, 0, 1), (0, 1, 1), (1, 0, 1), (0, 1, 1)])
    np.testing.assert_array_equal(raster.site_type, [3])


def test_random_worlds_are_functions_of_their_arguments():
    counts = {"TS": 2, "CL": 1}
    world = World.random(counts, seed=3)
    assert world == World.random(counts, seed=3)
    assert world.layout != World.random(counts, seed=4).layout
    assert (world.n_objects, world.n_sites) == (3, 3)
    with_more = World.random(counts, seed=3, spares=2)
    assert with_more.layout.placements == world.layout.placements
    assert (with_more.n_objects, with_more.n_sites) == (3, 7)
    assert with_more.layout == world.with_spares(2, seed=3).layout
    assert World.random(counts, gap=12.5).layout.minimum_gap == 12.5
    assert World.random(counts, name="mine").name == "mine"


def test_a_random_world_that_does_not_fit_is_refused():
    with pytest.raises(LayoutError, match="do not fit"):
        World.random({"CL": 20}, arena=SMALL)


def test_spares_take_the_layouts_gap_unless_told():
    world = World.random({"CS": 2}, gap=55.0)
    assert world.with_spares(1).layout.minimum_gap == 55.0
    assert world.with_spares(1, gap=20.0).layout.minimum_gap == 20.0


def test_polygons_are_what_is_drawn():
    world = World.random({"TS": 1, "TL": 1, "CS": 1, "CL": 1}, seed=2, spares=1)
    polygons = world.polygons()
    assert [len(p) for p in polygons] == [3, 3, 4, 8] * 2
    raster = world.raster(30.0)
    for s, corners in enumerate(polygons):
        shape = shapely.Polygon(corners)
        np.testing.assert_allclose(
            shape.centroid.coords[0], (raster.site_x[s], raster.site_y[s]), atol=1e-6
        )
        cells = (raster.solid == FIRST_SITE + s).sum() * raster.resolution**2
        assert cells == pytest.approx(shape.area, rel=0.05)
    assert World.random({}).polygons() == []


def test_equal_worlds_share_a_raster_for_each_horizon():
    one, two = (World.random({"CS": 1}, arena=SMALL, resolution=5.0) for _ in range(2))
    assert one is not two
    assert hash(one) == hash(two)
    assert one.raster(30.0) is two.raster(30)
    assert one.raster(30.0) is not one.raster(40.0)
    finer = replace(one, resolution=4.0)
    assert finer.raster(30.0).resolution == 4.0
    assert finer.raster(30.0).solid.shape != one.raster(30.0).solid.shape


def test_another_affordance_is_another_raster():
    changed = TABLE_1[2].model_copy(update={"affords": {"grasp": 0.5, "shelter": 0, "interact": 1}})
    place = (Placement(type="CS", x=200, y=200),)
    one = World(Layout(placements=place, arena=SMALL), resolution=5.0)
    two = World(Layout(placements=place, arena=SMALL, types=(changed,)), resolution=5.0)
    assert one.raster(30.0).affords[2, 0] == 1.0
    assert two.raster(30.0).affords[0, 0] == 0.5


def test_a_world_is_saved_and_loaded(tmp_path):
    world = World.random({"TS": 2, "CL": 1}, seed=8, spares=1, resolution=2.5, gap=60)
    world.save(tmp_path / "w.toml")
    assert World.load(tmp_path / "w.toml") == world
    assert World.load(str(tmp_path / "w.toml")) == world


@pytest.mark.parametrize("resolution", [0.0, -2.0, 51.0, float("nan")])
def test_an_impossible_resolution_is_refused(resolution):
    with pytest.raises(SettingsError, match="resolution"):
        World.random({}, resolution=resolution)


def test_a_world_cannot_be_changed():
    with pytest.raises(AttributeError):
        World.abundant().name = "other"


def test_a_world_of_ones_own_types():
    own = tuple(
        ObjectType(
            name=f"t{i}", shape=5 + i, size_mm=30.0, affords={"roll": i / 4},
            features={f"f{k}": float(i * k) for k in range(5)},
        )
        for i in range(3)
    )  # fmt: skip
    world = World.random({"t0": 1, "t2": 2}, types=own, arena=SMALL, resolution=5.0)
    raster = world.raster(20.0)
    assert raster.features.shape == (3, 5)
    np.testing.assert_array_equal(raster.affords[:, 0], [0, 0.25, 0.5])
    np.testing.assert_array_equal(raster.site_type, [0, 2, 2])

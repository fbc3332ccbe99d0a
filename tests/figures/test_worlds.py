import numpy as np
import pytest
from matplotlib.patches import Circle, Polygon, Wedge

from animat.figures import style
from animat.figures.worlds import worlds_figure


def patches(ax, kind):
    return [patch for patch in ax.patches if type(patch) is kind]


def test_objects_stand_where_they_stand_in_the_colour_of_their_type(world, robot):
    drawn = world("World 1", 12)
    (ax,) = worlds_figure([drawn], robot).axes
    shapes = patches(ax, Polygon)
    fills = style.type_colours(drawn.types)
    assert len(shapes) == 12
    for shape, polygon, name in zip(shapes, drawn.polygons, drawn.types, strict=True):
        np.testing.assert_array_equal(shape.get_xy()[:-1], polygon)
        assert style.colours([name], fills)[name].lower() == to_hex(shape.get_facecolor())


def to_hex(colour):
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour[:3])


def test_worlds_are_drawn_to_one_scale(world, robot):
    small = world("small", 3)
    large = world("large", 3, width=2000.0, height=2000.0, free=(22.0, 1978.0, 26.0, 1976.0))
    fig = worlds_figure([small, large], robot)
    style.png(fig, dpi=100)
    scales = [ax.transData.transform([(0, 0), (100, 100)]) for ax in fig.axes]
    lengths = [far - near for near, far in scales]
    np.testing.assert_allclose(lengths[0], lengths[1], rtol=1e-6)
    assert lengths[0][0] == pytest.approx(lengths[0][1])


def test_the_robot_is_drawn_with_its_sensors_where_they_point(world, robot):
    (ax,) = worlds_figure([world("World", 1, pose=(300.0, 400.0, np.pi / 2))], robot).axes
    (body,) = patches(ax, Circle)
    assert body.center == (300.0, 400.0)
    assert body.radius == robot.radius
    wedges = patches(ax, Wedge)
    assert len(wedges) == 8
    # The third sensor looks ahead; the robot faces up, so what is left of it is at smaller x.
    assert wedges[2].center == pytest.approx((300.0 - 5.5, 400.0 + 24.5))
    assert (wedges[2].theta1 + wedges[2].theta2) / 2 == pytest.approx(90.0)
    assert all(wedge.r == robot.reach for wedge in wedges)


def test_no_robot_is_drawn_where_none_stands(world, robot):
    fig = worlds_figure([world("World", 2, pose=None)], robot)
    assert not patches(fig.axes[0], Circle)
    labels = [text.get_text() for text in fig.legends[0].get_texts()]
    assert labels == ["TS, small triangle", "TL, large triangle"]


def test_the_title_counts_the_objects(world, robot):
    fig = worlds_figure([world("World 1", 1), world("World 2", 5)], robot)
    assert [ax.get_title() for ax in fig.axes] == ["World 1: 1 object", "World 2: 5 objects"]

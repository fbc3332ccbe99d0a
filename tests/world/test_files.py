import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.files.settings import SettingsError
from animat.names import malformed
from animat.world.arena import Arena
from animat.world.files import read_world, write_world
from animat.world.layout import MOST_SITES, Layout, LayoutError, Placement
from animat.world.objects import TABLE_1, ObjectType

ONE = 'name = "one"\nobjects = [{ type = "TS", x = 500, y = 400.5 }]\n'


def problems(tmp_path, text, kind=SettingsError):
    path = tmp_path / "mine.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(kind) as caught:
        read_world(path)
    start = f"{path}: "
    assert all(line.startswith(start) for line in caught.value.problems)
    return [line.removeprefix(start) for line in caught.value.problems]


def test_a_short_file_takes_the_documented_defaults(tmp_path):
    path = tmp_path / "one.toml"
    path.write_text(ONE)
    name, layout, resolution = read_world(path)
    assert (name, resolution) == ("one", 2.0)
    assert layout == Layout(placements=(Placement(type="TS", x=500.0, y=400.5, angle=0.0),))
    assert layout.types == TABLE_1
    assert layout.arena == Arena()


text = st.text(st.characters(codec="utf-8"), max_size=12).filter(lambda t: not malformed(t))
number = st.floats(-1e6, 1e6)


@given(
    name=text, features=st.dictionaries(text, number, min_size=1, max_size=3),
    affords=st.dictionaries(text, st.floats(0, 1), min_size=1, max_size=3),
    x=st.floats(200, 400), angle=number, resolution=st.floats(0.1, 50), gap=st.floats(0, 90),
)  # fmt: skip
def test_what_is_written_is_read_back(
    tmp_path_factory, name, features, affords, x, angle, resolution, gap
):
    kind = {"features": features, "affords": affords}
    own = (
        ObjectType(name='it\'s "α"', shape=7, size_mm=20.0, **kind),
        ObjectType(name="own", shape=[[0, 0], [30, 0], [0, 30]], **kind),
    )
    layout = Layout(
        placements=(Placement(type=own[0].name, x=x, y=400.0, angle=angle),), types=own,
        spares=(Placement(type="own", x=650.0, y=x),), arena=Arena(left=1.5), minimum_gap=gap,
    )  # fmt: skip
    path = tmp_path_factory.mktemp("world") / "w.toml"
    write_world(path, name, layout, resolution)
    assert read_world(path) == (name, layout, resolution)
    assert [p.name for p in path.parent.iterdir()] == ["w.toml"]


def test_an_empty_arena_is_written_and_read(tmp_path):
    write_world(tmp_path / "w.toml", "none", Layout(placements=()), 2.0)
    assert read_world(tmp_path / "w.toml")[1] == Layout(placements=())
    assert tomllib.loads((tmp_path / "w.toml").read_text())["objects"] == []


def test_a_missing_or_empty_file_is_never_a_default(tmp_path):
    with pytest.raises(SettingsError, match=r"none\.toml: no such file"):
        read_world(tmp_path / "none.toml")
    with pytest.raises(SettingsError, match="is a directory"):
        read_world(tmp_path)
    assert problems(tmp_path, "") == ["is empty: it sets nothing"]
    assert problems(tmp_path, "resolution = 2") == [
        "key name: missing key; it must be given", "key objects: missing key; it must be given",
    ]  # fmt: skip


def test_what_is_no_toml_is_told_with_its_line(tmp_path):
    (told,) = problems(tmp_path, 'name = "a"\nx = [')
    assert told.startswith("is not TOML: ")
    assert "line 2" in told or "end of document" in told
    (told,) = problems(tmp_path, b"PAR1\xff\xfe")
    assert "UTF-8" in told


def test_every_mistake_is_told_with_key_value_and_what_is_allowed(tmp_path):
    told = problems(
        tmp_path,
        """
        nmae = "a"
        resolution = "2"
        minimum_gap = -1
        objects = [7, { type = "ST", x = 1, y = 1 }, { type = "TS", x = 1, y = true, angel = 1 }]
        [arena]
        widht = 3
        [[types]]
        name = "TS"
        shape = "triangle"
        size_mm = 4
        features = { a = 1 }
        affords = { b = 1 }
        [[spares]]
        type = "TSS"
        x = 1
        y = 1
        [[spares]]
        type = "TS"
        x = nan
        y = 1
        """,
    )
    assert sorted(told) == sorted(
        [
            "key name: missing key; it must be given",
            'key nmae: unknown key; did you mean "name"?',
            'key resolution = "2": must be a number',
            "key minimum_gap = -1: must be greater than or equal to 0",
            'key arena.widht: unknown key; did you mean "width"?',
            "key objects[0] = 7: must be a table",
            'key objects[1]: type "ST" is unknown; did you mean "TS"?',
            "key objects[2].y = true: must be a number",
            'key objects[2].angel: unknown key; did you mean "angle"?',
            'key spares[0]: type "TSS" is unknown; did you mean "TS"?',
            "key spares[1].x = nan: must be a finite number",
        ]
    )


def test_every_mistake_in_the_types_is_told_too(tmp_path):
    told = problems(
        tmp_path,
        ONE
        + """
        [[types]]
        name = "TS"
        shape = "trangle"
        size_mm = 4
        features = { a = 1 }
        affords = { b = 2 }
        """,
    )
    assert told == [
        'key types[0].shape = "trangle": unknown shape; allowed: triangle, square, '
        "pentagon, hexagon, octagon, a number of sides, or corners [[x, y], ...] in mm; "
        'did you mean "triangle"?',
        "key types[0].affords.b = 2: must be less than or equal to 1",
    ]


def test_no_types_are_refused(tmp_path):
    (told,) = problems(tmp_path, 'name = "a"\nobjects = []\ntypes = []\n')
    assert told.startswith("types: there are none")


def test_an_impossible_arena_is_told_by_its_key(tmp_path):
    (told,) = problems(tmp_path, ONE + "[arena]\nleft = 990.0\n")
    assert told.startswith("key arena: left + right = 1012 mm leave nothing free")


def test_an_impossible_layout_is_told_with_the_file(tmp_path):
    told = problems(tmp_path, ONE + '[[spares]]\ntype = "CL"\nx = 500\ny = 410\n', LayoutError)
    assert told == [
        "object 0 (TS at 500, 400.5) overlaps spare site 1 (CL at 500, 410); move one of them"
    ]


def test_a_path_that_cannot_be_written_is_told(tmp_path):
    with pytest.raises(SettingsError, match=r"w\.toml: cannot be written: No such file"):
        write_world(tmp_path / "none" / "w.toml", "a", Layout(placements=()), 2.0)


def test_as_many_sites_as_a_world_may_have_fit_a_file(tmp_path):
    side = 180  # 180 x 180 > 32,000
    sites = tuple(
        Placement(type="CS", x=1000.125 + 150 * (i % side), y=1000.125 + 150 * (i // side))
        for i in range(MOST_SITES)
    )
    layout = Layout(placements=sites, arena=Arena(width=30_000, height=30_000))
    write_world(tmp_path / "w.toml", "crowd", layout, 2.0)
    assert (tmp_path / "w.toml").stat().st_size > 1_000_000
    assert read_world(tmp_path / "w.toml")[1] == layout

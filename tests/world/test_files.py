import tomllib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from animat.world.arena import Arena
from animat.world.files import read_world, write_world
from animat.world.layout import Layout, LayoutError, Placement
from animat.world.objects import TABLE_1, ObjectType
from animat.world.problems import WorldError

ONE = 'name = "one"\nobjects = [{ type = "TS", x = 500, y = 400.5 }]\n'


def problems(tmp_path, text, kind=WorldError):
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


text = st.text(st.characters(codec="utf-8"), min_size=1, max_size=12)
number = st.floats(-1e6, 1e6)


@settings(max_examples=60, deadline=None)
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
    with pytest.raises(WorldError, match=r"none\.toml: there is no such file"):
        read_world(tmp_path / "none.toml")
    with pytest.raises(WorldError, match="cannot be read"):
        read_world(tmp_path)
    assert problems(tmp_path, "") == [
        "name: missing; it has to be given", "objects: missing; it has to be given",
    ]  # fmt: skip


def test_what_is_no_toml_is_told_with_its_line(tmp_path):
    (told,) = problems(tmp_path, 'name = "a"\nx = [')
    assert told.startswith("this is no TOML: ")
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
        objects = [7, { type = "ST", x = 1, y = true, angel = 1 }]
        [arena]
        widht = 3
        [[types]]
        name = "TS"
        shape = "trangle"
        size_mm = 4
        features = { a = 1 }
        affords = { b = 2 }
        [[spares]]
        type = "TSS"
        x = nan
        y = 1
        """,
    )
    for start in (
        "name: missing",
        "nmae = 'a': unknown key; nearest: name; allowed: name, resolution,",
        "resolution = '2': it should be a valid number",
        "minimum_gap = -1: it should be greater than or equal to 0",
        "arena.widht = 3: unknown key; nearest: width; allowed: width, height,",
        "types[0].shape = 'trangle': unknown shape; nearest: triangle; allowed:",
        "types[0].affords.b = 2: it should be less than or equal to 1",
        "objects[0] = 7:",
        "objects[1].y = True: it should be a valid number",
        "objects[1].angel = 1: unknown key; nearest: angle; allowed: type, x, y, angle",
        "objects[1].type = 'ST': unknown type; nearest: TS; known: TS",
        "spares[0].type = 'TSS': unknown type; nearest: TS; known: TS",
        "spares[0].x = nan: it should be a finite number",
    ):
        assert sum(line.startswith(start) for line in told) == 1, (start, told)
    assert len(told) == 13


def test_no_types_are_refused(tmp_path):
    (told,) = problems(tmp_path, 'name = "a"\nobjects = []\ntypes = []\n')
    assert told.startswith("types: there are none")


def test_an_impossible_arena_is_told_by_its_key(tmp_path):
    (told,) = problems(tmp_path, ONE + "[arena]\nleft = 990.0\n")
    assert told.startswith("arena: left + right = 1012 mm leave nothing free")


def test_an_impossible_layout_is_told_with_the_file(tmp_path):
    told = problems(tmp_path, ONE + '[[spares]]\ntype = "CL"\nx = 500\ny = 410\n', LayoutError)
    assert told == [
        "object 0 (TS at 500, 400.5) overlaps spare site 1 (CL at 500, 410); move one of them"
    ]


def test_a_path_that_cannot_be_written_is_told(tmp_path):
    with pytest.raises(WorldError, match=r"w\.toml: cannot be written: No such file"):
        write_world(tmp_path / "none" / "w.toml", "a", Layout(placements=()), 2.0)
    (tmp_path / "folder").mkdir()
    with pytest.raises(WorldError, match="cannot be written"):
        write_world(tmp_path / "folder", "a", Layout(placements=()), 2.0)
    assert [p.name for p in tmp_path.iterdir()] == ["folder"]

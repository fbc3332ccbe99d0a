"""`animat world`: what it shows, draws and refuses."""

STANDING = """
name = "mine"
objects = [
    { type = "TS", x = 300.0, y = 300.0, angle = 90.0 },
    { type = "CL", x = 700.0, y = 700.0 },
]
"""


def test_a_world_of_the_paper_is_shown(animat):
    said = animat("world", "abundant")
    assert (said.code, said.err) == (0, "")
    assert said.out.startswith("abundant: arena of 1000 x 1000 mm\n")
    assert "grasp 1, shelter 0, interact 1" in said.out
    assert "free: 0." in said.out
    assert "hint" not in said.out


def test_a_world_is_drawn_with_hints(animat, tmp_path):
    (tmp_path / "mine.toml").write_text(STANDING)
    said = animat("world", "mine.toml", "--figure", "mine.svg")
    assert said.code == 0
    assert "hint: object 0 (TS at 300, 300): angle = 90 rad is more than a turn" in said.out
    assert "hint: type TL: no object is of this type" in said.out
    assert (tmp_path / "mine.svg").read_bytes().startswith(b"<?xml")
    again = animat("world", "mine.toml", "--figure", "mine.svg")
    assert again.code == 2
    assert "is there already; --force replaces it" in again.err


def test_a_world_that_cannot_be_is_drawn_all_the_same(animat, tmp_path):
    (tmp_path / "mine.toml").write_text(
        STANDING.replace("x = 700.0, y = 700.0", "x = 320.0, y = 9.0")
    )
    said = animat("world", "mine.toml", "--figure", "mine.png")
    assert said.code == 2
    assert "object 1 (CL at 320, 9) leaves the free part of the arena" in said.err
    assert "free:" not in said.out
    assert (tmp_path / "mine.png").exists()


def test_what_is_no_world_is_refused(animat):
    said = animat("world", "abundnt")
    assert said.code == 2
    assert 'did you mean "abundant"?' in said.err
    assert animat("world", "none.toml").err == "animat: none.toml: no such file\n"

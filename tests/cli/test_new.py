"""`animat new` as its users meet it."""

from __future__ import annotations

from animat.study.file.read import read_study


def test_a_file_is_written_that_can_be_checked(animat, tmp_path):
    said = animat("new", "my study.toml")
    assert (said.code, said.err) == (0, "")
    assert said.out == (
        "my study.toml is written; animat check 'my study.toml' says what it would run\n"
    )
    assert read_study(tmp_path / "my study.toml").name == "my study"


def test_nothing_is_replaced_without_being_asked(animat, tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("mine")
    said = animat("new", "a.toml")
    assert (said.code, said.out) == (2, "")
    assert said.err == "animat: a.toml: is there already; --force replaces it\n"
    assert file.read_text() == "mine"
    assert animat("new", "a.toml", "--force").code == 0
    assert read_study(file).name == "a"


def test_a_file_that_cannot_be_written_is_one_line(animat, tmp_path):
    (tmp_path / "directory.toml").mkdir()
    for name, told in {
        "a.txt": "give a name that ends in .toml",
        "no/a.toml": "there is no directory no; make it first",
        "directory.toml": "is a directory; give the name of a file",
    }.items():
        assert animat("new", name) == (2, "", f"animat: {name}: {told}\n")
    assert animat("new").code == 2

"""Output directories: whole or not at all, and nothing lost or left behind."""

import os
from pathlib import Path

import pytest

from animat.files import lock
from animat.files.atomic import RunError
from animat.files.lock import HeldError
from animat.files.settings import SettingsError
from animat.study.store import atomic_directory as output
from animat.study.store.atomic_directory import HOW_MADE, fresh_directory


def written(out, text="new", *, force=False, then=lambda: None):
    with fresh_directory(out, force=force) as directory:
        (directory / HOW_MADE).write_text("{}")
        (directory / "a").write_text(text)
        then()


def raises(error):
    raise error


def names(directory):
    return sorted(path.name for path in directory.iterdir())


def test_a_directory_takes_its_name_once_it_is_whole(tmp_path):
    out = tmp_path / "out"
    with fresh_directory(out, force=False) as directory:
        assert not out.exists()
        (directory / "a").write_text("new")
    assert names(tmp_path) == ["out"]
    assert names(out) == ["a"]


def test_missing_parents_are_made_and_not_left_empty(tmp_path):
    out = tmp_path / "one" / "two" / "out"
    with pytest.raises(ZeroDivisionError), fresh_directory(out, force=False):
        raise ZeroDivisionError
    assert names(tmp_path) == []
    written(out)
    assert (out / "a").read_text() == "new"
    assert names(tmp_path) == ["one"]


def test_its_permissions_are_those_of_any_new_directory(tmp_path):
    written(tmp_path / "out")
    (tmp_path / "other").mkdir()
    assert (tmp_path / "out").stat().st_mode == (tmp_path / "other").stat().st_mode


def test_an_empty_directory_is_filled(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    written(out)
    assert (out / "a").read_text() == "new"


@pytest.mark.parametrize("error", [KeyboardInterrupt, ZeroDivisionError, OSError(28, "full")])
@pytest.mark.parametrize("force", [False, True])
def test_a_failure_leaves_what_was_there_and_keeps_what_was_done(tmp_path, error, force):
    out = tmp_path / "out"
    if force:
        written(out, "old")
    before = names(tmp_path)
    expected = RunError if isinstance(error, OSError) else error
    with pytest.raises(expected):
        written(out, force=force, then=lambda: raises(error))
    assert names(tmp_path) == [".out.partial", *before]
    if force:
        assert (out / "a").read_text() == "old"
    with fresh_directory(out, force=force) as directory:
        assert (directory / "a").read_text() == "new"
    assert names(tmp_path) == ["out"]
    assert names(out) == ["a", HOW_MADE]


def test_two_that_fill_the_same_are_told_of_each_other(tmp_path, monkeypatch):
    monkeypatch.setattr(lock, "PATIENCE", 0.01)
    out = tmp_path / "out"
    with pytest.raises(HeldError, match="is held by process"):
        written(out, then=lambda: written(out))
    written(out)
    assert names(out) == ["a", HOW_MADE]


def test_an_earlier_result_is_replaced_only_when_asked(tmp_path):
    out = tmp_path / "out"
    written(out, "old")
    (out / "b").touch()
    with pytest.raises(SettingsError, match="is there already; --force replaces it"):
        written(out)
    assert (out / "a").read_text() == "old"
    written(out, force=True)
    assert (out / "a").read_text() == "new"
    assert names(out) == ["a", HOW_MADE]
    assert names(tmp_path) == ["out"]


def test_the_earlier_result_stays_until_the_new_one_is_whole(tmp_path):
    out = tmp_path / "out"
    written(out, "old")
    with fresh_directory(out, force=True):
        assert (out / "a").read_text() == "old"


def test_what_is_no_result_is_never_replaced(tmp_path):
    home = tmp_path / "home"
    home.mkdir()
    (home / "letters").write_text("dear")
    with pytest.raises(SettingsError, match="is no earlier result"):
        written(home, force=True)
    assert names(home) == ["letters"]


def test_where_one_stands_is_never_replaced(tmp_path, monkeypatch):
    written(tmp_path / "out", "old")
    (tmp_path / "out" / "deeper").mkdir()
    monkeypatch.chdir(tmp_path / "out" / "deeper")
    for out in (Path(), Path(".."), Path("../../out"), Path("/")):
        with pytest.raises(SettingsError, match="cannot be replaced as a whole"):
            written(out, force=True)
    assert names(tmp_path) == ["out"]
    assert (tmp_path / "out" / "a").read_text() == "old"


def test_what_is_mounted_is_refused_before_any_work(tmp_path, monkeypatch):
    monkeypatch.setattr(os.path, "ismount", lambda path: Path(path) == tmp_path)
    with pytest.raises(SettingsError, match="cannot be replaced as a whole"):
        written(tmp_path)


def test_a_file_is_no_directory(tmp_path):
    (tmp_path / "out").write_text("mine")
    for force in (False, True):
        with pytest.raises(SettingsError, match="is a file"):
            written(tmp_path / "out", force=force)
        with pytest.raises(SettingsError, match="cannot be written: Not a directory"):
            written(tmp_path / "out" / "deeper", force=force)
    assert (tmp_path / "out").read_text() == "mine"


def test_what_cannot_be_made_is_told_before_any_work(tmp_path):
    for out in (Path("/proc/animat"), tmp_path / ("a" * 300)):
        with pytest.raises(SettingsError, match="cannot be written"):
            written(out)


def test_a_link_stays_a_link(tmp_path):
    (tmp_path / "disk").mkdir()
    link = tmp_path / "out"
    link.symlink_to(tmp_path / "disk" / "there")
    written(link, "old")
    written(link, "new", force=True)
    assert link.is_symlink()
    assert (tmp_path / "disk" / "there" / "a").read_text() == "new"
    assert names(tmp_path / "disk") == ["there"]


def test_what_came_there_meanwhile_is_not_replaced(tmp_path):
    out = tmp_path / "out"

    def another():
        out.mkdir()
        (out / "a").write_text("first")

    with pytest.raises(SettingsError, match="cannot be written: Directory not empty"):
        written(out, "second", then=another)
    assert (out / "a").read_text() == "first"
    assert names(tmp_path) == [".out.partial", "out"]


def test_an_earlier_result_comes_back_if_the_new_one_cannot_take_its_place(tmp_path, monkeypatch):
    out = tmp_path / "out"
    written(out, "old")
    rename = Path.rename

    def fails(self, target):
        if ".partial" in self.name:
            raise OSError(5, "broken disk")
        return rename(self, target)

    monkeypatch.setattr(output.Path, "rename", fails)
    with pytest.raises(RunError, match="cannot be written: broken disk"):
        written(out, force=True)
    assert (out / "a").read_text() == "old"
    assert names(tmp_path) == [".out.partial", "out"]

import os
import stat
from pathlib import Path

import pytest

from animat.files.atomic import RunError, whole, write_whole
from animat.files.settings import SettingsError


def test_a_file_is_replaced_whole(tmp_path):
    path = tmp_path / "a.txt"
    write_whole(path, b"one")
    write_whole(path, b"two")
    assert path.read_bytes() == b"two"
    assert [file.name for file in tmp_path.iterdir()] == ["a.txt"]


def test_a_file_that_cannot_be_finished_leaves_the_old_one(tmp_path, monkeypatch):
    path = tmp_path / "a.txt"
    write_whole(path, b"one")

    def full(handle):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(RunError, match=r"a\.txt: cannot be written: No space"):
        write_whole(path, b"two")
    assert path.read_bytes() == b"one"
    assert [file.name for file in tmp_path.iterdir()] == ["a.txt"]


def test_content_comes_to_the_disk_before_the_name_and_the_name_before_the_end(
    tmp_path, monkeypatch
):
    path = tmp_path / "a.txt"
    happened = []
    fsync, rename = os.fsync, os.replace

    def synced(handle):
        is_directory = stat.S_ISDIR(os.fstat(handle).st_mode)
        happened.append("directory" if is_directory else os.fstat(handle).st_size)
        fsync(handle)

    def replaced(old, new):
        happened.append(Path(new).name)
        rename(old, new)

    monkeypatch.setattr(os, "fsync", synced)
    monkeypatch.setattr(os, "replace", replaced)
    write_whole(path, b"four")
    assert happened == [4, "a.txt", "directory"]


def test_a_writer_that_fails_leaves_the_old_file(tmp_path):
    path = tmp_path / "a.txt"
    write_whole(path, b"one")

    def interrupted():
        with whole(path) as partial:
            partial.write_bytes(b"tw")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert path.read_bytes() == b"one"
    assert [file.name for file in tmp_path.iterdir()] == ["a.txt"]


def test_a_path_that_cannot_be_written_is_told(tmp_path):
    with pytest.raises(SettingsError, match=r"w\.toml: cannot be written: No such file"):
        write_whole(tmp_path / "none" / "w.toml", b"a")
    (tmp_path / "folder").mkdir()
    with pytest.raises(SettingsError, match="cannot be written"):
        write_whole(tmp_path / "folder", b"a")
    assert [file.name for file in tmp_path.iterdir()] == ["folder"]

"""Results directories: begun, gone on with, refused."""

from __future__ import annotations

import json
import shutil
import tomllib

import pyarrow.parquet as pq
import pytest

from animat.files import lock
from animat.files.lock import HeldError
from animat.files.settings import SettingsError
from animat.study.plan.numbering import Part
from animat.study.plan.plan import plan_of
from animat.study.store import store
from animat.study.store.manifest import read_manifest, text_hash
from animat.study.store.store import StoreError, open_store


@pytest.fixture
def copied(finished, tmp_path):
    return shutil.copytree(finished, tmp_path / "results")


def changed(plan, old, new):
    assert old in plan.text
    return plan_of(plan.text.replace(old, new))


def test_a_directory_says_what_it_is(small, finished):
    manifest = read_manifest(finished)
    assert manifest["study"] == "small"
    assert manifest["hash"] == text_hash(small.text)
    assert manifest["lives"] == small.numbering["lives"].written()
    (run,) = manifest["runs"]
    assert {"made", "command", "versions", "machine"} <= set(run)
    assert (finished / "study.toml").read_text() == small.text
    assert pq.read_table(finished / "cases.parquet").equals(small.case_table())
    names = {str(path.relative_to(finished)) for path in finished.rglob("*") if path.is_file()}
    assert names == {
        *("study.toml", "manifest.json", "cases.parquet", "lock", "log.jsonl"),
        *("lives/_common_metadata", "lives/part-000000.parquet", "lives/part-000001.parquet"),
        *("teachers/_common_metadata", "teachers/part-000000.parquet"),
        *("curves/lives-000000.parquet", "curves/teachers-000000.parquet"),
        *("traces/part-000000.parquet", "traces/part-000001.parquet"),
    }


def test_a_study_that_needs_less_has_less(faults, tmp_path):
    plan = faults.plan('name = "plain"\nlives = 2\nsteps = 5\n')
    faults.go_on(plan, tmp_path / "results")
    assert {path.name for path in (tmp_path / "results").iterdir() if path.is_dir()} == {"lives"}


def test_each_run_is_in_the_manifest(small, copied):
    with open_store(copied, small):
        pass
    assert len(read_manifest(copied)["runs"]) == 2


def test_its_study_can_be_run_again_from_it_alone(small, finished, faults, tmp_path):
    again = plan_of((finished / "study.toml").read_text())
    faults.go_on(again, tmp_path / "again")
    assert faults.told_of(tmp_path / "again") == faults.told_of(finished)


def test_a_part_of_another_study_is_refused(small, copied, faults, tmp_path):
    other = changed(small, "seed = 0", "seed = 1")
    faults.go_on(other, tmp_path / "other")
    shutil.copy(tmp_path / "other" / "lives" / "part-000000.parquet", copied / "lives")
    with (
        open_store(copied, small) as held,
        pytest.raises(SettingsError, match=r"part-000000\.parquet: holds the lives of another"),
    ):
        held.finished(Part("lives", 0))


@pytest.mark.parametrize("name", ["letters.txt", "study", ".hidden"])
def test_a_directory_that_holds_something_else_is_refused(small, tmp_path, name):
    (tmp_path / name).write_text("mine")
    with pytest.raises(SettingsError, match="is no results directory: it holds"):
        open_store(tmp_path, small).__enter__()
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_file_is_no_directory(small, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(SettingsError, match="is a file"):
        open_store(tmp_path / "file", small).__enter__()
    with pytest.raises(SettingsError, match="cannot be written"):
        open_store(tmp_path / "file" / "deeper", small).__enter__()


def test_what_a_killed_writer_left_is_taken_away(small, copied):
    left = [copied / ".manifest.json.77.part", copied / "lives" / ".part-000000.parquet.77.part"]
    for path in left:
        path.write_text("half")
    with open_store(copied, small):
        assert not any(path.exists() for path in left)


def test_the_second_is_refused_and_leaves_the_first_alone(small, copied, monkeypatch, faults):
    monkeypatch.setattr(lock, "PATIENCE", 0.05)
    before = faults.told_of(copied)
    with open_store(copied, small) as first:
        with pytest.raises(HeldError, match="is held by process"):
            open_store(copied, small).__enter__()
        first.note("still here")
    assert faults.told_of(copied) == before


def test_the_log_tells_of_a_dead_holder(small, copied):
    (copied / "lock").write_text(json.dumps({"pid": 1, "host": "there", "since": "then"}))
    with open_store(copied, small) as held:
        assert str(held.dead) == "process 1 on there, since then"


def test_a_disk_that_fails_stops_the_run_and_not_what_is_finished(small, copied, monkeypatch):
    def fails(*_):
        raise OSError(5, "Input/output error")

    with open_store(copied, small) as held:
        monkeypatch.setattr(store, "write_whole", fails)
        made = type("Made", (), {"files": {"lives/x": b""}})()
        with pytest.raises(StoreError, match="Input/output error; what is finished is kept"):
            held.put(Part("lives", 0), made)
    assert tomllib.loads((copied / "study.toml").read_text())["name"] == "small"

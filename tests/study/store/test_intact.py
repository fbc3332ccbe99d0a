"""Nobody reads what has changed on the disk: it is refused, or it is still the same."""

from __future__ import annotations

import shutil
from contextlib import suppress

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from animat.files.settings import SettingsError
from animat.study.plan.numbering import Part
from animat.study.store.export import export
from animat.study.store.results import Results
from animat.study.store.status import status
from animat.study.store.store import open_store

READ = {
    "lives/part-000000": lambda results: results.lives(),
    "teachers/part-000000": lambda results: results.teachers(),
    "curves/lives-000000": lambda results: results.curves(),
    "traces/part-000001": lambda results: results.traces(),
    "cases": lambda results: results.lives(),
    "lives/_common_metadata": lambda results: results.lives(),
}


@pytest.fixture
def copied(finished, tmp_path):
    return shutil.copytree(finished, tmp_path / "results")


@pytest.mark.parametrize("file", READ)
def test_a_flipped_bit_changes_nothing_that_is_read_or_is_refused(copied, finished, file):
    path = copied / (file if "_" in file else f"{file}.parquet")
    same = READ[file](Results(finished)).to_pylist()
    whole = path.read_bytes()
    refused = 0
    for place in np.linspace(4, len(whole) - 9, 40).astype(int):
        content = bytearray(whole)
        content[place] ^= 1 << (place % 8)
        path.write_bytes(content)
        try:
            read = READ[file](Results(copied)).to_pylist()
        except SettingsError:
            refused += 1
        else:
            assert str(read) == str(same)
    assert refused


def test_two_parts_that_changed_places_are_refused(copied, small, tmp_path):
    first, second = (copied / "lives" / f"part-00000{n}.parquet" for n in range(2))
    first.rename(copied / "other")
    second.rename(first)
    (copied / "other").rename(second)
    told = "holds the lives of another part or study, not its own"
    with pytest.raises(SettingsError) as refused:
        export(Results(copied), "csv", tmp_path / "lives.csv")
    assert [line.partition(": ")[2][: len(told)] for line in refused.value.problems] == [told] * 2
    assert not (tmp_path / "lives.csv").exists()
    assert sum(told in line for line in status(Results(copied))) == 2
    with open_store(copied, small) as held, pytest.raises(SettingsError, match=told):
        held.finished(Part("lives", 0))


def test_nobody_is_taught_by_networks_that_have_changed(copied, small):
    path = copied / "teachers" / "part-000000.parquet"
    metadata = pq.read_metadata(path).metadata
    assert metadata is not None
    table = pq.read_table(path)
    n = table.schema.get_field_index("weights")
    turned = table.set_column(n, table.schema.field(n), table["weights"].take([1, 0, 2]))
    assert isinstance(turned, pa.Table)
    pq.write_table(turned.replace_schema_metadata(metadata), path)
    with open_store(copied, small) as held, pytest.raises(SettingsError, match="is altered"):
        held.networks(0)


FOLDERS = ["lock", "log.jsonl", "manifest.json", "study.toml", "cases.parquet"]
FOLDERS += ["lives/_common_metadata", "lives/part-000000.parquet", "curves/lives-000000.parquet"]


@pytest.mark.parametrize("name", FOLDERS)
def test_a_directory_in_the_place_of_a_file_is_told_of(copied, small, name):
    path = copied / name
    path.unlink()
    path.mkdir()
    for act in (lambda: status(Results(copied)), lambda: Results(copied).curves()):
        with suppress(SettingsError):
            act()
    with pytest.raises(SettingsError, match=path.name):
        gone_on_with(small, copied)


def gone_on_with(plan, directory):
    with open_store(directory, plan) as held:
        held.finished(Part("lives", 0))

"""Sealed tables: the same values have the same hash, others another, a torn file none."""

import io

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.files.checksummed_table import Seal, content, content_of, seal_of, sealed

NUMBERS = st.lists(st.none() | st.integers(-5, 5), max_size=6)


def table(**columns):
    return pa.table(
        {
            "n": pa.array([1, None, 3], pa.int64()),
            "x": pa.array([0.5, -0.0, None]),
            "b": pa.array([True, None, False]),
            "t": pa.array(["a", None, "b"]).dictionary_encode(),
            "e": pa.array([None, "wrong", None]),
            "w": pa.array([[1.0, 2.0], None, [3.0]], pa.list_(pa.float64())),
        }
        | columns
    )


def test_a_sealed_table_reads_back_as_it_was(tmp_path):
    path = tmp_path / "a.parquet"
    tables = [table(), table().slice(1), table(e=pa.nulls(3, pa.string()))]
    path.write_bytes(sealed(tables, table().schema, "who", steps=70, failed=1))
    assert pq.read_table(path).equals(pa.concat_tables(tables))
    assert seal_of(path) == Seal("who", 8, 70, 1, content_of(path))


def test_the_hash_is_of_what_the_file_holds(tmp_path):
    hashes = {}
    for name, tables in {
        "one": [table()],
        "other": [table(e=pa.nulls(3, pa.string()))],
        "both": [table(), table(e=pa.nulls(3, pa.string()))],
        "turned": [table(e=pa.nulls(3, pa.string())), table()],
        "none": [],
    }.items():
        (tmp_path / name).write_bytes(sealed(tables, table().schema, "who"))
        hashes[name] = content_of(tmp_path / name)
    assert len(set(hashes.values())) == 5


def test_the_same_table_is_sealed_in_the_same_bytes():
    assert whole() == whole()


def whole():
    return sealed([table()], table().schema, "who")


def test_chunks_and_codes_do_not_matter():
    parts = pa.concat_tables([table().slice(0, 1), table().slice(1)])
    assert content(parts) == content(table())
    other = pa.DictionaryArray.from_arrays(pa.array([2, None, 0]), pa.array(["b", "zzz", "a"]))
    assert content(table(t=other)) == content(table())
    assert content(table(t=other.dictionary_decode())) == content(table())


def test_what_stands_under_a_null_does_not_matter():
    hidden = pa.Array.from_buffers(
        pa.int64(), 3, [pa.array([1, None, 3]).buffers()[0], pa.py_buffer(np.array([1, 9, 3]))]
    )
    assert content(table(n=hidden)) == content(table())


OTHERS = {
    "a number": {"n": pa.array([1, None, 4])},
    "a null": {"n": pa.array([1, 0, 3])},
    "a bit": {"x": pa.array([0.5, 0.0, None])},
    "a truth": {"b": pa.array([True, None, True])},
    "a text": {"t": pa.array(["a", None, "c"])},
    "texts that change places": {"t": pa.array(["b", None, "a"])},
    "an error": {"e": pa.array([None, "wrong!", None])},
    "where a list ends": {"w": pa.array([[1.0], None, [2.0, 3.0]], pa.list_(pa.float64()))},
    "a type": {"n": pa.array([1, None, 3], pa.int32())},
    "a name": {"m": pa.array([1, None, 3])},
}


@pytest.mark.parametrize("what", OTHERS)
def test_another_table_has_another_hash(what):
    assert content(table(**OTHERS[what])) != content(table())


def test_rows_in_another_order_are_another_table():
    assert content(table().take([1, 0, 2])) != content(table())


@given(one=NUMBERS, other=NUMBERS)
def test_two_columns_have_one_hash_if_and_only_if_they_are_equal(one, other):
    tables = [pa.table({"n": pa.array(each, pa.int64())}) for each in (one, other)]
    assert (content(tables[0]) == content(tables[1])) == (one == other)


@given(st.data())
def test_a_torn_file_has_no_seal(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("torn") / "a.parquet"
    path.write_bytes(whole()[: data.draw(st.integers(0, len(whole()) - 1))])
    assert seal_of(path) is None


@pytest.mark.parametrize("metadata", [{}, {b"animat": b"{"}, {b"animat": b"{}"}, {b"animat": b"7"}])
def test_what_is_not_sealed_has_no_seal(tmp_path, metadata):
    path = tmp_path / "a.parquet"
    pq.write_table(table().replace_schema_metadata(metadata), path)
    assert seal_of(path) is None
    assert seal_of(tmp_path / "none") is None


def test_a_seal_of_other_rows_does_not_count(tmp_path):
    path = tmp_path / "a.parquet"
    metadata = {b"animat": pq.read_metadata(io.BytesIO(whole())).metadata[b"animat"]}
    pq.write_table(table().slice(1).replace_schema_metadata(metadata), path)
    assert seal_of(path) is None

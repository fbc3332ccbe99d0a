"""Records whose shapes are linked in are those of NumPy, field by field."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numba import types

from animat.numerics.compiled import compiled
from animat.numerics.layout import BYTES, PADDING, Field, Layout, raw
from animat.numerics.linked import linked

RECORD = Layout(
    "tested",
    (
        Field("flag", np.bool_),
        Field("row", np.float64, ("A",)),
        Field("speed", np.float64),
        Field("table", np.float64, ("B", "A")),
        Field("four", np.int64, (4,)),
        Field("whole", np.int64),
    ),
)
record_at = RECORD.at


class Counts(NamedTuple):
    A: int
    B: int


@compiled
def change(record: Any, n: Any) -> Any:
    """Change every element of every field by where it is; return how many arrays have."""
    record.flag = not record.flag
    record.speed += n + 0.5
    record.whole -= n
    for a in range(len(record.row)):
        record.row[a] += n + a
    for i in range(len(record.four)):
        record.four[i] = record.four[3 - i] + n
    for b in range(record.table.shape[0]):
        line = record.table[b]
        for a in range(record.table.shape[1]):
            line[a] = 10.0 * record.table[b, a] + b - a
    return len(record.row) + record.table.size


@linked((BYTES, types.int64), (RECORD,))
def change_all(records: Any, count: Any, functions: Any) -> Any:
    sizes = 0
    for n in range(count):
        sizes += change(record_at(records, n), n)
    return sizes


# Few shapes, as each is compiled.
SHAPES = st.sampled_from([Counts(1, 1), Counts(2, 3), Counts(5, 2)])


@given(SHAPES, st.integers(0, 4), st.integers(0, 2**32 - 1))
def test_a_kernel_does_what_python_does_to_numpys_records(counts, number, seed):
    dtype = RECORD.dtype(counts._asdict())
    random = np.random.default_rng(seed)
    records = np.zeros(number, dtype)
    for name in {*dtype.names} - {PADDING}:
        records[name] = random.integers(-9, 9, records[name].shape)
    expected = records.copy()
    plain: Any = change.py_func
    sizes = sum(plain(expected[n], n) for n in range(number))
    assert change_all.of(counts)(raw(records), number) == sizes
    assert records.tobytes() == expected.tobytes()


@given(st.integers(0, 9), st.integers(0, 9))
def test_the_table_says_where_numpy_has_the_fields(a, b):
    counts = {"A": a, "B": b}
    size, *rest = RECORD.table(counts)
    dtype = RECORD.dtype(counts)
    assert size == dtype.itemsize == dtype.alignment * (size // dtype.alignment)
    assert rest[:2] == [a, b]
    assert rest[2:] == [dtype.fields[one.name][1] for one in RECORD.arrays]
    assert all(dtype.fields[name][1] == at for name, at in RECORD.offsets.items())

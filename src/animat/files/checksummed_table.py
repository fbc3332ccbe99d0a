"""Tables as Parquet files that say of themselves what they hold, and whether it is still that.

Beside the columns a file has a seal: which lives it holds (their identity), how many rows, steps
and failures, and a hash of its content. The hash is of the values and not of the bytes of the
file, so that another version of Parquet seals the same table the same. A table that is too large
to be held at once is written, and hashed, some rows at a time: a row group each.
"""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

KEY = "animat"

LIVED_AGAIN = "take it away, and animat run with the same study lives it again"
OTHERS = f"holds the lives of another part or study, not its own; {LIVED_AGAIN}"

SOUGHT = ("case", "life", "step")
"""Columns whose least and largest values stand in a file, so that a reader can pass it over."""


@dataclass(frozen=True)
class Seal:
    """What a file holds: its identity, rows, steps lived, lives that failed, hash of the values."""

    identity: str
    rows: int
    steps: int
    failed: int
    content: str


def sealed(
    tables: Iterable[pa.Table], schema: pa.Schema, identity: str, steps: int = 0, failed: int = 0
) -> bytes:
    """Return tables of one schema as a Parquet file with a seal, a row group each."""
    file = io.BytesIO()
    digest = hashlib.sha256()
    rows = 0
    texts = [field.name for field in schema if pa.types.is_dictionary(field.type)]
    how: dict[str, Any] = {
        "compression": "zstd",
        "compression_level": 1,
        "use_dictionary": texts,
        "write_statistics": [name for name in SOUGHT if name in schema.names],
    }
    with pq.ParquetWriter(file, schema, **how) as writer:
        for table in tables:
            writer.write_table(table)
            digest.update(content(table).encode())
            rows += table.num_rows
        seal = Seal(identity, rows, steps, failed, digest.hexdigest())
        writer.add_key_value_metadata({KEY: json.dumps(asdict(seal))})
    return file.getvalue()


def read_parquet(path: Path, columns: Sequence[str] | None = None) -> pa.Table:
    """Return a Parquet file as it is. Raises OSError, ValueError or Arrow's own.

    `pyarrow.parquet.read_table` would take a folder called seed=1 for a column. And Arrow opens the
    file itself: a file or bytes of Python's may be let go by a thread of Arrow's while the process
    ends, which aborts it.
    """
    with pq.ParquetFile(path) as file:
        return file.read(None if columns is None else list(columns))


def seal_of(path: Path) -> Seal | None:
    """Return the seal of a file; None if there is no such file, or it is torn or not sealed."""
    try:
        if not path.is_file():
            return None
        metadata = pq.read_metadata(path)
        seal = Seal(**json.loads((metadata.metadata or {})[KEY.encode()]))
    except (OSError, ValueError, TypeError, KeyError, pa.ArrowException):
        return None
    return seal if seal.rows == metadata.num_rows else None


def content_of(path: Path) -> str:
    """Return the hash of what a sealed file holds now; another than its seal's if it is torn."""
    digest = hashlib.sha256()
    try:
        with pq.ParquetFile(path) as file:
            for group in range(file.num_row_groups):
                digest.update(content(file.read_row_group(group)).encode())
    except (OSError, ValueError, pa.ArrowException):
        return ""
    return digest.hexdigest()


def wrong_with(
    path: Path, identity: str, rows: int | None = None, *, unread: bool = False
) -> str | None:
    """Return what is wrong with a file that should hold lives of an identity; None if nothing is.

    `rows` are those it should have, if that is known. `unread` leaves its values out.
    """
    seal = seal_of(path)
    if seal is None:
        return f"{path}: is torn; {LIVED_AGAIN}" if path.exists() else f"{path}: is missing"
    if seal.identity != identity or rows not in {None, seal.rows}:
        return f"{path}: {OTHERS}"
    if not unread and content_of(path) != seal.content:
        return f"{path}: has changed since it was written; {LIVED_AGAIN}"
    return None


def content(table: pa.Table) -> str:
    """Return a hash of the names, types and values of a table."""
    digest = hashlib.sha256()
    for name in table.column_names:
        column = table.column(name).combine_chunks()
        nulls = column.null_count
        digest.update(f"{name} {len(column)} {nulls} {_plain_type(column.type)}\0".encode())
        _add(digest, column)
    return digest.hexdigest()


def _plain_type(kind: pa.DataType) -> pa.DataType:
    """Return the type of the values; files give other names to what is in a list."""
    if pa.types.is_list(kind):
        return pa.list_(kind.value_type)
    return kind.value_type if pa.types.is_dictionary(kind) else kind


def _add(digest: Any, column: pa.Array | pa.ChunkedArray) -> None:
    if isinstance(column, pa.ChunkedArray):
        column = column.chunk(0) if column.num_chunks else pa.array([], column.type)
    if column.null_count:
        digest.update(np.packbits(np.asarray(column.is_valid())).tobytes())
    if pa.types.is_string(_plain_type(column.type)):
        _add_texts(digest, column)
    elif pa.types.is_list(column.type):
        lengths = column.value_lengths().fill_null(0)
        digest.update(np.asarray(lengths, np.int64).tobytes())
        _add(digest, column.flatten())
    else:
        if column.null_count:
            column = column.fill_null(pa.scalar(0).cast(column.type))
        digest.update(np.ascontiguousarray(column.to_numpy(zero_copy_only=False)))


def _add_texts(digest: Any, column: pa.Array) -> None:
    """Add texts by their numbers in the sorted list of those that occur."""
    coded = column if pa.types.is_dictionary(column.type) else column.dictionary_encode()
    # The last number is that of null.
    codes = np.asarray(coded.indices.fill_null(len(coded.dictionary)))
    occurs = np.bincount(codes, minlength=len(coded.dictionary) + 1) > 0
    texts = coded.dictionary.to_pylist()
    used = sorted({text for text, there in zip(texts, occurs[:-1], strict=True) if there})
    numbers = [
        used.index(text) if there else -1 for text, there in zip(texts, occurs, strict=False)
    ]
    digest.update(json.dumps(used).encode())
    digest.update(np.array([*numbers, -1])[codes])

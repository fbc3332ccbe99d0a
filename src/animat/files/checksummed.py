"""Checksummed Parquet files: written block by block, refused if a single byte has changed.

Any program that reads Parquet reads them. A text goes with the table. Every row group, a block, has
a digest, so that damage is found and placed; the footer behind them holds the text, the digests and
one of itself. Nothing is parsed before its digest is right.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, NamedTuple

import pyarrow as pa
import pyarrow.parquet as pq
from pydantic import TypeAdapter, ValidationError

from animat.files.settings import SettingsError, opened

MAGIC = b"PAR1"
"""What a Parquet file begins and ends with; before the last one stands the length of its footer."""

LENGTH = 4

LARGEST = 1 << 24
"""Bytes of a footer that are looked at."""

TEXT, BLOCKS, CHECKSUM = "animat.text", "animat.blocks", "animat.checksum"
"""The keys of what goes with the table."""

OPEN = f"§ sha256 {'0' * 64}"
"""The digest of the footer, zeros while it is taken. Text and blocks are ASCII, unlike this."""

CLOSED = re.compile("§ sha256 ([0-9a-f]{64})".encode())

SOUGHT = ("case", "life", "step")
"""Columns whose least and largest values stand in a file, so that a reader can pass it over."""

PIECE = 1 << 20
"""Bytes that are read at a time."""


class Block(NamedTuple):
    """A row group: what is in it, the byte behind it, and the digest of its bytes."""

    holds: str
    end: int
    sha256: str


class Writer:
    """Writes the blocks of a checksummed file, and its text at the end."""

    def __init__(self, sink: _Sink, parquet: pq.ParquetWriter) -> None:
        """Write to a sink by a Parquet writer of its own."""
        self._sink = sink
        self._parquet = parquet
        self._blocks: list[Block] = []

    def write(self, table: pa.Table, holds: str) -> None:
        """Write a block; `holds` says in words what is in it."""
        self._parquet.write_table(table, row_group_size=max(1, table.num_rows))
        self._blocks.append(Block(holds, self._sink.size, self._sink.cut()))

    def close(self, text: str) -> None:
        """Write the text, which is ASCII, and nothing after it."""
        assert text.isascii()
        blocks = json.dumps(self._blocks)
        self._parquet.add_key_value_metadata({TEXT: text, BLOCKS: blocks, CHECKSUM: OPEN})
        self._parquet.close()


class _Sink:
    """A file as Parquet writes it, which digests what comes."""

    def __init__(self, file: IO[bytes]) -> None:
        self.closed = False
        self.size = 0
        self._file = file
        self._digest = hashlib.sha256()

    def write(self, data: bytes) -> int:
        self.size += len(data)
        self._digest.update(data)
        return self._file.write(data)

    def flush(self) -> None:
        self._file.flush()

    def tell(self) -> int:
        return self.size

    def close(self) -> None:
        pass

    def cut(self) -> str:
        """Return the digest of what came since the last cut."""
        digest, self._digest = self._digest, hashlib.sha256()
        return digest.hexdigest()


@contextmanager
def writing(file: IO[bytes], schema: pa.Schema) -> Iterator[Writer]:
    """Yield the writer of an empty file open for both; call its `close` at the end.

    Raises OSError.
    """
    sink = _Sink(file)
    real = [field.name for field in schema if pa.types.is_floating(field.type)]
    options: dict[str, Any] = {
        "compression": "zstd",
        "use_dictionary": [f.name for f in schema if pa.types.is_dictionary(f.type)],
        "use_byte_stream_split": real,
        "write_statistics": [name for name in SOUGHT if name in schema.names],
    }
    with pq.ParquetWriter(sink, schema, **options) as parquet:
        yield Writer(sink, parquet)
    begin, footer = _footer(file)
    place = footer.index(OPEN.encode()) + len(OPEN.encode()) - 64
    file.seek(begin + place)
    file.write(hashlib.sha256(footer).hexdigest().encode())


def verified(path: Path, what: str) -> tuple[str, pq.ParquetFile]:
    """Return text and table of a checksummed file, every byte of which is as it was written.

    Raises:
        SettingsError: it cannot be read, is no such file, is cut short, or was altered; it says
            where. `what` it should be is told of a file of another kind.
    """
    with _reading(path, what) as file:
        end = _check_footer(path, file, what)
        table = pq.ParquetFile(path)
        metadata = table.metadata.metadata
        blocks = TypeAdapter(list[Block]).validate_json(metadata[BLOCKS.encode()])
        _check_blocks(path, file, blocks, end)
        return metadata[TEXT.encode()].decode("ascii"), table


def header(path: Path, what: str) -> tuple[str, int]:
    """Return text and number of rows of a checksummed file; its blocks are not read.

    Raises SettingsError as `verified` does.
    """
    with _reading(path, what) as file:
        _check_footer(path, file, what)
        metadata = pq.read_metadata(path)
        return metadata.metadata[TEXT.encode()].decode("ascii"), metadata.num_rows


def read_parquet(path: Path, columns: Sequence[str] | None = None) -> pa.Table:
    """Return a Parquet file as it is. Raises OSError, ValueError or Arrow's own.

    `pyarrow.parquet.read_table` would take a folder called seed=1 for a column. And Arrow opens the
    file itself: a file or bytes of Python's may be let go by a thread of Arrow's while the process
    ends, which aborts it.
    """
    with pq.ParquetFile(path) as file:
        return file.read(None if columns is None else list(columns))


@contextmanager
def _reading(path: Path, what: str) -> Iterator[IO[bytes]]:
    try:
        with opened(path, what) as file:
            yield file
    except (ValidationError, KeyError, UnicodeDecodeError, pa.ArrowException):
        raise SettingsError(f"{path}: has right checksums, but holds no {what}") from None
    except OSError as error:
        raise SettingsError(f"{path}: cannot be read: {error.strerror or error}") from None


def _check_footer(path: Path, file: IO[bytes], what: str) -> int:
    """Return where the footer begins, as it was written. Raises SettingsError."""
    size = file.seek(0, os.SEEK_END)
    if size == 0:
        raise SettingsError(f"{path}: is empty")
    begin, footer = _footer(file)
    found = CLOSED.search(footer) if footer.endswith(MAGIC) else None
    file.seek(0)
    if found is None and file.read(len(MAGIC)) != MAGIC:
        raise SettingsError(f"{path}: is no {what}: it does not begin like one")
    if not footer.endswith(MAGIC):
        raise SettingsError(f"{path}: is cut short: it ends at byte {size:,} without its end")
    if found is None:
        raise SettingsError(
            f"{path}: has no checksum: it is another Parquet file, or altered at its end"
        )
    digest = hashlib.sha256(footer[: found.start(1)] + b"0" * 64 + footer[found.end(1) :])
    if digest.hexdigest().encode() != found[1]:
        raise SettingsError(f"{path}: is altered behind byte {begin:,}, at its end")
    return begin


def _footer(file: IO[bytes]) -> tuple[int, bytes]:
    """Return where the footer of a Parquet file begins by its own account, and all from there."""
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - len(MAGIC) - LENGTH))
    length = min(LARGEST, int.from_bytes(file.read(LENGTH), "little"))
    begin = max(0, size - len(MAGIC) - LENGTH - length)
    file.seek(begin)
    return begin, file.read()


def _check_blocks(path: Path, file: IO[bytes], blocks: list[Block], end: int) -> None:
    begin = 0
    for block in blocks:
        digest = hashlib.sha256()
        _read(file, begin, block.end, digest)
        if digest.hexdigest() != block.sha256:
            raise SettingsError(
                f"{path}: is altered between bytes {begin:,} and {block.end:,}: {block.holds}"
            )
        begin = block.end
    if begin != end:
        raise SettingsError(f"{path}: no checksum is of the bytes from {begin:,} to {end:,}")


def _read(file: IO[bytes], begin: int, end: int, digest: Any) -> None:
    file.seek(begin)
    while begin < end and (piece := file.read(min(PIECE, end - begin))):
        digest.update(piece)
        begin += len(piece)

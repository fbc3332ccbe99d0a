"""Sealed Parquet files: written as they come, and refused if a single byte is not as it was.

Any program that reads Parquet reads them. A text goes with the table; every row group, a block, has
a digest, so that damage is found and placed; and a seal at the end covers whatever follows the
blocks. Nothing is parsed before its digest is right.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, NamedTuple

import pyarrow as pa
import pyarrow.parquet as pq
from pydantic import TypeAdapter, ValidationError

from animat.files.settings import SettingsError, opened

MAGIC = b"PAR1"
"""What a Parquet file begins and ends with."""

TEXT, BLOCKS, SEAL = "animat.recording", "animat.blocks", "animat.seal"
"""The keys of what goes with the table."""

SEALED = re.compile("§ from byte ([0-9]{20}) sha256 ([0-9a-f]{64})".encode())
OPEN_SEAL = f"§ from byte {{:020d}} sha256 {'0' * 64}"
"""A seal: where what it covers begins, and its digest, zeros until the file is closed. The text and
the list of blocks are ASCII, so that neither is taken for it."""

END = 1 << 24
"""Bytes at the end of a file in which its seal is looked for."""

PIECE = 1 << 20
"""Bytes that are read at a time."""


class Block(NamedTuple):
    """A row group: what is in it, the byte behind it, and the digest of its bytes."""

    holds: str
    end: int
    sha256: str


class Writer:
    """Writes the blocks of a sealed file, and its text at the end."""

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
        self._parquet.add_key_value_metadata(
            {
                TEXT: text,
                BLOCKS: json.dumps(self._blocks),
                SEAL: OPEN_SEAL.format(self._sink.size),
            }
        )
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
        told = self._digest.hexdigest()
        self._digest = hashlib.sha256()
        return told


@contextmanager
def sealing(path: Path, schema: pa.Schema) -> Iterator[Writer]:
    """Yield the writer of a new file; call its `close` at the end. Raises OSError."""
    with path.open("wb") as file:
        sink = _Sink(file)
        real = [field.name for field in schema if pa.types.is_floating(field.type)]
        options: dict[str, Any] = {
            "compression": "zstd",
            "use_dictionary": [name for name in schema.names if name not in real],
            "use_byte_stream_split": real,
        }
        with pq.ParquetWriter(sink, schema, **options) as parquet:
            yield Writer(sink, parquet)
    with path.open("rb+") as file:
        seal = _seal(file)
        assert seal is not None
        digest = _digest_of_end(file, seal)
        file.seek(seal.place)
        file.write(digest.encode())


def unseal(path: Path) -> tuple[str, pq.ParquetFile]:
    """Return the text and the table of a sealed file, every byte of which is as it was written.

    Raises:
        SettingsError: it cannot be read, is no such file, is cut short, or was altered; it says
            where.
    """
    with opened(path, "recording") as file:
        try:
            seal = _seal(file)
            size = file.seek(0, os.SEEK_END)
            if seal is None:
                raise _unsealed(path, file, size)
            if seal.digest != _digest_of_end(file, seal):
                what = "is altered or cut short" if _ends_well(file) else "is cut short"
                raise SettingsError(f"{path}: {what} behind byte {seal.begin:,}, at its end")
            table = pq.ParquetFile(path)
            told = table.metadata.metadata
            blocks = TypeAdapter(list[Block]).validate_json(told[BLOCKS.encode()])
            _check_blocks(path, file, blocks, seal.begin)
            return told[TEXT.encode()].decode("ascii"), table
        except (ValidationError, KeyError, UnicodeDecodeError, pa.ArrowException):
            raise SettingsError(f"{path}: is sealed as a recording, but holds none") from None
        except OSError as error:
            raise SettingsError(f"{path}: cannot be read: {error.strerror or error}") from None


class _Seal(NamedTuple):
    begin: int  # of the bytes it covers
    digest: str
    place: int  # of its digest in the file


def _seal(file: IO[bytes]) -> _Seal | None:
    """Return the last seal near the end of a file, if there is one."""
    start = max(0, file.seek(0, os.SEEK_END) - END)
    file.seek(start)
    found = None
    for found in SEALED.finditer(file.read()):  # noqa: B007
        pass
    if found is None:
        return None
    place = start + found.start(2)
    return _Seal(min(int(found[1]), place), found[2].decode(), place)


def _digest_of_end(file: IO[bytes], seal: _Seal) -> str:
    """Return the digest of what a seal covers, its own digest taken for zeros."""
    digest = hashlib.sha256()
    _read(file, seal.begin, seal.place, digest)
    digest.update(b"0" * len(seal.digest))
    _read(file, seal.place + len(seal.digest), file.seek(0, os.SEEK_END), digest)
    return digest.hexdigest()


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
        raise SettingsError(f"{path}: nothing seals the bytes from {begin:,} to {end:,}")


def _read(file: IO[bytes], begin: int, end: int, digest: Any) -> None:
    file.seek(begin)
    while begin < end and (piece := file.read(min(PIECE, end - begin))):
        digest.update(piece)
        begin += len(piece)


def _unsealed(path: Path, file: IO[bytes], size: int) -> SettingsError:
    """Return what is wrong with a file that has no seal."""
    if size == 0:
        return SettingsError(f"{path}: is empty")
    file.seek(0)
    if file.read(len(MAGIC)) != MAGIC:
        return SettingsError(f"{path}: is no recording: it does not begin like one")
    if not _ends_well(file):
        return SettingsError(f"{path}: is cut short: it ends at byte {size:,} without its end")
    return SettingsError(
        f"{path}: has no seal of a recording: it is another Parquet file, or altered at its end"
    )


def _ends_well(file: IO[bytes]) -> bool:
    file.seek(-len(MAGIC), os.SEEK_END)
    return file.read() == MAGIC

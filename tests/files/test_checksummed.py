"""A checksummed file is read as it was written, or refused with what is wrong and where."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.files.checksummed import BLOCKS, CHECKSUM, TEXT, header, verified, writing
from animat.files.settings import SettingsError

RANDOM = np.random.default_rng(1)
ROWS = 400


def some_rows(begin: int) -> pa.Table:
    words = pa.array(["left", "right", None, "left"] * (ROWS // 4)).dictionary_encode()
    return pa.table(
        {
            "step": np.arange(begin, begin + ROWS),
            "x": RANDOM.random(ROWS),
            "word": words,
            "bytes": pa.array([b"\x00\xff" * 9] + [None] * (ROWS - 1), pa.binary()),
        }
    )


PARTS = [some_rows(begin) for begin in range(0, 3 * ROWS, ROWS)]
SAID = '{"a": "\\u00a7 sha256 ' + "0" * 64 + '"}'
"""A text that looks like a checksum."""


def write(path: Path, parts: list[pa.Table], text: str = SAID) -> bytes:
    with path.open("wb+") as out, writing(out, parts[0].schema) as file:
        for number, part in enumerate(parts):
            file.write(part, f"part {number}")
        file.close(text)
    return path.read_bytes()


@pytest.fixture(scope="module")
def place(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("checksummed") / "a.parquet"


@pytest.fixture(scope="module")
def content(place) -> bytes:
    return write(place, PARTS)


def refused(place: Path, content: bytes) -> str:
    place.write_bytes(content)
    with pytest.raises(SettingsError) as caught:
        verified(place, "recording")
    (line,) = str(caught.value).splitlines()
    assert line.startswith(f"{place}: ")
    return line.removeprefix(f"{place}: ")


def ends(content: bytes) -> list[int]:
    """Return the bytes behind each block."""
    told = pq.read_metadata(pa.BufferReader(content)).metadata
    return [block[1] for block in json.loads(told[BLOCKS.encode()])]


def test_what_was_written_is_read(place, content):
    place.write_bytes(content)
    text, file = verified(place, "recording")
    assert text == SAID
    assert header(place, "recording") == (SAID, 3 * ROWS)
    assert file.num_row_groups == len(PARTS)
    for number, part in enumerate(PARTS):
        assert file.read_row_group(number).to_pylist() == part.to_pylist()


def test_any_program_that_knows_parquet_reads_it(place, content):
    place.write_bytes(content)
    assert pq.read_table(place).to_pylist() == pa.concat_tables(PARTS).to_pylist()
    assert pq.read_metadata(place).metadata[TEXT.encode()].decode() == SAID


def test_every_byte_is_covered(content):
    """The blocks cover the file up to its footer, which has a checksum of its own."""
    assert CHECKSUM.encode() in pq.read_metadata(pa.BufferReader(content)).metadata
    footer = int.from_bytes(content[-8:-4], "little")
    assert ends(content)[-1] == len(content) - 8 - footer


def test_the_same_tables_are_written_in_the_same_bytes(tmp_path, content):
    assert write(tmp_path / "again.parquet", PARTS) == content


@given(data=st.data())
def test_any_byte_that_is_changed_is_found_and_placed(place, content, data):
    at = data.draw(st.integers(0, len(content) - 1))
    flip = data.draw(st.integers(1, 255))
    why = refused(place, content[:at] + bytes([content[at] ^ flip]) + content[at + 1 :])
    behind = ends(content)
    if at >= behind[-1]:
        with pytest.raises(SettingsError):
            header(place, "recording")
    for number, (begin, end) in enumerate(zip([0, *behind], behind, strict=False)):
        if begin <= at < end:
            assert why == f"is altered between bytes {begin:,} and {end:,}: part {number}"
            return
    assert "at its end" in why or "without its end" in why


@given(share=st.floats(0.0, 1.0, exclude_max=True), missing=st.integers(1, 3_000))
def test_wherever_it_is_cut_short_it_is_refused(place, content, share, missing):
    for size in (int(share * len(content)), max(len(content) - missing, 0)):
        cut_short(place, content, size)


def cut_short(place, content, size):
    why = refused(place, content[:size])
    assert (
        why == "is empty" if size == 0 else "cut short" in why or why.startswith("is no recording")
    )
    if size >= 4:
        assert f"{size:,}" in why


@given(more=st.binary(min_size=1, max_size=300), before=st.booleans())
def test_more_than_was_written_is_refused(place, content, more, before):
    refused(place, more + content if before else content + more)


def test_a_block_in_the_place_of_another_is_found(place, content):
    first, second, third = ends(content)
    block = content[first:second]
    for at in (second, 0):
        moved = content[:at] + block + content[at + len(block) :]
        assert "is altered" in refused(place, moved[: len(content)])
    assert third > second


@pytest.mark.parametrize(
    ("foreign", "why"),
    [
        (b"", "is empty"),
        (b"P", "is no recording"),
        (b"PAR1", "no checksum"),
        (b"PAR1PAR1", "no checksum"),
        (b"hello\n" * 100, "is no recording: it does not begin like one"),
        (bytes(10_000), "is no recording"),
        ("PAR1§ sha256 ".encode() + b"0" * 64 + b"\x4d\0\0\0PAR1", "is altered behind byte 1"),
    ],
)
def test_a_file_of_another_kind_is_refused(place, foreign, why):
    assert why in refused(place, foreign)


def test_a_parquet_file_of_something_else_is_refused(tmp_path):
    path = tmp_path / "other.parquet"
    pq.write_table(PARTS[0], path)
    assert "has no checksum" in refused(path, path.read_bytes())


def test_what_has_checksums_but_says_nothing_of_its_blocks_is_refused(place, monkeypatch):
    for key in ("animat.files.checksummed.BLOCKS", "animat.files.checksummed.TEXT"):
        with monkeypatch.context() as patched:
            patched.setattr(key, "animat.other")
            content = write(place, PARTS)
        assert refused(place, content) == "has right checksums, but holds no recording"


def test_blocks_that_leave_bytes_out_are_refused(place, monkeypatch):
    monkeypatch.setattr(json, "dumps", lambda blocks: json.JSONEncoder().encode(blocks[:-1]))
    assert refused(place, write(place, PARTS)).startswith("no checksum is of the bytes from ")


def test_what_cannot_be_read_is_told(tmp_path):
    (tmp_path / "empty.parquet").touch()
    for path, why in {
        tmp_path / "none.parquet": "no such file",
        tmp_path: "is a directory, not a recording",
        tmp_path / "none" / "a.parquet": "no such file",
        tmp_path / "empty.parquet": "is empty",
        Path("/dev/null"): "is a special file, not a recording",
        Path("/dev/zero"): "is a special file, not a recording",
    }.items():
        with pytest.raises(SettingsError, match=why):
            verified(path, "recording")
    with pytest.raises(SettingsError, match="is no path"):
        verified(Path("a\0b"), "recording")


def test_a_writer_that_fails_says_so(tmp_path, monkeypatch):
    def full(sink, data):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("animat.files.checksummed._Sink.write", full)
    with pytest.raises(OSError, match="No space"):
        write(tmp_path / "a.parquet", PARTS)

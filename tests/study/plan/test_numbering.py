"""Numbers of lives: every life is in one part, and parts say which."""

from __future__ import annotations

import json

from hypothesis import given
from hypothesis import strategies as st

from animat.study.plan.numbering import LARGEST, SMALLEST, SPREAD, Numbering, Part, part_size

COUNTS = st.lists(st.integers(1, 50), min_size=1, max_size=30)
SIZES = st.integers(1, 60)


@given(counts=COUNTS, size=SIZES)
def test_every_life_is_in_one_part_in_order(counts, size):
    numbering = Numbering.of(counts, size)
    lives = [(place, n) for place, count in enumerate(counts) for n in range(count)]
    assert numbering.total == len(lives)
    found = []
    for number in range(numbering.parts):
        pieces = numbering.pieces(number)
        own = [(p.place, n) for p in pieces for n in range(p.start, p.stop)]
        assert len(own) == numbering.rows(number)
        assert 0 < len(own) <= size
        assert all(p.stop > p.start for p in pieces)
        assert len({p.place for p in pieces}) == len(pieces)
        found += own
    assert found == lives


@given(counts=COUNTS, size=SIZES)
def test_a_place_knows_the_parts_it_is_in(counts, size):
    numbering = Numbering.of(counts, size)
    for place in range(len(counts)):
        parts = [
            number
            for number in range(numbering.parts)
            if any(piece.place == place for piece in numbering.pieces(number))
        ]
        assert list(numbering.parts_of(place)) == parts


@given(counts=COUNTS, size=SIZES)
def test_what_is_written_down_is_read_back(counts, size):
    numbering = Numbering.of(counts, size)
    assert Numbering.read(json.loads(json.dumps(numbering.written()))) == numbering


def test_equal_places_are_written_down_in_a_word():
    assert Numbering.of([7] * 100_000, 3).written() == {"in_a_part": 3, "places": [[7, 100_000]]}


def test_nobody_to_live_is_no_part():
    none = Numbering.of([], 8)
    assert (none.total, none.parts) == (0, 0)


@given(total=st.integers(1, 10**10), steps=st.integers(1, 1 << 50), most=st.integers(1, 10**9))
def test_parts_are_as_large_as_they_may_be_and_no_larger(total, steps, most):
    size = part_size(total, steps, most)
    assert 1 <= size <= LARGEST
    assert size == 1 or size * steps <= most
    if size < min(LARGEST, most // steps):
        assert size >= SMALLEST
        assert size == SMALLEST or size * SPREAD >= total


def test_a_part_names_its_file():
    assert Part("lives", 12).file == "lives/part-000012.parquet"
    assert Part("teachers", 0).file == "teachers/part-000000.parquet"

"""How the lives of a study are numbered, and cut into parts.

The lives of the first place have the first numbers, those of the second the next, and so on. A
part is a range of numbers: what is lived at a time and becomes a file. The robots that teach are
numbered and cut in the same way, a place being a class of them.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from itertools import accumulate, groupby, pairwise
from typing import Any, Literal, NamedTuple

Kind = Literal["teachers", "lives"]
KINDS: tuple[Kind, ...] = ("teachers", "lives")

LARGEST = 8_192
"""Lives of a part; the rest of what a part costs is then small beside even the shortest lives."""

SMALLEST = 8
SPREAD = 64
"""A study is cut into about so many parts at least, for that many cores, but not into smaller."""


class Part(NamedTuple):
    """A part of a study, its number counted for its kind."""

    kind: Kind
    number: int

    @property
    def file(self) -> str:
        """The path of the file that completes it."""
        return f"{self.kind}/part-{self.number:06d}.parquet"


class Piece(NamedTuple):
    """Lives of a part that belong together: number `start` to `stop` - 1 of a place."""

    place: int
    start: int
    stop: int


class Numbering(NamedTuple):
    """The numbering of one kind: the first number of each place and the end; lives in a part."""

    starts: list[int]
    size: int

    @classmethod
    def of(cls, counts: list[int], size: int) -> Numbering:
        """Return the numbering of places that have so many lives each."""
        return cls([0, *accumulate(counts)], size)

    @classmethod
    def read(cls, written: dict[str, Any]) -> Numbering:
        """Return a numbering as `written` has it."""
        counts = [count for count, times in written["places"] for _ in range(times)]
        return cls.of(counts, written["in_a_part"])

    def written(self) -> dict[str, Any]:
        """Return all of it in a few words: runs of places that have equally many lives."""
        counts = (stop - start for start, stop in pairwise(self.starts))
        places = [[count, len(list(run))] for count, run in groupby(counts)]
        return {"in_a_part": self.size, "places": places}

    @property
    def total(self) -> int:
        """How many lives there are."""
        return self.starts[-1]

    @property
    def parts(self) -> int:
        """How many parts there are."""
        return math.ceil(self.total / self.size)

    def rows(self, number: int) -> int:
        """Return how many lives a part has."""
        return min(self.size, self.total - number * self.size)

    def pieces(self, number: int) -> list[Piece]:
        """Return what a part is made of."""
        start = number * self.size
        stop = start + self.rows(number)
        found = []
        place = bisect_right(self.starts, start) - 1
        while start < stop:
            until = min(stop, self.starts[place + 1])
            found.append(Piece(place, start - self.starts[place], until - self.starts[place]))
            start, place = until, place + 1
        return found

    def parts_of(self, place: int) -> range:
        """Return the numbers of the parts in which a place is."""
        return range(self.starts[place] // self.size, (self.starts[place + 1] - 1) // self.size + 1)


def part_size(total: int, steps: int, steps_of_a_part: int) -> int:
    """Return how many lives of up to `steps` steps a part is to have, of `total` in all.

    Few enough that Ctrl-C does not wait long for a part, and that all cores have work; many enough
    that the lives cost more than the part.
    """
    spread = max(SMALLEST, math.ceil(total / SPREAD))
    return max(1, min(spread, LARGEST, steps_of_a_part // steps))

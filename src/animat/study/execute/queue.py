"""Which part is lived next: any that is not finished, once those who teach in it have learnt.

Robots learn when a life needs their networks; those that none needs any more, because only their
own file was lost, come last.

Parts are not taken in a row but at even steps through all of them. So what is finished is at any
time a fair sample of all cases, from which the time that is left can be reckoned, and the first
results tell something of every case.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator

from animat.study.plan.numbering import Part
from animat.study.plan.plan import Plan
from animat.study.plan.shard import classes_needed

LOOKED_AHEAD = 64
"""Parts of which the teachers may be awaited at a time."""


class Order:
    """The parts of a plan that are to be lived, one after the other.

    `finished` tells of a part whether it was finished before.
    """

    def __init__(self, plan: Plan, finished: Callable[[Part], bool]) -> None:
        """Begin with what is not finished."""
        self._plan = plan
        self._finished = finished
        self._lives = _spread(plan.numbering["lives"].parts)
        self._teachers: deque[Part] = deque()
        self._missing: dict[int, set[Part]] = {}
        self._asked: set[Part] = set()
        self._learnt: set[Part] = set()
        self._waiting: list[Part] = []

    def next(self) -> Part | None:
        """Return a part that can be lived now; None if there is none, or not yet."""
        for part in self._waiting:
            if self._ready(part):
                self._waiting.remove(part)
                return part
        while not self._teachers and len(self._waiting) < LOOKED_AHEAD:
            number = next(self._lives, None)
            if number is None:
                self._ask(range(len(self._plan.classes)))
                break
            part = Part("lives", number)
            if self._finished(part):
                continue
            self._ask(classes_needed(self._plan, part))
            if self._ready(part):
                return part
            self._waiting.append(part)
        return self._teachers.popleft() if self._teachers else None

    def done(self, part: Part) -> None:
        """Take note that a part is finished."""
        if part.kind == "teachers":
            self._learnt.add(part)
        for missing in self._missing.values():
            missing.discard(part)

    def _ask(self, places: Iterable[int]) -> None:
        """Put those of some classes who have not learnt yet onto the list."""
        for place in places:
            if place in self._missing:
                continue
            wanted = self._plan.parts_of_class(place)
            missing = {one for one in wanted if not self._finished(one)} - self._learnt
            self._missing[place] = missing
            self._teachers += [one for one in wanted if one in missing - self._asked]
            self._asked |= missing

    def _ready(self, part: Part) -> bool:
        return not any(self._missing[place] for place in classes_needed(self._plan, part))


def _spread(count: int) -> Iterator[int]:
    """Yield 0 to `count` - 1 so that the first n of them lie evenly, whatever n is.

    These are the numbers with their bits in reverse, van der Corput's sequence.
    """
    bits = (count - 1).bit_length()
    for n in range(1 << bits):
        place = int(f"{n:0{bits}b}"[::-1], 2)
        if place < count:
            yield place

"""How fast a study is lived, and how long it will take.

Lives differ in length, so what is left is reckoned in steps: robots that learn live to their cap,
and the lives to come are taken to be as long as those lived so far, which are a fair sample.
"""

from __future__ import annotations

from typing import NamedTuple

from animat.progress import in_words
from animat.study.store.tally import Tally


class Pace(NamedTuple):
    """What is finished of a study, and how fast.

    `steps_to_learn` are those of all robots that teach. `seconds` were needed for the last
    `measured` steps.
    """

    tally: Tally
    steps_to_learn: int
    measured: int
    seconds: float

    def speed(self) -> float | None:
        """Return the steps lived in a second; None as long as nothing is measured."""
        return self.measured / self.seconds if self.measured and self.seconds > 0.0 else None

    def left(self) -> float | None:
        """Return the seconds that are left; None as long as nobody can tell."""
        speed, lives = self.speed(), self.tally.counts["lives"]
        to_live = self.tally.numbering["lives"].total - lives.rows
        if not to_live:
            return 0.0
        if speed is None or not lives.rows:
            return None
        to_learn = max(0, self.steps_to_learn - self.tally.counts["teachers"].steps)
        return (to_learn + to_live * lives.steps / lives.rows) / speed

    def __str__(self) -> str:
        """Return the time left and the speed in words."""
        speed, left = self.speed(), self.left()
        told = "time left not known yet" if left is None else f"about {in_words(left)} left"
        return told if speed is None else f"{told}, {speed / 1e6:.1f} million steps/s"

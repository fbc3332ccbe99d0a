"""The time left, reckoned from what is done."""

from __future__ import annotations

import pytest

from animat.study.plan.numbering import Numbering, Part
from animat.study.store.eta import Pace
from animat.study.store.tally import Tally

NUMBERING = {"lives": Numbering.of([100], 10), "teachers": Numbering.of([4], 2)}


def pace(lives=0, teachers=0, measured=0, seconds=0.0):
    tally = Tally(NUMBERING, [1])
    for number in range(lives):
        tally.add(Part("lives", number), 500, 0)
    for number in range(teachers):
        tally.add(Part("teachers", number), 4_000, 0)
    return Pace(tally, 8_000, measured, seconds)


def test_nobody_can_tell_before_anything_is_measured():
    for own in (pace(), pace(3), pace(0, 1, 1_000, 2.0)):
        assert own.left() is None
        assert "time left not known yet" in str(own)
    assert pace().speed() is None


def test_what_is_left_is_what_lives_and_robots_have_to_live():
    own = pace(lives=4, teachers=1, measured=3_000, seconds=2.0)
    assert own.speed() == pytest.approx(1_500.0)
    assert own.left() == pytest.approx((4_000 + 60 * 50) / 1_500.0)
    assert str(own) == "about 5 s left, 0.0 million steps/s"


def test_nothing_is_left_at_the_end():
    assert pace(lives=10, teachers=2).left() == 0.0


def test_robots_that_failed_leave_nothing_to_learn():
    tally = Tally(NUMBERING, [1])
    tally.add(Part("lives", 0), 500, 0)
    assert Pace(tally, 0, 100, 1.0).left() == pytest.approx(90 * 50 / 100)

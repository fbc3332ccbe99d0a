"""Counting what is finished."""

from __future__ import annotations

from animat.study.plan.numbering import Numbering, Part
from animat.study.store.tally import Counts, Tally


def tally():
    """Three places of 5 lives for 1, 2 and 1 cases, in parts of 4; 3 robots in parts of 2."""
    return Tally({"lives": Numbering.of([5, 5, 5], 4), "teachers": Numbering.of([3], 2)}, [1, 2, 1])


def test_what_is_added_is_counted():
    own = tally()
    own.add(Part("lives", 3), 70, 1)
    own.add(Part("lives", 1), 40, 0)
    own.add(Part("teachers", 0), 10, 2)
    assert own.counts["lives"] == Counts(7, 110, 1)
    assert own.counts["teachers"] == Counts(2, 10, 2)
    assert own.finished(Part("lives", 1))
    assert not own.finished(Part("lives", 0))
    assert not own.finished(Part("teachers", 1))


def test_a_part_counts_once():
    own = tally()
    own.add(Part("lives", 1), 40, 1)
    own.add(Part("lives", 1), 40, 1)
    assert own.counts["lives"] == Counts(4, 40, 1)


def test_a_case_is_finished_when_all_its_lives_are_and_counts_for_all_that_share_them():
    own = tally()
    finished = []
    for number in (1, 2, 0, 3):
        own.add(Part("lives", number), 1, 0)
        finished.append(own.finished_cases)
    assert finished == [0, 2, 3, 4]
    assert not own.complete
    own.add(Part("teachers", 0), 1, 0)
    assert not own.complete
    own.add(Part("teachers", 1), 1, 0)
    assert own.complete

"""Which part comes next."""

from __future__ import annotations

import numpy as np
import pytest

from animat.study.execute.queue import Order, _spread
from animat.study.plan.numbering import Part
from animat.study.plan.shard import classes_needed

STUDY = """
name = "taught"
lives = 40
steps = 10
[teacher]
robots = 12
steps = 10
[design.grid]
"mind.agent" = ["BLIND", "AF"]
"mind.learning.cycles" = [1, 2]
"""


@pytest.fixture(scope="module")
def plan(faults):
    return faults.plan(STUDY)


def all_of(order, at_once=1):
    """The parts in the order in which they come, each finished after `at_once` more were taken."""
    taken, under_way = [], []
    while True:
        part = order.next()
        if part is not None:
            taken.append(part)
            under_way.append(part)
        elif not under_way:
            return taken
        if part is None or len(under_way) > at_once:
            order.done(under_way.pop(0))


@pytest.mark.parametrize("at_once", [1, 3, 100])
def test_every_part_comes_once(plan, at_once):
    taken = all_of(Order(plan, lambda _: False), at_once)
    assert sorted(taken) == sorted(plan.all_parts())
    assert len(plan.classes) == 2


@pytest.mark.parametrize("at_once", [1, 100])
def test_no_life_comes_before_those_who_teach_it_have_learnt(plan, at_once):
    order = Order(plan, lambda _: False)
    finished, under_way = set(), []
    while True:
        part = order.next()
        if part is not None:
            for place in classes_needed(plan, part):
                assert set(plan.parts_of_class(place)) <= finished
            under_way.append(part)
        elif not under_way:
            break
        if part is None or len(under_way) > at_once:
            finished.add(under_way[0])
            order.done(under_way.pop(0))
    assert finished == set(plan.all_parts())


def test_what_is_finished_does_not_come_again(plan):
    parts = list(plan.all_parts())
    before = {part for n, part in enumerate(parts) if n % 3}
    taken = all_of(Order(plan, before.__contains__))
    assert sorted(taken) == sorted(set(parts) - before)


def test_robots_that_no_life_needs_any_more_come_last(plan):
    before = {part for part in plan.all_parts() if part.kind == "lives"}
    before.discard(Part("lives", 0))
    assert classes_needed(plan, Part("lives", 0)) == []
    taken = all_of(Order(plan, before.__contains__), at_once=1)
    assert taken[0] == Part("lives", 0)
    assert {part.kind for part in taken[1:]} == {"teachers"}


def test_robots_learn_only_when_a_life_needs_them(plan):
    kinds = [part.kind for part in all_of(Order(plan, lambda _: False))]
    assert kinds[0] == "lives"
    assert "lives" in kinds[: kinds.index("teachers")]


@pytest.mark.parametrize("count", [1, 2, 3, 7, 10, 64, 97, 1_000])
def test_the_first_parts_lie_evenly_among_all(count):
    order = np.array(list(_spread(count)))
    assert sorted(order) == list(range(count))
    for first in (5, 20, 100):
        if first < count:
            gaps = np.diff(np.sort(order[:first]))
            assert gaps.max() <= 3.0 * count / first

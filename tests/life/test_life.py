"""Moments: a life can be left at any step, and gone on with from there as often as one likes."""

from __future__ import annotations

import numpy as np
import pytest

from animat.life.life import Moment, birth, live, lived
from animat.life.scenario import LifeError, bring_together
from animat.mind.mind import Mind

LEARNER = Mind(agent="LEARNING")


@pytest.fixture
def moment(small) -> Moment:
    """A learner after 300 steps."""
    moment = birth(bring_together(LEARNER, small), 1, 2)
    assert list(lived(moment, 300, None)) == []
    assert moment.step == 300
    return moment


@pytest.mark.parametrize("record", ["all", "every:7", "last:50", "last:800", None])
def test_a_life_that_was_left_is_the_life_that_was_not(moment, small, record):
    whole = live(LEARNER, small, seed=1, life=2, steps=700, record=record)
    rest = moment.live(700, record)
    assert rest.summary == whole.summary
    assert (rest.seed, rest.index, rest.setting) == (1, 2, moment.setting)
    if record is None:
        assert rest.trace is None
    else:
        assert rest.trace is not None
        assert whole.trace is not None
        rows = [row for row in whole.trace.to_pylist() if row["step"] >= 300]
        assert rest.trace.to_pylist() == rows
        assert len(rows) > 0


def test_a_moment_stays_as_it_is_while_the_life_goes_on(moment):
    before, told = moment.digest, []
    later = moment.live(900, progress=told.append)
    assert later.lifespan == 900
    assert sum(told) == 600
    assert moment.digest == before
    other = moment.copy()
    assert list(lived(other, 301, None)) == []
    assert (moment.step, other.step) == (300, 301)
    assert moment.digest == before != other.digest


def test_a_digest_is_of_the_state_and_of_what_stands_where(moment):
    other = moment.copy()
    assert other.digest == moment.digest
    other.present[0, 0] = 0
    assert other.digest != moment.digest
    other = moment.copy()
    other.states["drive_sum"] = np.nextafter(other.states["drive_sum"], np.inf)
    assert other.digest != moment.digest


def test_a_life_that_has_lived_so_long_already_goes_on_no_further(moment):
    life = moment.live(300, "all")
    assert life.lifespan == 300
    assert life.trace is not None
    assert life.trace.num_rows == 0
    assert moment.live(299, "last:3").trace.num_rows == 0


def test_what_cannot_be_lived_is_refused(moment):
    for steps, record, why in ((0, None, "steps = 0"), (900, "some", 'record = "some"')):
        with pytest.raises(LifeError, match=why):
            moment.live(steps, record)

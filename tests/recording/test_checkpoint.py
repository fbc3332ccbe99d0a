"""A moment that was kept is the moment again, but for what holds nothing from step to step."""

from __future__ import annotations

import numpy as np
import pytest

from animat.life.digest import SCRATCH
from animat.life.life import birth, live_unrecorded
from animat.life.scenario import LifeError, bring_together
from animat.mind.mind import Mind
from animat.recording.checkpoint import Kept, fields_of, keep, opened, restored


@pytest.fixture(scope="module")
def moment(spared):
    moment = birth(bring_together(Mind(agent="LEARNING", consumed=True), spared), 3, 2**64 - 1)
    live_unrecorded(moment, 8_000)
    assert moment.state.trainings > 0
    assert moment.present.sum() == spared.n_objects
    return moment


@pytest.fixture(scope="module")
def fields(moment):
    return fields_of(moment.states.dtype)


def test_what_is_kept_comes_back_to_the_bit(moment, fields):
    again = restored(keep(moment, fields), fields, moment.setting, 3, 2**64 - 1)
    for name in moment.states.dtype.names:
        if name not in SCRATCH:
            assert again.states[name].tobytes() == moment.states[name].tobytes(), name
    assert again.present.tobytes() == moment.present.tobytes()
    assert again.digest == moment.digest
    assert (again.seed, again.index, again.setting) == (3, 2**64 - 1, moment.setting)


def test_fields_may_be_kept_in_any_order(moment, fields):
    state, _ = opened(keep(moment, fields), fields)
    order = fields[::-1]
    other = np.zeros(1, np.dtype(list(order)))
    for name, *_ in order:
        other[name] = state[name]
    kept = keep(moment, order)
    assert kept.state == other.tobytes() != keep(moment, fields).state
    assert restored(kept, order, moment.setting, 3, 2**64 - 1).digest == moment.digest


def test_every_field_is_kept_but_room_to_work_in(moment, fields):
    assert {name for name, *_ in fields} == set(moment.states.dtype.names) - set(SCRATCH)
    assert all(kind[0] in "<|" for _, kind, _ in fields)
    size = sum(np.dtype((kind, shape)).itemsize for _, kind, shape in fields)
    assert len(keep(moment, fields).state) == size


def test_what_does_not_fit_is_refused(moment, fields):
    kept = keep(moment, fields)

    def why(kept: Kept, layout=fields) -> str:
        with pytest.raises(LifeError) as caught:
            restored(kept, layout, moment.setting, 3, 2**64 - 1)
        return str(caught.value)

    assert "does not fit its digest" in why(kept._replace(digest="0" * 32))
    flipped = bytes([kept.state[0] ^ 1]) + kept.state[1:]
    assert "before step 8000 does not fit its digest" in why(kept._replace(state=flipped))
    assert f"bytes, this one {len(kept.state) - 1}" in why(kept._replace(state=kept.state[:-1]))
    sites = len(kept.present)
    more = kept._replace(present=kept.present + b"\0")
    assert f"tells of {sites + 1} sites, its world has {sites}" in why(more)
    assert "differ in step" in why(kept, tuple(f for f in fields if f[0] != "step"))
    assert "differ in soul" in why(kept, (*fields, ("soul", "<f8", ())))
    assert "differ in x" in why(kept, (("x", "<f4", ()), *fields[1:]))

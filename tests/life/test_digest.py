"""The digest tells lives apart to the last bit, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from animat.life.batch import advance
from animat.life.digest import SCRATCH, digest
from animat.life.scenario import bring_together
from animat.life.state import STATE, Counts
from animat.mind.mind import Mind

DTYPE = STATE.dtype(Counts(V=3, D=3, B=3, N=8, F=2, H=2, W=9)._asdict())


@pytest.fixture
def state():
    """A state that holds something else in every field."""
    states = np.zeros(1, DTYPE)
    for number, name in enumerate(DTYPE.names or ()):
        states[name] = number / 7 if DTYPE[name].base.kind == "f" else number + 1
    return states[0]


PRESENT = np.array([1, 0, 1], np.uint8)


def changed(state, name):
    """Return the state with the last bit of each element of a field changed, one at a time."""
    for element in range(np.asarray(state[name]).size):
        other = np.array([state], state.dtype)
        bits = other[name].reshape(-1).view(np.uint8).reshape(-1, other[name].dtype.itemsize)
        bits[element, 0] ^= 1
        other[name] = bits.reshape(-1).view(other[name].dtype).reshape(other[name].shape)
        yield other[0]


def test_a_digest_is_of_32_digits(state):
    assert len(digest(state, PRESENT)) == 32
    assert int(digest(state, PRESENT), 16) > 0


def test_it_tells_the_last_bit_of_every_field_and_every_object(state):
    others = [digest(state, PRESENT)]
    for name in set(DTYPE.names or ()) - set(SCRATCH):
        others += [digest(other, PRESENT) for other in changed(state, name)]
    for site in range(len(PRESENT)):
        present = PRESENT.copy()
        present[site] ^= 1
        others.append(digest(state, present))
    others.append(digest(state, PRESENT[:2]))
    assert len(others) > 60
    assert len(set(others)) == len(others)


def test_it_leaves_out_what_holds_nothing_from_step_to_step(state):
    for name in SCRATCH:
        others = [digest(other, PRESENT) for other in changed(state, name)]
        assert set(others) == {digest(state, PRESENT)}


@pytest.mark.parametrize("agent", ["LEARNING", "BLIND"])
def test_what_it_leaves_out_holds_nothing_from_step_to_step(agent, small):
    """A life in which the scratch fields are overwritten after every step is the same life."""
    setting = bring_together(Mind(agent=agent, death=False), small)
    lives = np.arange(3, dtype=np.uint64)
    ends = []
    for spoilt in (False, True):
        states, present = setting.begin(4, lives)
        for until in range(1, 1_501):
            advance(setting, 4, lives, states, present, until)
            if spoilt:
                for name in SCRATCH:
                    values = {"i": 10**9, "u": 255, "f": np.nan}
                    states[name] = values[states[name].dtype.kind]
        assert (states["acts"] > 0).all()
        ends.append([digest(*one) for one in zip(states, present, strict=True)])
    assert ends[0] == ends[1]


def test_neither_order_nor_gaps_nor_byte_order_matter(state):
    names = sorted(DTYPE.names or (), key=lambda name: name[::-1])
    packed = np.dtype([(name, DTYPE[name]) for name in names])
    aligned = np.dtype([(name, DTYPE[name]) for name in names], align=True)
    assert packed.itemsize != aligned.itemsize
    for layout in (packed, aligned, packed.newbyteorder()):
        other = np.zeros(1, layout)
        for name in names:
            other[name] = state[name]
        assert digest(other[0], PRESENT) == digest(state, PRESENT)


def test_zeros_have_a_sign_and_every_not_a_number_is_the_same(state):
    digests = []
    for bits in (0x0, 1 << 63, 0x7FF8 << 48, 0xFFF8 << 48, (0x7FF8 << 48) + 1):
        other = np.array([state], DTYPE)
        other["x"] = np.array([bits], np.uint64).view(np.float64)
        digests.append(digest(other[0], PRESENT))
    assert len(set(digests[:3])) == 3
    assert digests[2] == digests[3] == digests[4]

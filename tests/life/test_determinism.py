"""The same bits: on any machine, compiled or not, recorded or not, however a life is cut up."""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from animat.life.life import live
from animat.life.lives import live_on
from animat.life.setting import bring_together
from animat.mind.mind import Mind

SCRIPT = Path(__file__).with_name("golden.py")


@pytest.fixture(scope="module")
def golden():
    spec = importlib.util.spec_from_file_location("golden_lives", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def known(golden):
    return json.loads(golden.FILE.read_text(encoding="utf-8"))


def test_golden_lives_are_lived_to_the_bit(golden, known):
    assert golden.hashes(golden.LONG) == known[str(golden.LONG)]


def test_golden_lives_are_the_same_uncompiled_and_without_a_warning(golden, known):
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(
        [sys.executable, "-W", "error", str(SCRIPT), "--print", str(golden.SHORT)],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stderr == ""
    assert json.loads(done.stdout) == known[str(golden.SHORT)]


def test_golden_lives_are_lives_of_many_kinds(golden, known):
    for steps in (golden.SHORT, golden.LONG):
        told = known[str(steps)]
        assert list(told) == [name for name, _, _ in golden.cases()]
        assert len(set(told.values())) > 0.9 * len(told)
    short, ends = (
        [
            live(mind, golden.WORLD, robot=robot, seed=2**63 + 3, life=5, steps=steps).state
            for _, mind, robot in golden.cases()
        ]
        for steps in (golden.SHORT, golden.LONG)
    )
    assert sum(state.acts > 0 for state in short) > 0.8 * len(short)
    assert sum(state.disregarded > 0 for state in ends) > 0
    assert sum(state.trainings > 0 for state in ends) > 0
    assert sum(state.blocked > 0 for state in ends) > 0


def test_a_digest_tells_the_last_bit_of_any_field(golden, small):
    state = live(Mind(), small, steps=100).state
    assert golden.digest(state) == golden.digest(live(Mind(), small, steps=100).state)
    for name in state.dtype.names:
        other = np.array([state], state.dtype)
        other[name].view(np.uint8).reshape(-1)[0] ^= 1
        assert golden.digest(other[0]) != golden.digest(state), name


@pytest.mark.parametrize("cut", [1, 7, 1_000])
def test_a_life_may_be_cut_anywhere(cut, small, golden):
    setting = bring_together(Mind(agent="LEARNING"), small)
    lives = np.array([3], np.uint64)
    states, present = setting.begin(8, lives)
    for until in [*range(cut, 1_500, cut), 1_500]:
        live_on(setting, 8, lives, states, present, until)
    whole = live(Mind(agent="LEARNING"), small, seed=8, life=3, steps=1_500)
    assert golden.digest(states[0]) == golden.digest(whole.state)


def test_a_batch_and_its_order_do_not_matter(small, golden):
    setting = bring_together(Mind(), small)
    indices = np.array([0, 1, 2, 3, 2**40, 2**64 - 1], np.uint64)
    alone = {
        int(index): golden.digest(live(Mind(), small, seed=1, life=int(index), steps=900).state)
        for index in indices
    }
    assert len(set(alone.values())) == len(indices)
    for places in ([0, 1, 2, 3, 4, 5], [5, 4, 3, 2, 1, 0], [3, 0, 5, 1, 4, 2]):
        order = indices[places]
        states, present = setting.begin(1, order)
        live_on(setting, 1, order, states, present, 900)
        assert [golden.digest(s) for s in states] == [alone[int(index)] for index in order]


@pytest.mark.parametrize("seed", [0, 1, 2**32, 2**64 - 1])
def test_every_seed_and_life_is_another_life(seed, small):
    starts = {
        (float(state.x), float(state.y))
        for state in (
            live(Mind(), small, seed=seed ^ flip, life=life, steps=1).state
            for flip in (0, 1, 2**63)
            for life in (0, 1, 2**32)
        )
    }
    assert len(starts) == 9

"""Every setting of learning does what it says."""

import numpy as np
import pytest

SLOW = {
    name: {"rate": 1e-9, "start": start}
    for name, start in (("nutrition", 0.5), ("stamina", 0.5), ("restlessness", 0.9))
}


def first_lesson(c, step_by_step):
    """The state before and after the first training of a life."""
    life = c.life
    before = None
    for state, _ in step_by_step(life.mind, life.world, life.lifespan, seed=4):
        if state.trainings == 1:
            return before, state
        before = state
    raise AssertionError("it never trained")


def taught(weights, features, target, rate, cycles, biases):
    """Back-propagation through a 2-2-1 network, in NumPy."""
    hidden_weights = weights[:6].reshape(2, 3).copy()
    output_weights = weights[6:].copy()
    inputs = np.concatenate([[1.0], features])
    mask = 1.0 if biases else 0.0
    for _ in range(cycles):
        hidden = 1 / (1 + np.exp(-hidden_weights @ inputs))
        output = 1 / (1 + np.exp(-(output_weights[0] + output_weights[1:] @ hidden)))
        delta = (target - output) * output * (1 - output)
        back = delta * output_weights[1:] * hidden * (1 - hidden)
        hidden_weights += rate * np.outer(back, inputs * [mask, 1.0, 1.0])
        output_weights += rate * delta * np.concatenate([[mask], hidden])
    return np.concatenate([hidden_weights.ravel(), output_weights])


def lesson_follows(c, step_by_step, rate=0.5, cycles=10, biases=True):
    before, after = first_lesson(c, step_by_step)
    b = before.behaviour
    target = 1.0 if after.reward == 1 else 0.0
    wanted = taught(before.weights[b], after.features, target, rate, cycles, biases)
    assert np.abs(after.weights[b] - wanted).max() < 1e-13
    return before


def test_learning_rate(lived, step_by_step):
    for rate in (0.5, 0.2):
        c = lived(agent="LEARNING", learning={"rate": rate})
        lesson_follows(c, step_by_step, rate=rate)


def test_learning_cycles(lived, step_by_step):
    for cycles in (10, 3):
        c = lived(agent="LEARNING", learning={"cycles": cycles})
        lesson_follows(c, step_by_step, cycles=cycles)


def test_learning_biases(lived, step_by_step):
    places = [0, 3, 6]
    for biases in (True, False):
        c = lived(agent="LEARNING", learning={"biases": biases})
        before = lesson_follows(c, step_by_step, biases=biases)
        assert (before.weights[:, places] != 0.0).all() == biases
        assert (c.life.state.weights[:, places] != 0.0).any() == biases


@pytest.mark.parametrize(("threshold", "learns"), [(0.19, True), (0.21, False)])
def test_learning_threshold(threshold, learns, lived):
    c = lived(agent="LEARNING", learning={"threshold": threshold}, variables=SLOW)
    assert (c["reward"] != 0).any()
    assert c.happened("trained").any() == learns

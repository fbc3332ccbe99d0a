import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.neural_network import MLPClassifier

from animat.mind.affordance import (
    BACK_PROPAGATION,
    CUSTOM_ESTIMATOR,
    CUSTOM_LEARNER,
    FEED_FORWARD,
    back_propagate,
    estimate,
    feed_forward,
    learn,
    weight_count,
)
from animat.mind.mind import Mind
from animat.mind.parameters import parameters
from animat.numerics.compiled import compiled

OBJECTS = np.array([[0, 0], [0, 1], [1, 0], [1, 1]], float)
TABLE_1 = {
    "grasp": [True, False, True, False],
    "shelter": [False, True, False, True],
    "interact": [True, True, True, True],
}


def layers(weights, features, hidden):
    """Split a row of weights into W1 [H, F], b1 [H], w2 [H], b2, as views."""
    first = weights[: hidden * (features + 1)].reshape(hidden, features + 1)
    last = weights[hidden * (features + 1) :]
    return first[:, 1:], first[:, 0], last[1:], last[:1]


def matrix_output(inputs, weights, hidden):
    w1, b1, w2, b2 = layers(weights, len(inputs), hidden)
    units = 1 / (1 + np.exp(-(w1 @ inputs + b1)))
    return units, (1 / (1 + np.exp(-(w2 @ units + b2))))[0]


def matrix_training(inputs, weights, hidden, target, rate, biases):
    """One cycle of back-propagation in matrices, as a textbook has it."""
    units, output = matrix_output(inputs, weights, hidden)
    w1, b1, w2, b2 = layers(weights, len(inputs), hidden)
    delta_2 = (output - target) * output * (1 - output)
    delta_1 = delta_2 * w2 * units * (1 - units)
    w2 -= rate * delta_2 * units
    w1 -= rate * np.outer(delta_1, inputs)
    if biases:
        b2 -= rate * delta_2
        b1 -= rate * delta_1


@st.composite
def networks(draw):
    """Inputs [F], weights [W], the number of hidden units, and whether it has biases."""
    features, hidden = draw(st.integers(1, 5)), draw(st.integers(1, 5))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    weights = rng.normal(0.0, 2.0, weight_count(features, hidden))
    biases = draw(st.booleans())
    if not biases:
        _, b1, _, b2 = layers(weights, features, hidden)
        b1[:] = 0.0
        b2[:] = 0.0
    return rng.normal(0.0, 1.5, features), weights, hidden, biases


@given(networks())
def test_the_output_is_that_of_matrices(network):
    inputs, weights, hidden, _ = network
    room = np.zeros(hidden)
    units, output = matrix_output(inputs, weights, hidden)
    assert feed_forward(inputs, weights, room) == pytest.approx(output, rel=1e-13)
    np.testing.assert_allclose(room, units, rtol=1e-13)


@given(networks(), st.floats(0, 1), st.floats(0.01, 1.0), st.integers(1, 20))
def test_training_is_that_of_matrices(network, target, rate, cycles):
    inputs, weights, hidden, biases = network
    wanted = weights.copy()
    for _ in range(cycles):
        matrix_training(inputs, wanted, hidden, target, rate, biases)
    back_propagate(inputs, weights, np.zeros(hidden), target, rate, cycles, biases)
    np.testing.assert_allclose(weights, wanted, rtol=1e-11, atol=1e-13)


@given(networks(), st.floats(0, 1))
def test_one_cycle_goes_down_the_gradient_of_half_the_squared_error(network, target):
    inputs, weights, hidden, biases = network
    room = np.zeros(hidden)
    gradient = np.zeros(len(weights))
    for w in range(len(weights)):
        error = []
        for nudge in (1e-5, -1e-5):
            nudged = weights.copy()
            nudged[w] += nudge
            error.append((target - feed_forward(inputs, nudged, room)) ** 2 / 2)
        gradient[w] = (error[0] - error[1]) / 2e-5
    if not biases:
        _, b1, _, b2 = layers(gradient, len(inputs), hidden)
        b1[:] = 0.0
        b2[:] = 0.0
    trained = weights.copy()
    back_propagate(inputs, trained, room, target, 0.25, 1, biases)
    np.testing.assert_allclose((weights - trained) / 0.25, gradient, atol=1e-8)


@given(networks(), st.integers(0, 1))
def test_output_and_gradient_agree_with_scikit_learn(network, target):
    """scikit-learn descends the log-loss, whose gradient lacks the factor output (1 - output)."""
    inputs, weights, hidden, _ = network
    peer = MLPClassifier(
        hidden, activation="logistic", solver="sgd", alpha=0, momentum=0, learning_rate_init=1.0
    )
    peer.partial_fit(inputs[None], [target], classes=[0, 1])
    w1, b1, w2, b2 = layers(weights, len(inputs), hidden)
    mirrored = (
        (peer.coefs_[0], w1.T),
        (peer.intercepts_[0], b1),
        (peer.coefs_[1], w2[:, None]),
        (peer.intercepts_[1], b2),
    )
    for theirs, ours in mirrored:
        theirs[:] = ours
    output = feed_forward(inputs, weights, np.zeros(hidden))
    assert peer.predict_proba(inputs[None])[0, 1] == pytest.approx(output, rel=1e-12)

    before = [ours.copy() for _, ours in mirrored]
    peer.partial_fit(inputs[None], [target])
    back_propagate(inputs, weights, np.zeros(hidden), float(target), 1.0, 1, True)
    for (theirs, ours), old in zip(mirrored, before, strict=True):
        np.testing.assert_allclose(
            ours - old, (theirs - old) * output * (1 - output), rtol=1e-7, atol=1e-14
        )


@given(networks(), st.floats(0, 1))
def test_without_biases_their_places_stay_empty(network, target):
    inputs, weights, hidden, biases = network
    before = weights.copy()
    back_propagate(inputs, weights, np.zeros(hidden), target, 0.5, 3, biases)
    _, b1, _, b2 = layers(weights, len(inputs), hidden)
    _, old_b1, _, old_b2 = layers(before, len(inputs), hidden)
    if biases:
        assert (b2 != old_b2) == (target != feed_forward(inputs, before, np.zeros(hidden)))
    else:
        assert not b1.any()
        assert not b2.any()
        assert not old_b1.any()
        assert not old_b2.any()


@compiled
def classified(weights, hidden, truth, objects):
    """Tell whether the network is on the right side of 0.5 for every object."""
    for k in range(len(objects)):
        if (feed_forward(objects[k], weights, hidden) >= 0.5) != truth[k]:
            return False
    return True


@compiled
def episodes_to_learn(weights, hidden, truth, objects, order, rate, cycles):
    """Train one episode per entry of `order`; return after how many all objects stay right."""
    learnt = 0
    for e in range(len(order)):
        k = order[e]
        target = 1.0 if truth[k] else 0.0
        back_propagate(objects[k], weights, hidden, target, rate, cycles, True)
        if not classified(weights, hidden, truth, objects):
            learnt = e + 1
    return learnt


def episodes(affordance, rate, cycles, in_turn, robots=300, limit=300):
    rng = np.random.default_rng(7)
    truth = np.array(TABLE_1[affordance])
    counts = []
    for _ in range(robots):
        weights = rng.random(weight_count(2, 2))
        order = np.arange(limit) % 4 if in_turn else rng.integers(4, size=limit)
        counts.append(episodes_to_learn(weights, np.zeros(2), truth, OBJECTS, order, rate, cycles))
    return np.array(counts)


@pytest.mark.parametrize("affordance", ["grasp", "shelter"])
def test_ten_cycles_at_a_half_learn_table_1_in_about_70_episodes(affordance):
    assert np.mean(episodes(affordance, 0.5, 10, in_turn=True) <= 70) > 0.9
    shuffled = episodes(affordance, 0.5, 10, in_turn=False)
    assert 55 < np.median(shuffled) < 85
    assert np.mean(shuffled < 200) > 0.99


@pytest.mark.parametrize("affordance", ["grasp", "shelter"])
def test_one_cycle_at_a_tenth_does_not_learn_table_1_in_70_episodes(affordance):
    assert (episodes(affordance, 0.1, 1, in_turn=True, limit=70) >= 69).all()
    assert np.mean(episodes(affordance, 0.1, 1, in_turn=False, limit=70) >= 60) > 0.99


def test_what_everything_affords_needs_no_learning():
    assert not episodes("interact", 0.5, 10, in_turn=False).any()


@pytest.mark.parametrize("biases", [True, False])
def test_an_untrained_robot_is_optimistic(biases):
    rng = np.random.default_rng(3)
    for _ in range(500):
        weights = rng.random(weight_count(2, 2))
        if not biases:
            weights[[0, 3, 6]] = 0.0
        assert all(feed_forward(each, weights, np.zeros(2)) > 0.5 for each in OBJECTS)


@compiled
def certain(features, weights, hidden):
    return 1.0


@compiled
def set_all(features, weights, hidden, target, rate, cycles, biases):
    for w in range(len(weights)):
        weights[w] = target


def test_estimators_and_learners_answer_to_their_codes():
    features, weights, hidden = np.ones(2), np.zeros(9), np.zeros(2)
    assert estimate(FEED_FORWARD, features, weights, hidden, certain) == 0.5
    assert estimate(CUSTOM_ESTIMATOR, features, weights, hidden, certain) == 1.0
    learn(CUSTOM_LEARNER, features, weights, hidden, 0.25, 0.5, 1, True, set_all)
    np.testing.assert_array_equal(weights, 0.25)
    wanted = weights.copy()
    matrix_training(features, wanted, 2, 1.0, 0.5, True)
    learn(BACK_PROPAGATION, features, weights, hidden, 1.0, 0.5, 1, True, set_all)
    np.testing.assert_allclose(weights, wanted, rtol=1e-12)


def test_a_mind_names_its_estimator_and_learner():
    names = ("grasp", "shelter", "interact")
    record = parameters(Mind(), names)
    assert (record.estimator, record.learner) == (FEED_FORWARD, BACK_PROPAGATION)
    own = {"estimator": certain.py_func, "learner": set_all.py_func}
    record = parameters(Mind(learning=own), names)
    assert (record.estimator, record.learner) == (CUSTOM_ESTIMATOR, CUSTOM_LEARNER)

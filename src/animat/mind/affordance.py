"""Affordance networks: how likely an object is to afford a behaviour, learnt from its outcomes.

One feed-forward network per behaviour, F inputs, H logistic hidden units, one logistic output.
Its weights are one row of W = H (F + 1) + H + 1 numbers: for each hidden unit its bias and its F
weights, then the bias of the output and its H weights. Without biases the bias places stay 0.

An estimator has the signature `estimate(features, weights, hidden) -> likelihood` and a learner
`learn(features, weights, hidden, target, rate, cycles, biases)`, which changes `weights` in place:
`features` [F], `weights` [W], and `hidden` [H], room for what the hidden units put out.
"""

from __future__ import annotations

from typing import Any

from animat.numerics.compiled import compiled
from animat.numerics.elementary import logistic

FEED_FORWARD, CUSTOM_ESTIMATOR = range(2)
BACK_PROPAGATION, CUSTOM_LEARNER = range(2)

ESTIMATORS: dict[Any, int] = {"feed_forward": FEED_FORWARD}
LEARNERS: dict[Any, int] = {"back_propagation": BACK_PROPAGATION}
"""The code of each built-in estimator and learner, by its name."""


def weight_count(features: int, hidden: int) -> int:
    """Return W, the number of weights of one network, biases included."""
    return hidden * (features + 1) + hidden + 1


@compiled
def feed_forward(features, weights, hidden):
    """Return the network's output for an object's features."""
    inputs = len(features)
    units = len(hidden)
    place = 0
    for h in range(units):
        activation = weights[place]
        for f in range(inputs):
            activation += weights[place + 1 + f] * features[f]
        hidden[h] = logistic(activation)
        place += inputs + 1
    activation = weights[place]
    for h in range(units):
        activation += weights[place + 1 + h] * hidden[h]
    return logistic(activation)


@compiled
def back_propagate(features, weights, hidden, target, rate, cycles, biases):
    """Train the network towards `target` by gradient descent on (target - output)^2 / 2.

    Plain back-propagation without momentum, `cycles` times at learning rate `rate`.
    """
    inputs = len(features)
    units = len(hidden)
    output_place = units * (inputs + 1)
    for _ in range(cycles):
        output = feed_forward(features, weights, hidden)
        output_delta = (target - output) * output * (1.0 - output)
        for h in range(units):
            to_output = output_place + 1 + h
            hidden_delta = output_delta * weights[to_output] * hidden[h] * (1.0 - hidden[h])
            weights[to_output] += rate * output_delta * hidden[h]
            place = h * (inputs + 1)
            if biases:
                weights[place] += rate * hidden_delta
            for f in range(inputs):
                weights[place + 1 + f] += rate * hidden_delta * features[f]
        if biases:
            weights[output_place] += rate * output_delta


@compiled
def estimate(estimator, features, weights, hidden, custom):
    """Estimate by the estimator of the given code; `custom` is the user's own function."""
    if estimator == FEED_FORWARD:
        return feed_forward(features, weights, hidden)
    return custom(features, weights, hidden)


@compiled
def learn(learner, features, weights, hidden, target, rate, cycles, biases, custom):
    """Learn by the learner of the given code; `custom` is the user's own function."""
    if learner == BACK_PROPAGATION:
        back_propagate(features, weights, hidden, target, rate, cycles, biases)
    else:
        custom(features, weights, hidden, target, rate, cycles, biases)

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from animat.mind.affordance import feed_forward, weight_count
from animat.mind.mind import Mind
from animat.mind.networks import Networks

EAT_AND_REST = ("eat", "rest")


def networks(seed=0, behaviours=EAT_AND_REST, features=("shape", "size"), hidden=3):
    shape = (len(behaviours), weight_count(len(features), hidden))
    return Networks(behaviours, features, hidden, np.random.default_rng(seed).normal(size=shape))


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 4), st.integers(1, 4), st.integers(1, 5))
def test_likelihoods_go_by_the_names_of_features_and_behaviours(seed, b, f, hidden):
    behaviours = tuple(f"act{n}" for n in range(b))
    features = tuple(f"feature{n}" for n in range(f))
    known = networks(seed, behaviours, features, hidden)
    inputs = np.random.default_rng(seed).random(f)
    shuffled = dict(reversed(list(zip(features, inputs.tolist(), strict=True))))
    assert known.likelihoods(shuffled) == {
        name: feed_forward(inputs, known.weights[n], np.zeros(hidden))
        for n, name in enumerate(behaviours)
    }


def test_features_it_does_not_know_and_features_left_out_are_refused():
    with pytest.raises(ValueError, match='"sise" is no feature; did you mean "size"'):
        networks().likelihoods({"shape": 1.0, "sise": 0.0})
    with pytest.raises(ValueError, match="features lack size"):
        networks().likelihoods({"shape": 1.0})


def test_the_weights_are_its_own_and_stay_as_they_are():
    weights = np.zeros((1, 9))
    known = Networks(("eat",), ("shape", "size"), 2, weights)
    weights[:] = 5.0
    assert not known.weights.any()
    with pytest.raises(ValueError, match="read-only"):
        known.weights[0, 0] = 1.0


def test_networks_are_equal_if_names_and_weights_are():
    assert networks(1) == networks(1)
    assert hash(networks(1)) == hash(networks(1))
    assert networks(1) != networks(2)
    assert networks(1) != networks(1, behaviours=("eat", "shelter"))
    assert networks(1) != "networks"
    minds = [
        Mind(networks=networks(seed, ("eat", "shelter", "interact"), hidden=2))
        for seed in (1, 1, 2)
    ]
    assert minds[0] == minds[1] != minds[2]


@pytest.mark.parametrize(
    ("hidden", "weights"),
    [
        (3, np.zeros((2, 9))),
        (2, np.zeros((1, 9))),
        (2, np.zeros(18)),
    ],
)
def test_weights_that_do_not_fit_are_refused(hidden, weights):
    with pytest.raises(ValueError, match="do not fit 2 networks of 2 features"):
        Networks(EAT_AND_REST, ("shape", "size"), hidden, weights)


@pytest.mark.parametrize("weight", [np.nan, np.inf])
def test_weights_that_are_no_numbers_are_refused(weight):
    weights = np.zeros((2, 9))
    weights[1, 3] = weight
    with pytest.raises(ValueError, match="finite"):
        Networks(EAT_AND_REST, ("shape", "size"), 2, weights)

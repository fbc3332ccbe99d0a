"""What networks say of object types, held against the networks themselves and Table 1."""

import numpy as np
import pytest

from animat.life.likelihoods import afforded, likelihoods
from animat.life.scenario import bring_together
from animat.mind.mind import Behaviour, Mind
from animat.mind.networks import Networks
from animat.world.objects import TABLE_1
from animat.world.world import World

LEARNER = Mind(agent="LEARNING")


def test_each_life_is_asked_for_itself():
    setting = bring_together(LEARNER, World.abundant())
    states, _ = setting.begin(5, np.arange(3, dtype=np.uint64))
    said = likelihoods(setting, states)
    assert said.shape == (3, 3, 4)
    for life, state in enumerate(states):
        networks = Networks(tuple(LEARNER.behaviours), ("shape", "size"), 2, state["weights"])
        for kind, of_kind in zip(TABLE_1, said[life].T, strict=True):
            wanted = list(networks.likelihoods(kind.features).values())
            assert of_kind == pytest.approx(wanted, rel=1e-12)
    assert len(np.unique(said)) == said.size


def test_asking_changes_nothing():
    setting = bring_together(LEARNER, World.abundant())
    states, _ = setting.begin(5, np.arange(2, dtype=np.uint64))
    before = states.copy()
    first = likelihoods(setting, states)
    rest = [name for name in before.dtype.names or () if name != "hidden"]
    assert all(states[name].tobytes() == before[name].tobytes() for name in rest)
    assert np.array_equal(likelihoods(setting, states), first)


def test_the_truth_is_what_the_types_afford_by_what_a_behaviour_needs():
    mind = Mind(
        behaviours={
            "hide": Behaviour(serves="fatigue", needs="shelter"),
            "feed": Behaviour(serves="hunger", needs="grasp"),
            **dict.fromkeys(("eat", "shelter", "interact"), False),
        }
    )
    types = tuple(
        kind.model_copy(update={"affords": {"grasp": 0.1 * n, "shelter": 0.3, "interact": 1.0}})
        for n, kind in enumerate(TABLE_1)
    )
    world = World.random({"TS": 1}, types=types)
    truth = afforded(bring_together(mind, world))
    assert truth == pytest.approx(np.array([[0.3] * 4, [0.0, 0.1, 0.2, 0.3]]))

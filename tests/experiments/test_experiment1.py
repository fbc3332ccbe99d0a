"""Experiment 1, held against single lives of the same robots."""

import numpy as np
import pyarrow as pa
import pytest

from animat.experiments import experiment1
from animat.life.batch import CURVE_EVERY, EPISODES
from animat.life.life import live
from animat.mind.mind import Mind
from animat.world.objects import TABLE_1
from animat.world.world import World

STEPS, SEED, LAST = 3_000, 1, 500
NEEDS = {"eat": "grasp", "shelter": "shelter", "interact": "interact"}


def lived(robot, steps=STEPS, record=None):
    learner = Mind(agent="LEARNING")
    return live(learner, World.abundant(), seed=SEED, life=robot, steps=steps, record=record)


def said(table):
    """The likelihoods of a table by all that names them."""
    names = [name for name in table.column_names if name not in {"likelihood", "afforded"}]
    return {tuple(row[name] for name in names): row["likelihood"] for row in table.to_pylist()}


def test_the_end_is_what_the_networks_say_of_every_object_type(reproduced):
    final = said(reproduced.learnt.final)
    assert len(final) == 4 * 3 * 4
    for robot in range(4):
        for kind in TABLE_1:
            for network, likelihood in lived(robot).networks.likelihoods(kind.features).items():
                assert final[robot, network, kind.name] == pytest.approx(likelihood, rel=1e-12)


def test_the_truth_is_table_1(reproduced):
    kinds = {kind.name: kind for kind in TABLE_1}
    for row in reproduced.learnt.final.to_pylist():
        assert row["afforded"] == kinds[row["object"]].affords[NEEDS[row["network"]]]


def test_the_curve_is_what_a_network_says_after_each_of_its_episodes(reproduced):
    curve = said(reproduced.learnt.curve)
    assert len(curve) == 4 * (EPISODES + 1) * 3 * 4
    moved = 0
    for robot in range(4):
        for until in [1, *range(CURVE_EVERY, STEPS + 1, CURVE_EVERY)]:
            life = lived(robot, until)
            for kind in TABLE_1:
                for network, likelihood in life.networks.likelihoods(kind.features).items():
                    episode = life.summary[f"acts_{network}"]
                    assert curve[robot, episode, network, kind.name] == pytest.approx(
                        likelihood, rel=1e-12
                    )
                    moved += episode
    assert moved


def test_the_curve_ends_where_the_robot_does(reproduced):
    final = said(reproduced.learnt.final)
    curve = said(reproduced.learnt.curve)
    for (robot, network, kind), likelihood in final.items():
        assert curve[robot, EPISODES, network, kind] == likelihood


def test_the_robot_shown_did_the_most_in_its_last_steps(reproduced):
    busy = []
    for robot in range(4):
        before, after = lived(robot, STEPS - LAST).summary, lived(robot).summary
        acts = [after[f"acts_{name}"] - before[f"acts_{name}"] for name in NEEDS]
        busy.append((sum(each > 0 for each in acts), sum(acts)))
    shown = reproduced.learnt.shown
    assert busy[shown] == max(busy)
    trace = lived(shown, record=f"last:{LAST}").trace
    assert trace is not None
    assert reproduced.learnt.trace.to_pylist() == trace.to_pylist()


def test_more_behaviours_count_more_than_more_acts_and_then_the_first_robot_does():
    """Rows of (life, behaviour, reward)."""
    rows = [(4, "eat", 1)] * 5 + [(6, "eat", 1), (6, "shelter", -1), (6, "eat", 0)]
    rows += [(7, "shelter", 1), (7, "eat", 1), (8, "interact", 0)]
    life, behaviour, reward = (np.array(column) for column in zip(*rows, strict=True))
    traces = pa.table({"life": life, "behaviour": behaviour, "reward": reward})
    assert experiment1._busiest(traces, ["eat", "shelter", "interact"]) == 6

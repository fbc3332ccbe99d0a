"""Experiment 1, held against single lives of the same robots."""

from threading import Event, active_count

import numpy as np
import pytest

from animat.life.life import live
from animat.mind.mind import Mind
from animat.robot.khepera import Khepera
from animat.study import experiment1
from animat.study.experiment1 import CHUNK, CURVE_EPISODES, LAST, LOOK_EVERY, learn
from animat.world.objects import TABLE_1
from animat.world.world import World

STEPS, SEED = 3_000, 1
NEEDS = {"eat": "grasp", "shelter": "shelter", "interact": "interact"}


def lived(robot, steps=STEPS, record=None):
    learner = Mind(agent="LEARNING")
    return live(learner, World.abundant(), seed=SEED, life=robot, steps=steps, record=record)


def said(table):
    """The likelihoods of a table by all that names them."""
    names = [name for name in table.column_names if name not in {"likelihood", "afforded"}]
    return {tuple(row[name] for name in names): row["likelihood"] for row in table.to_pylist()}


def test_the_networks_are_those_of_robots_that_lived_alone(reproduced):
    for robot, networks in enumerate(reproduced.learnt.networks):
        assert networks == lived(robot).networks


def test_the_end_is_what_the_networks_say_of_every_object_type(reproduced):
    final = said(reproduced.learnt.final)
    assert len(final) == 4 * 3 * 4
    for robot, networks in enumerate(reproduced.learnt.networks):
        for kind in TABLE_1:
            for network, likelihood in networks.likelihoods(kind.features).items():
                assert final[robot, network, kind.name] == pytest.approx(likelihood, rel=1e-12)


def test_the_truth_is_table_1(reproduced):
    kinds = {kind.name: kind for kind in TABLE_1}
    for row in reproduced.learnt.final.to_pylist():
        assert row["afforded"] == kinds[row["object"]].affords[NEEDS[row["network"]]]


def test_the_curve_is_what_a_network_says_after_each_of_its_episodes(reproduced):
    curve = said(reproduced.learnt.curve)
    assert len(curve) == 4 * (CURVE_EPISODES + 1) * 3 * 4
    looks = [1, *range(LOOK_EVERY, STEPS - LAST + 1, LOOK_EVERY), STEPS]
    moved = 0
    for robot in range(4):
        for until in looks:
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
        assert curve[robot, CURVE_EPISODES, network, kind] == likelihood


def test_the_robot_shown_did_the_most_in_its_last_steps(reproduced):
    busy = []
    for robot in range(4):
        before, after = lived(robot, STEPS - LAST).summary, lived(robot).summary
        acts = [after[f"acts_{name}"] - before[f"acts_{name}"] for name in NEEDS]
        busy.append((sum(each > 0 for each in acts), sum(acts)))
    shown = reproduced.learnt.shown
    assert busy[shown] == max(busy)
    assert reproduced.learnt.trace == lived(shown, record=f"last:{LAST}").trace


def test_robots_in_several_chunks_are_the_same_robots():
    few = learn(Mind(), World.abundant(), Khepera(), robots=2, steps=700, seed=SEED)
    many = learn(Mind(), World.abundant(), Khepera(), robots=CHUNK + 2, steps=700, seed=SEED)
    assert many.networks[:2] == few.networks
    assert many.networks[-1] == lived(CHUNK + 1, 700).networks
    assert len(many.networks) == CHUNK + 2


@pytest.mark.parametrize("steps", [1, LAST, LAST + 1, LAST + LOOK_EVERY, 1_234])
def test_any_length_is_lived_and_told_to_its_end(steps):
    told = []
    learnt = learn(
        Mind(), World.abundant(), Khepera(), robots=2, steps=steps, seed=SEED, progress=told.append
    )
    assert sum(told) == 2 * steps
    assert learnt.trace["step"].to_pylist() == list(range(max(0, steps - LAST), steps))


def test_only_the_agent_of_the_mind_is_changed():
    """A knowing mind unlearns, and lives on past what would kill it."""
    known = lived(0).networks
    mind = Mind(agent="AF", networks=known, success_effect=0.1)
    learnt = learn(mind, World.abundant(), Khepera(), robots=1, steps=STEPS, seed=SEED)
    same = Mind(agent="LEARNING", success_effect=0.1)
    alone = live(same, World.abundant(), seed=SEED, steps=STEPS)
    assert alone.lifespan == STEPS
    assert learnt.networks == [alone.networks]


def test_an_interruption_ends_all_threads(monkeypatch):
    """The first chunk is interrupted; the second, of a single robot, does not live on for long."""
    monkeypatch.setattr(experiment1.os, "cpu_count", lambda: 2)
    before = active_count()
    second_lives = Event()
    lived_on = []

    def interrupted(steps):
        if steps == CHUNK * LOOK_EVERY:
            assert second_lives.wait(60)
            raise KeyboardInterrupt
        second_lives.set()
        lived_on.append(steps)

    robots, steps = CHUNK + 1, 4_000_000
    with pytest.raises(KeyboardInterrupt):
        learn(
            Mind(),
            World.abundant(),
            Khepera(),
            robots=robots,
            steps=steps,
            seed=0,
            progress=interrupted,
        )
    assert active_count() == before
    assert 0 < sum(lived_on) < steps / 2


def test_the_threshold_of_episodes_is_no_more_than_a_curve_shows(monkeypatch):
    """A robot with more episodes than the curve has room for is no mistake."""
    monkeypatch.setattr(experiment1, "CURVE_EPISODES", 1)
    learnt = learn(Mind(), World.abundant(), Khepera(), robots=1, steps=STEPS, seed=SEED)
    assert max(learnt.curve["episode"].to_pylist()) == 1
    acts = lived(0).summary
    assert max(acts[f"acts_{name}"] for name in NEEDS) > 1
    assert np.isfinite(learnt.curve["likelihood"].to_numpy()).all()

"""The reproduction: its size is the size asked for, and nothing asked for is left out."""

from collections import Counter

import pytest

from animat.life.setting import LifeError
from animat.mind.mind import Behaviour, Drive, Mind
from animat.report.survival import summarise
from animat.robot.khepera import Khepera
from animat.study.experiment1 import learn
from animat.study.experiment2 import compare
from animat.study.reproduction import PAPERS_LIVES, QUICK, Size, check, reproduce
from animat.study.settings import LifeSettings, WorldChoice
from animat.world.world import World

CELLS = [("abundant", "BLIND"), ("abundant", "AF"), ("scarce", "BLIND"), ("scarce", "AF")]


def silent(task, done, total):
    pass


def test_it_has_the_size_asked_for(reproduced):
    lives = reproduced.lives
    cells = Counter(zip(lives["world"].to_pylist(), lives["agent"].to_pylist(), strict=True))
    assert cells == dict.fromkeys(CELLS, 24)
    assert set(lives["seed"].to_pylist()) == {1}
    assert len(reproduced.learnt.networks) == 4
    assert reproduced.learnt.trace["step"].to_pylist()[-1] == 2_999
    assert max(lives["lifespan"].to_pylist()) <= 3_000


def test_it_is_in_the_published_worlds(reproduced):
    assert reproduced.worlds == (World.abundant(), World.scarce())


def test_every_claim_is_judged(reproduced):
    assert [claim.id for claim in reproduced.claims] == [f"C{n}" for n in range(1, 8)]


def test_all_lives_and_the_papers_20_are_summarised(reproduced):
    assert reproduced.summaries == summarise(reproduced.lives)
    assert [summary.cell for summary in reproduced.summaries] == CELLS
    assert [summary.lives for summary in reproduced.papers] == [PAPERS_LIVES] * 4
    lives = reproduced.lives.to_pylist()
    for summary in reproduced.papers:
        first = [
            life["lifespan"]
            for life in lives
            if (life["world"], life["agent"]) == summary.cell and life["life"] < PAPERS_LIVES
        ]
        assert summary.mean.value == pytest.approx(sum(first) / PAPERS_LIVES)


def test_blind_and_af_are_compared_in_each_world(reproduced):
    assert list(reproduced.tests) == ["abundant", "scarce"]
    assert all(0.0 <= test.p <= 1.0 for test in reproduced.tests.values())


def test_every_task_is_told_to_its_end(published):
    done: Counter[str] = Counter()
    totals = {}
    for task, count, total in published.told:
        done[task] += count
        assert totals.setdefault(task, total) == total
    assert done == totals
    assert totals == {
        "Experiment 1, steps": 4 * 3_000,
        "Experiment 2, lives": 4 * 24,
        "Statistics": 3,
        "Pages": 8,
    }


def test_it_is_the_two_experiments_and_nothing_else(reproduced):
    mind, robot = Mind(), Khepera()
    learnt = learn(mind, World.abundant(), robot, robots=4, steps=3_000, seed=1)
    assert learnt.final == reproduced.learnt.final
    lives = compare(mind, reproduced.worlds, robot, learnt.networks, lives=24, steps=3_000, seed=1)
    assert lives == reproduced.lives


def test_settings_are_those_of_every_life():
    mind = Mind(consumed=True, death=False)
    robot = Khepera(motor_noise=False, infrared_noise=False, position_noise=0.0, turn_noise=0.0)
    settings = LifeSettings(mind=mind, robot=robot)
    result = reproduce(settings, seed=3, size=Size(robots=1, lives=2, steps=600), tell=silent)
    assert all(world.n_sites > world.n_objects for world in result.worlds)
    assert set(result.lives["lifespan"].to_pylist()) == {600}
    assert set(result.lives["seed"].to_pylist()) == {3}
    learnt = learn(mind, result.worlds[0], robot, robots=1, steps=600, seed=3)
    assert result.learnt.trace == learnt.trace
    lives = compare(mind, result.worlds, robot, learnt.networks, lives=2, steps=600, seed=3)
    assert result.lives == lives


ONE_DRIVE = Mind(
    drives={"hunger": Drive(a={"nutrition": 1.0})},
    behaviours={"eat": Behaviour(serves="hunger", needs="grasp")},
)


@pytest.mark.parametrize(
    ("changes", "size", "lines"),
    [
        ({"world": WorldChoice(layout="scarce")}, QUICK, ["Worlds 1 and 2"]),
        ({"world": WorldChoice(resolution=1.0)}, QUICK, ["Worlds 1 and 2"]),
        ({"mind": Mind(agent="ORACLE")}, QUICK, ['mind.agent = "ORACLE"']),
        ({"mind": ONE_DRIVE}, QUICK, ["drives has no fatigue", "behaviours has no shelter"]),
        ({}, Size(robots=0), ["seeds = 0"]),
        ({}, Size(robots=-1, lives=1), ["seeds = -1", "lives = 1"]),
        ({}, Size(lives=-5), ["lives = -5"]),
        ({}, Size(steps=0), ["steps = 0"]),
        ({}, Size(steps=-1), ["steps = -1"]),
        ({}, Size(steps=1 << 60), ["steps = "]),
    ],
)
def test_what_would_be_left_out_or_is_too_little_is_refused_at_once(changes, size, lines):
    with pytest.raises(LifeError) as refused:
        reproduce(LifeSettings(**changes), seed=0, size=size, tell=silent)
    assert len(refused.value.problems) == len(lines)
    for problem, line in zip(refused.value.problems, lines, strict=True):
        assert line in problem


def test_an_impossible_seed_is_refused():
    with pytest.raises(LifeError, match="seed = -1"):
        check(LifeSettings(), -1, QUICK)


def test_what_a_reproduction_needs_is_enough():
    check(LifeSettings(), 2**64 - 1, Size(robots=1, lives=2, steps=1))

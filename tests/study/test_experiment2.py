"""Experiment 2, held against single lives and against many lives of one mind."""

import pytest

from animat.life.life import live
from animat.life.lives import chunk_size, live_many
from animat.life.setting import LifeError
from animat.mind.mind import Mind
from animat.robot.khepera import Khepera
from animat.study.experiment2 import compare
from animat.world.world import World

CELLS = [("abundant", "BLIND"), ("abundant", "AF"), ("scarce", "BLIND"), ("scarce", "AF")]


def of_cell(table, world, agent):
    rows = table.to_pylist()
    return [row for row in rows if (row["world"], row["agent"]) == (world, agent)]


def test_the_cells_stand_in_the_papers_order(reproduced):
    rows = reproduced.lives.to_pylist()
    assert list(dict.fromkeys((row["world"], row["agent"]) for row in rows)) == CELLS


def test_lives_of_a_cell_are_paired_with_those_of_the_others(reproduced):
    for cell in CELLS:
        luck = [(row["seed"], row["life"]) for row in of_cell(reproduced.lives, *cell)]
        assert luck == [(1, n) for n in range(24)]


def test_blind_lives_are_lives_of_the_mind_itself(reproduced):
    for name, world in zip(("abundant", "scarce"), reproduced.worlds, strict=True):
        alone = live_many(Mind(), world, lives=24, seed=1, steps=3_000)
        assert of_cell(reproduced.lives, name, "BLIND") == alone.table.to_pylist()


def test_each_knowing_robot_has_the_networks_of_one_that_learnt(reproduced):
    rows = of_cell(reproduced.lives, "abundant", "AF")
    for n in (0, 1, 3, 4, 23):
        knowing = Mind(agent="AF", networks=reproduced.learnt.networks[n % 4])
        alone = live(knowing, reproduced.worlds[0], seed=1, life=n, steps=3_000)
        assert rows[n] == alone.summary


def test_more_lives_than_a_chunk_are_told_and_counted(reproduced):
    told = []
    lives = chunk_size(50) + 3
    table = compare(
        Mind(death=False),
        reproduced.worlds,
        Khepera(),
        reproduced.learnt.networks,
        lives=lives,
        steps=50,
        seed=2,
        progress=told.append,
    )
    assert table.num_rows == sum(told) == 4 * lives
    assert len(told) > 4
    assert set(table["lifespan"].to_pylist()) == {50}
    assert set(table["seed"].to_pylist()) == {2}


def test_what_cannot_be_lived_is_refused(reproduced):
    networks = reproduced.learnt.networks
    with pytest.raises(LifeError, match="spare"):
        compare(
            Mind(consumed=True),
            [World.abundant()],
            Khepera(),
            networks,
            lives=2,
            steps=10,
            seed=0,
        )
    with pytest.raises(LifeError, match="lives = 0"):
        compare(Mind(), [World.abundant()], Khepera(), networks, lives=0, steps=10, seed=0)

"""The reproduction: its size is the size asked for, and nothing asked for is left out."""

from collections import Counter

import pyarrow as pa
import pytest

from animat.experiments import reproduction
from animat.experiments.reproduction import (
    EXPERIMENTS,
    PAPERS_LIVES,
    QUICK,
    Size,
    check,
    reproduce,
    studies,
)
from animat.files.atomic import RunError
from animat.files.settings import SettingsError
from animat.life.life import live
from animat.life.lives import live_many
from animat.life.scenario import LifeError
from animat.mind.mind import Mind
from animat.robot.khepera import Khepera
from animat.statistics.survival import summarise
from animat.study.execute.run import run
from animat.study.file.cases import cases
from animat.study.file.settings import LifeSettings, WorldChoice
from animat.study.store.results import Results
from animat.world.world import World

CELLS = [("abundant", "BLIND"), ("abundant", "AF"), ("scarce", "BLIND"), ("scarce", "AF")]


def silent(task, done, total, note=""):
    pass


def test_it_has_the_size_asked_for(reproduced):
    lives = reproduced.lives
    cells = Counter(zip(lives["world"].to_pylist(), lives["agent"].to_pylist(), strict=True))
    assert cells == dict.fromkeys(CELLS, 24)
    assert set(lives["seed"].to_pylist()) == {1}
    assert set(reproduced.learnt.final["seed"].to_pylist()) == {0, 1, 2, 3}
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
        "Experiment 1, lives": 4,
        "Experiment 2, robots that learn": 4,
        "Experiment 2, lives": 4 * 24,
        "Statistics": 3,
        "Pages": 8,
    }


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
        rows = alone.table.drop_columns("error").to_pylist()
        assert of_cell(reproduced.lives, name, "BLIND") == rows


def test_each_knowing_robot_has_the_networks_of_one_that_learnt(reproduced):
    rows = of_cell(reproduced.lives, "abundant", "AF")
    for n in (0, 1, 3, 4, 23):
        learner = live(Mind(agent="LEARNING"), World.abundant(), seed=1, life=n % 4, steps=3_000)
        knowing = Mind(agent="AF", networks=learner.networks)
        alone = live(knowing, reproduced.worlds[0], seed=1, life=n, steps=3_000)
        assert rows[n] | {"error": None} == alone.summary


def test_the_robots_of_experiment_1_teach_and_are_not_lived_again(published, tmp_path, faults):
    """They are lent; whoever lives them anew writes the same file."""
    second = Results(published.directory / "experiment2")
    faults.go_on(faults.planned(second.study), tmp_path / "alone")
    for name in ("teachers/part-000000", "lives/part-000003"):
        files = [folder / f"{name}.parquet" for folder in (second.directory, tmp_path / "alone")]
        assert files[0].read_bytes() == files[1].read_bytes()
    log = (second.directory / "log.jsonl").read_text()
    lent = [line for line in log.splitlines() if '"kind": "teachers"' in line]
    assert len(lent) == 1
    robots = Results(published.directory / "experiment1").lives()["life"].to_pylist()
    assert robots == second.teachers()["robot"].to_pylist()


def test_settings_are_those_of_every_life(tmp_path):
    mind = Mind(consumed=True, death=False)
    robot = Khepera(motor_noise=False, infrared_noise=False, position_noise=0.0, turn_noise=0.0)
    settings = LifeSettings(mind=mind, robot=robot)
    size = Size(robots=1, lives=2, steps=600)
    result = reproduce(settings, seed=3, size=size, directory=tmp_path, tell=silent)
    assert all(world.n_sites > world.n_objects for world in result.worlds)
    assert set(result.lives["lifespan"].to_pylist()) == {600}
    assert set(result.lives["seed"].to_pylist()) == {3}
    learner = live(
        Mind(agent="LEARNING", consumed=True, death=False),
        result.worlds[0],
        robot=robot,
        seed=3,
        steps=600,
        record="last:500",
    )
    assert learner.trace is not None
    assert result.learnt.trace.to_pylist() == learner.trace.to_pylist()
    for number, world in enumerate(result.worlds):
        knowing = Mind(agent="AF", consumed=True, death=False, networks=learner.networks)
        alone = live_many(knowing, world, robot=robot, lives=2, seed=3, steps=600)
        cell = of_cell(result.lives, CELLS[2 * number][0], "AF")
        assert alone.table["error"].null_count == alone.table.num_rows
        assert cell == alone.table.drop_columns("error").to_pylist()


def test_a_reproduction_that_was_broken_off_is_gone_on_with(published, tmp_path, monkeypatch):
    calls = []

    def interrupted(plan, directory, *rest):
        calls.append(directory.name)
        outcome = run(plan, directory, *rest)
        return outcome if len(calls) > 1 else outcome._replace(tally=Incomplete())

    class Incomplete:
        complete = False

    monkeypatch.setattr(reproduction, "run", interrupted)
    size = Size(robots=4, lives=24, steps=3_000)
    again = {"seed": 1, "size": size, "directory": tmp_path, "tell": silent}
    with pytest.raises(KeyboardInterrupt):
        reproduce(LifeSettings(), **again)
    result = reproduce(LifeSettings(), **again)
    assert calls == ["experiment1", *EXPERIMENTS]
    assert result.lives.equals(published.result.lives)
    assert result.learnt.final.equals(published.result.learnt.final)
    log = (tmp_path / "experiment1" / "log.jsonl").read_text()
    assert log.count('"event": "part"') == 1


def test_what_was_broken_off_with_other_settings_is_kept_unless_it_is_begun_anew(tmp_path):
    size = Size(robots=1, lives=2, steps=60)
    reproduce(LifeSettings(), seed=1, size=size, directory=tmp_path, tell=silent)
    other = {"seed": 2, "size": size, "directory": tmp_path, "tell": silent}
    with pytest.raises(SettingsError, match="seed = 1 there and 2 here") as refused:
        reproduce(LifeSettings(), **other)
    assert "--force begins anew" in refused.value.problems[-1]
    result = reproduce(LifeSettings(), **other, anew=True)
    assert set(result.lives["seed"].to_pylist()) == {2}


def test_lives_that_fail_are_left_out_and_counted(tmp_path, lost, monkeypatch):
    own = tmp_path / "own.py"
    own.write_text(lost)
    settings = LifeSettings(mind=Mind(wander=f"{own}:walk"))
    size = Size(robots=3, lives=20, steps=200)
    result = reproduce(settings, seed=1, size=size, directory=tmp_path / "out", tell=silent)
    robots = set(result.learnt.final["seed"].to_pylist())
    assert result.failed > 0
    assert result.failed == 3 - len(robots) + 80 - result.lives.num_rows
    assert result.lives["lifespan"].null_count == 0

    def all_failed(self, columns=None, where=None):
        return pa.table({"case": [0, 1], "error": [None, "lost"]}, pa.schema(COLUMNS))

    monkeypatch.setattr(reproduction.Results, "lives", all_failed)
    with pytest.raises(RunError, match="all lives of a case failed, such as case"):
        reproduce(settings, seed=1, size=size, directory=tmp_path / "out", tell=silent)


COLUMNS = [("case", pa.int64()), ("error", pa.string())]


def test_both_experiments_are_the_studies_that_come_with_animat():
    first, second = studies(LifeSettings(), 5, Size(robots=3, lives=7, steps=900))
    assert (first.name, second.name) == EXPERIMENTS
    assert (first.seed, first.lives, first.steps) == (5, 3, 900)
    assert (second.seed, second.lives, second.steps) == (5, 7, 900)
    assert second.teacher is not None
    assert (second.teacher.robots, second.teacher.steps) == (3, 900)
    assert first.mind.agent == "LEARNING"
    assert {factor for case in cases(second) for factor in case.factors} == {
        "world.layout",
        "mind.agent",
    }


ONE_DRIVE = Mind(
    drives={"fatigue": None, "curiosity": None},
    behaviours={"shelter": None, "interact": None},
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
def test_what_would_be_left_out_or_is_too_little_is_refused_at_once(changes, size, lines, tmp_path):
    with pytest.raises(LifeError) as refused:
        reproduce(LifeSettings(**changes), seed=0, size=size, directory=tmp_path, tell=silent)
    assert len(refused.value.problems) == len(lines)
    for problem, line in zip(refused.value.problems, lines, strict=True):
        assert line in problem


def test_an_impossible_seed_is_refused():
    with pytest.raises(LifeError, match="seed = -1"):
        check(LifeSettings(), -1, QUICK)


def test_what_a_reproduction_needs_is_enough():
    check(LifeSettings(), 2**64 - 1, Size(robots=1, lives=2, steps=1))

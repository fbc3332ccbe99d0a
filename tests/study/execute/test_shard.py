"""Parts, held against single lives: what is in their files, and of what they are a function."""

from __future__ import annotations

import io

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from animat.life.life import live
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.study.execute.shard import live_part
from animat.study.plan.numbering import Part
from animat.study.plan.plan import plan_of
from animat.study.plan.shard import (
    classes_needed,
    file_names,
    part_identity,
    problem_of,
    shard_header,
)
from animat.study.plan.training import networks_of
from animat.world.objects import TABLE_1
from animat.world.world import World

ROBOTS, STEPS = 3, 600


def read(made, name):
    return pq.read_table(io.BytesIO(made.files[name]))


def learner(robot, steps=STEPS, record=None):
    mind = Mind(agent="LEARNING")
    return live(mind, World.abundant(), life=robot, steps=steps, record=record)


@pytest.fixture(scope="module")
def taught(small):
    made = live_part(small.text, Part("teachers", 0), {})
    return made, networks_of(small, 0, read(made, "teachers/part-000000.parquet"))


def test_robots_that_teach_are_robots_that_learnt_alone(small, taught):
    made, networks = taught
    table = read(made, "teachers/part-000000.parquet")
    assert (made.lives, made.steps, made.failed) == (ROBOTS, ROBOTS * STEPS, 0)
    assert networks.shape == (ROBOTS, 3, 9)
    for row in table.to_pylist():
        life = learner(row["robot"])
        assert row["identity"] == small.classes[0].identity
        assert row["weights"] == life.networks.weights.ravel().tolist()
        assert (networks[row["robot"]] == life.networks.weights).all()
        for kind in life.world.types:
            for name, said in life.networks.likelihoods(kind.features).items():
                assert row[f"likelihood_{name}_{kind.name}"] == pytest.approx(said, rel=1e-12)


def test_lives_are_those_lived_alone(small, taught):
    _, networks = taught
    found = {}
    for number in range(2):
        table = read(
            live_part(small.text, Part("lives", number), {0: networks}),
            f"lives/part-{number:06d}.parquet",
        )
        for row in table.to_pylist():
            found[row["case"], row["life"]] = row
    assert len(found) == 16
    for (case, life), row in found.items():
        mind = Mind(agent="LEARNING")
        if case == 1:
            known = learner(life % ROBOTS).networks
            mind = Mind(agent="AF", networks=known)
        alone = live(mind, World.abundant(), life=life, steps=150)
        assert {name: row[name] for name in alone.summary} == alone.summary
        assert row["error"] is None
        assert row["weights"] == (alone.networks.weights.ravel().tolist() if case == 0 else None)
        for kind in alone.world.types:
            for name, said in alone.networks.likelihoods(kind.features).items():
                assert row[f"likelihood_{name}_{kind.name}"] == pytest.approx(said, rel=1e-12)


def test_traces_and_curves_are_those_of_the_lives(small):
    made = live_part(small.text, Part("lives", 0), {})
    trace = read(made, "traces/part-000000.parquet")
    alone = learner(0, steps=150, record="last:20").trace
    assert alone is not None
    assert trace.drop_columns(["case", "life"]).to_pylist() == alone.to_pylist()
    assert set(trace["life"].to_pylist()) == set(trace["case"].to_pylist()) == {0}
    curve = read(made, "curves/lives-000000.parquet")
    last = curve.filter((pc.field("episode") == 100) & (pc.field("life") == 5))
    final = {(r["network"], r["object"]): r["likelihood"] for r in last.to_pylist()}
    life = learner(5, steps=150)
    for kind in life.world.types:
        for name, said in life.networks.likelihoods(kind.features).items():
            assert final[name, kind.name] == pytest.approx(said, rel=1e-12)


def test_a_part_is_the_same_bytes_again_and_in_a_plan_of_its_own(small, taught):
    _, networks = taught
    for part in small.all_parts():
        one = live_part(small.text, part, {0: networks})
        other = live_part(plan_of(small.text + "\n").text + "\n", part, {0: networks.copy()})
        assert one == other
        assert list(one.files) == file_names(small, part)
        assert list(one.files)[-1] == part.file


def test_every_file_is_written_with_the_identity_of_its_lives(small, taught, tmp_path):
    _, networks = taught
    identities = set()
    for part in small.all_parts():
        made = live_part(small.text, part, {0: networks})
        identities.add(part_identity(small, part))
        for number, content in enumerate(made.files.values()):
            path = tmp_path / f"{number}.parquet"
            path.write_bytes(content)
            said = shard_header(path)
            assert said.identity == part_identity(small, part)
            assert problem_of(path, said.identity, said.rows) is None
        assert (said.rows, said.steps, said.failed) == (made.lives, made.steps, made.failed)
    assert len(identities) == 3


def test_who_teaches_in_a_part_is_known(small):
    assert classes_needed(small, Part("lives", 0)) == []
    assert classes_needed(small, Part("lives", 1)) == [0]
    assert classes_needed(small, Part("teachers", 0)) == []


def test_lives_of_a_robot_that_failed_fail_and_no_others(small, taught):
    _, networks = taught
    broken = networks.copy()
    broken[1] = np.nan
    made = live_part(small.text, Part("lives", 1), {0: broken})
    whole = live_part(small.text, Part("lives", 1), {0: networks})
    table, other = (read(one, "lives/part-000001.parquet").to_pylist() for one in (made, whole))
    assert made.failed == 3
    for row, plain in zip(table, other, strict=True):
        if row["life"] % ROBOTS == 1:
            assert row["error"] == "robot 1, whose networks it has, failed"
            assert row["lifespan"] is None
            assert (row["case"], row["agent"], row["seed"]) == (1, "AF", 0)
        else:
            assert row == plain


def test_a_life_that_failed_has_its_name_and_its_error_and_no_trace(faults, tmp_path, lost):
    own = tmp_path / "own.py"
    own.write_text(lost)
    plan = faults.plan(
        f'name = "failing"\nlives = 8\nsteps = 300\n[mind]\nwander = "{own}:walk"\n'
        '[record]\nwhat = "all"\nlives = 8\n'
    )
    made = live_part(plan.text, Part("lives", 0), {})
    table = read(made, "lives/part-000000.parquet").to_pylist()
    traced = set(read(made, "traces/part-000000.parquet")["life"].to_pylist())
    failed = {row["life"] for row in table if row["error"]}
    assert made.failed == len(failed) > 0
    assert traced == set(range(8)) - failed != set()
    for row in table:
        named = {"case", "world", "agent", "seed", "life", "error"}
        there = {name for name, value in row.items() if value is not None}
        if row["life"] in failed:
            assert there == named
            assert row["error"].startswith("wander: walk raised ValueError: lost, in step ")
        else:
            assert {"lifespan", "mean_drive", "acts"} <= there


def test_where_all_robots_failed_there_is_no_curve(faults, tmp_path, lost):
    own = tmp_path / "own.py"
    own.write_text(lost)
    plan = faults.plan(
        f'name = "failing"\nsteps = 9\nmeasures = ["learning_curve"]\n[mind]\nagent = "AF"\n'
        f'wander = "{own}:walk"\nturn_speed = 1\n[teacher]\nrobots = 2\nsteps = 9\n'
    )
    made = live_part(plan.text, Part("teachers", 0), {})
    assert made.failed == 2
    assert read(made, "curves/teachers-000000.parquet").num_rows == 0


def test_minds_and_worlds_of_several_kinds_have_the_same_columns(faults, tmp_path):
    """What a life has not, it has as null."""
    kinds = tuple(kind.model_copy(update={"name": f"{kind.name}2"}) for kind in TABLE_1)
    World.random({"TS2": 1}, types=kinds, name="other").save(tmp_path / "other.toml")
    plan = faults.plan(
        'name = "kinds"\nlives = 4\nsteps = 20\nmeasures = ["likelihoods"]\n'
        '[mind]\nagent = "LEARNING"\n[mind.behaviours]\n'
        'feed = { serves = "hunger", needs = "grasp" }\n'
        "eat = false\n"
        f'[design.grid]\n"world.layout" = ["abundant", "{tmp_path}/other.toml"]\n'
    )
    made = live_part(plan.text, Part("lives", 0), {})
    table = read(made, "lives/part-000000.parquet")
    assert table["case"].to_pylist() == [0] * 4 + [1] * 4
    assert table["likelihood_feed_TS"].is_valid().to_pylist() == [True] * 4 + [False] * 4
    assert table["likelihood_feed_TS2"].is_valid().to_pylist() == [False] * 4 + [True] * 4
    assert table["acts_feed"].null_count == 0


def test_networks_are_of_the_class_asked_for(small, taught):
    made, networks = taught
    table = read(made, "teachers/part-000000.parquet")
    shuffled = table.take([2, 0, 1])
    stranger = pa.array(["x"] * 3)
    other = table.set_column(0, "identity", stranger)
    assert (networks_of(small, 0, pa.concat_tables([other, shuffled])) == networks).all()
    mind = small.classes[0].mind
    known = Networks(tuple(mind.behaviours), ("shape", "size"), 2, networks[1])
    assert known == learner(1).networks

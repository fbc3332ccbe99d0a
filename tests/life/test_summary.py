"""The table of lives: its columns, their types, and that they agree with each other."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from animat.life.life import live
from animat.life.lives import live_many
from animat.life.summary import CAUSES
from animat.mind.mind import Mind

WORDS = pa.dictionary(pa.int32(), pa.string())

COLUMNS = {
    "world": WORDS,
    "agent": WORDS,
    "seed": pa.uint64(),
    "life": pa.int64(),
    "lifespan": pa.int64(),
    "censored": pa.bool_(),
    "death_variable": WORDS,
    "death_side": WORDS,
    "death_cause": WORDS,
    "encounters": pa.int64(),
    "acts": pa.int64(),
    "successes": pa.int64(),
    "failures": pa.int64(),
    "disregarded": pa.int64(),
    "unreached": pa.int64(),
    "blocked": pa.int64(),
    "trainings": pa.int64(),
    "mean_drive": pa.float64(),
    **{
        f"{what}_{b}": pa.int64()
        for b in ("eat", "shelter", "interact")
        for what in ("acts", "successes")
    },
    "error": pa.string(),
}


@pytest.fixture(scope="module")
def table(small):
    return live_many(Mind(), small, lives=200, seed=12, steps=3_000).table


def test_every_column_has_its_type(table):
    assert {field.name: field.type for field in table.schema} == COLUMNS


def test_the_schema_is_the_same_whoever_died(table, small):
    none = live_many(Mind(death=False), small, lives=3, steps=50).table
    assert none.schema == table.schema
    assert none["death_cause"].null_count == 3
    both = pa.concat_tables([none, table]).unify_dictionaries()
    assert both.num_rows == 203


def test_a_table_goes_through_a_parquet_file(table, tmp_path):
    pq.write_table(table, tmp_path / "lives.parquet")
    assert pq.read_table(tmp_path / "lives.parquet").equals(table)


def test_the_counts_agree_with_each_other(table):
    c = {name: table[name].to_numpy() for name in COLUMNS if COLUMNS[name] != WORDS}
    assert (c["acts"] == c["successes"] + c["failures"]).all()
    for what in ("acts", "successes"):
        assert (c[what] == sum(c[f"{what}_{b}"] for b in ("eat", "shelter", "interact"))).all()
    ended = c["acts"] + c["disregarded"] + c["unreached"]
    assert set(np.unique(c["encounters"] - ended)) <= {0, 1}  # one may be under way
    assert (c["trainings"] == 0).all()
    assert (c["seed"] == 12).all()
    assert 0.2 < c["censored"].mean() < 0.98 or 1 - c["censored"].mean() > 0.2


def test_only_who_died_died_of_something(table):
    censored = np.array(table["censored"].to_pylist())
    spans = table["lifespan"].to_numpy()
    assert 0 < censored.sum() < len(censored)
    for name in ("death_variable", "death_side", "death_cause"):
        missing = np.array([value is None for value in table[name].to_pylist()])
        assert np.array_equal(missing, censored)
    assert (spans[censored] == 3_000).all()
    assert (spans[~censored] <= 3_000).all()
    assert set(table["death_cause"].to_pylist()) <= {*CAUSES.values(), None}


def test_a_life_tells_the_same_of_itself(table, small):
    for row in table.slice(0, 40).to_pylist():
        life = live(Mind(), small, seed=12, life=row["life"], steps=3_000)
        assert life.summary == row
        assert life.lifespan == row["lifespan"]
        assert life.dead != row["censored"]
        if life.dead:
            told = f"{row['death_variable']} {row['death_side']}, {row['death_cause']}"
            assert life.death == told
        else:
            assert life.death is None


def test_world_and_agent_go_by_their_names(table, small, trained):
    assert set(table["world"].to_pylist()) == {"small"}
    assert set(table["agent"].to_pylist()) == {"BLIND"}
    af = live(Mind(agent="AF", networks=trained), small, seed=2**64 - 1, steps=10).summary
    assert (af["agent"], af["seed"]) == ("AF", 2**64 - 1)


def test_the_mean_drive_is_the_mean_over_steps_and_drives(small, columns):
    life = live(Mind(), small, seed=12, steps=2_000, record="all")
    c = columns(life)
    drives = np.column_stack([c["hunger"], c["fatigue"], c["curiosity"]])
    assert life.summary["mean_drive"] == pytest.approx(drives.mean(), rel=1e-12)


def test_deaths_of_every_cause_get_their_name(small, affording, caring_for):
    wanted = {
        "metabolism": (small, {"rate": 0.01, "lethal_margin": 0.1}, {"failure_effect": 0.0}),
        "failure": (affording(0.0), {"start": 0.1, "rate": 1e-7}, {}),
        "success": (affording(1.0), {"start": 0.85, "rate": 1e-7}, {"overflow": "lethal"}),
    }
    for cause, (world, change, settings) in wanted.items():
        mind = Mind(variables=caring_for("nutrition", **change), **settings)
        table = live_many(mind, world, lives=5, steps=20_000).table
        assert table["death_cause"].to_pylist() == [cause] * 5
        assert table["death_variable"].to_pylist() == ["nutrition"] * 5
        side = "high" if cause == "success" else "low"
        assert table["death_side"].to_pylist() == [side] * 5

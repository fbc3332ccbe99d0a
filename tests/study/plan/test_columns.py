"""Rows of a table: what is missing is null, and what failed has no more than its name."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from animat.life.likelihoods import likelihoods
from animat.life.scenario import bring_together
from animat.mind.mind import Mind
from animat.study.plan.columns import joined, long_table, rows, schema
from animat.world.world import World

WANTED = pa.schema(
    [
        ("case", pa.int64()),
        ("agent", pa.dictionary(pa.int32(), pa.string())),
        ("lifespan", pa.int64()),
        ("weights", pa.list_(pa.float64())),
        ("acts_feed", pa.int64()),
        ("error", pa.string()),
    ]
)


def test_what_failed_has_its_name_and_its_error():
    columns = {
        "case": pa.array([3, 3, 3]),
        "agent": pa.array(["AF"] * 3).dictionary_encode(),
        "lifespan": pa.array([10, 20, 30]),
        "weights": pa.array([[1.0], [2.0], [3.0]]),
    }
    table = rows(columns, [None, "lost", None], WANTED)
    assert table.schema.equals(WANTED)
    assert table.to_pydict() == {
        "case": [3, 3, 3],
        "agent": ["AF"] * 3,
        "lifespan": [10, None, 30],
        "weights": [[1.0], None, [3.0]],
        "acts_feed": [None] * 3,
        "error": [None, "lost", None],
    }


def test_tables_are_joined_without_seams():
    one, other = (pa.table({"a": pa.array([text]).dictionary_encode(), "n": [1]}) for text in "xy")
    table = joined([one, other])
    assert table.to_pydict() == {"a": ["x", "y"], "n": [1, 1]}
    assert all(column.num_chunks == 1 for column in table.columns)


def test_a_long_table_names_each_likelihood():
    setting = bring_together(Mind(), World.abundant())
    states, _ = setting.begin(1, np.arange(2, dtype=np.uint64))
    said = likelihoods(setting, states)
    table = long_table(setting, said, {"life": np.array([7, 9])})
    for row in table.to_pylist():
        life = [7, 9].index(row["life"])
        network = list(setting.mind.behaviours).index(row["network"])
        kind = [one.name for one in setting.world.types].index(row["object"])
        assert row["likelihood"] == said[life, network, kind]
    assert table.num_rows == 2 * 3 * 4


def test_likelihoods_are_told_of_those_whose_networks_matter(faults):
    told = {}
    for agent in ("BLIND", "ORACLE", "LEARNING"):
        plan = faults.plan(
            f'name = "a"\nlives = 1\nsteps = 5\nmeasures = ["likelihoods"]\n'
            f'[mind]\nagent = "{agent}"\n'
        )
        names = schema(plan, "lives").names
        told[agent] = ("weights" in names, "likelihood_eat_TS" in names)
        assert (names[0], names[-1]) == ("case", "error")
    assert told == {
        "BLIND": (False, False),
        "ORACLE": (False, False),
        "LEARNING": (True, True),
    }

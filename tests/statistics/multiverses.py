"""Multiverses made up so that what must be found in them is known beforehand."""

from __future__ import annotations

from itertools import product

import numpy as np
import pyarrow as pa
import pytest

from animat.statistics.claims import CELLS
from animat.statistics.universes import judge_universes

READINGS = {
    "physiology": ("excess", "decay", "linear"),
    "overflow": ("clamp", "lethal"),
    "effect": ("0.2", "0"),
    "gate": ("positive", "always"),
    "cycles": ("10", "1"),
}

NETWORKS = ("eat", "shelter", "interact")
OBJECTS = ("TS", "TL", "CS", "CL")


def lives_of(means, lives=30, cap=50_000, seed=1):
    """Lives of universes, whose mean lifespans in the four cells are [U, 4]."""
    means = np.asarray(means, dtype=np.float64)
    count = len(means)
    rng = np.random.default_rng(seed)
    spans = np.ceil(rng.gamma(4.0, means[:, :, None] / 4.0, (count, len(CELLS), lives)))
    spans = np.minimum(spans, cap).ravel().astype(np.int64)
    dead = spans < cap
    acts = rng.integers(1, 40, len(spans))
    worlds, agents = zip(*CELLS, strict=True)
    return pa.table(
        {
            "universe": np.repeat(np.arange(count), len(CELLS) * lives),
            "world": np.tile(np.repeat(worlds, lives), count),
            "agent": np.tile(np.repeat(agents, lives), count),
            "life": np.tile(np.arange(lives), count * len(CELLS)),
            "seed": np.full(len(spans), 7),
            "lifespan": spans,
            "censored": ~dead,
            "death_variable": pa.array(np.where(dead, "nutrition", None), pa.string()),
            "death_side": pa.array(np.where(dead, "low", None), pa.string()),
            "death_cause": pa.array(np.where(dead, "metabolism", None), pa.string()),
            "acts": acts,
            "successes": rng.binomial(acts, 0.6),
        }
    )


def likelihoods_of(learnt, robots=5, seed=2):
    """Likelihoods of the robots of universes; `learnt` [U] says in which they match Table 1."""
    rng = np.random.default_rng(seed)
    rows = []
    for universe, well in enumerate(learnt):
        for robot, network, thing in product(range(robots), NETWORKS, OBJECTS):
            afforded = network == "interact" or (network == "eat") == thing.endswith("S")
            good = 0.95 if afforded else 0.05
            said = good if well else 0.5
            rows.append(
                {
                    "universe": universe,
                    "robot": robot,
                    "network": network,
                    "object": thing,
                    "likelihood": said + rng.uniform(-0.04, 0.04),
                    "afforded": float(afforded),
                }
            )
    return pa.Table.from_pylist(rows)


def every_combination(readings=READINGS, copies=1):
    """Columns of a table of universes with every combination of the readings, `copies` times."""
    rows = list(product(*readings.values())) * copies
    return {name: [row[place] for row in rows] for place, name in enumerate(readings)}


def plant(columns, gain, learnt=None, **settings):
    """Judge made-up universes: `gain` of one's readings is the abundant AF / BLIND."""
    names = list(columns)
    universes = [dict(zip(names, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    means = [[2_000.0, 2_000.0 * gain(one), 1_500.0, 1_500.0] for one in universes]
    well = [learnt(one) if learnt else True for one in universes]
    table = judge_universes(lives_of(means, **settings), likelihoods_of(well), resamples=299)
    for name, values in columns.items():
        table = table.append_column(name, pa.array(values))
    return table


@pytest.fixture(scope="session")
def make_lives():
    return lives_of


@pytest.fixture(scope="session")
def make_likelihoods():
    return likelihoods_of


@pytest.fixture(scope="session")
def combinations():
    return every_combination


@pytest.fixture(scope="session")
def make_universes():
    return plant


@pytest.fixture(scope="session")
def readings():
    return READINGS


@pytest.fixture(scope="session")
def planted():
    """AF lives four times as long just where overflow is clamped and failures cost; else half."""
    return plant(
        every_combination(copies=4),
        lambda one: 4.0 if (one["overflow"], one["effect"]) == ("clamp", "0.2") else 0.5,
        learnt=lambda one: one["cycles"] == "10",
    )

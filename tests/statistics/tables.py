"""Tables with a known answer, for the tests of the report."""

import numpy as np
import pyarrow as pa
import pytest

TABLE_1 = {
    ("eat", "TS"): 1.0,
    ("eat", "TL"): 0.0,
    ("eat", "CS"): 1.0,
    ("eat", "CL"): 0.0,
    ("shelter", "TS"): 0.0,
    ("shelter", "TL"): 1.0,
    ("shelter", "CS"): 0.0,
    ("shelter", "CL"): 1.0,
    ("interact", "TS"): 1.0,
    ("interact", "TL"): 1.0,
    ("interact", "CS"): 1.0,
    ("interact", "CL"): 1.0,
}


def make_lives(cells, *, cap=None, shift=0, seed=3):
    """A lives table from {(world, agent): lifespans}; those at or beyond `cap` are censored."""
    tables = []
    for number, ((world, agent), lifespans) in enumerate(cells.items()):
        steps = np.asarray(lifespans, dtype=np.int64)
        n = len(steps)
        censored = np.zeros(n, dtype=bool) if cap is None else steps >= cap
        rng = np.random.default_rng([seed, number])
        acts = rng.integers(1, 40, n)
        died = [None if c else "died" for c in censored]
        tables.append(
            pa.table(
                {
                    "world": [world] * n,
                    "agent": [agent] * n,
                    "life": np.arange(n) + shift * number,
                    "seed": np.full(n, 7, dtype=np.int64),
                    "lifespan": steps if cap is None else np.minimum(steps, cap),
                    "censored": censored,
                    "death_variable": pa.array([d and "nutrition" for d in died], pa.string()),
                    "death_side": pa.array([d and "low" for d in died], pa.string()),
                    "death_cause": pa.array([d and "metabolism" for d in died], pa.string()),
                    "acts": acts,
                    "successes": rng.binomial(acts, 0.6),
                    "mean_drive": rng.normal(0.3, 0.05, n),
                }
            )
        )
    return pa.concat_tables(tables)


def make_likelihoods(seeds, wrong=0, flaw=("eat", "TS"), value=0.5):
    """Likelihoods of `seeds` robots, of which the first `wrong` err in the network of `flaw`."""
    rows = []
    for seed in range(seeds):
        for (network, thing), afforded in TABLE_1.items():
            good = 0.95 if afforded else 0.05
            likelihood = value if seed < wrong and (network, thing) == flaw else good
            rows.append(
                {
                    "seed": seed,
                    "network": network,
                    "object": thing,
                    "likelihood": likelihood,
                    "afforded": afforded,
                }
            )
    return pa.Table.from_pylist(rows)


@pytest.fixture(scope="session")
def lives_table():
    return make_lives


@pytest.fixture(scope="session")
def likelihoods_table():
    return make_likelihoods


@pytest.fixture
def paper_table():
    return dict(TABLE_1)

"""How often the report's intervals hold the truth, and its tests cry wolf, in made-up lives.

Lives of two agents that do not differ, in worlds that do, are drawn many times over. `--luck` is
how much of a lifespan is luck that lives of one number share.

    python tools/coverage.py --lives 40 --worlds 2 --luck 0.5
    python tools/coverage.py --lives 5 --worlds 30 --luck 0.3
"""

from __future__ import annotations

import argparse

import numpy as np
import pyarrow as pa

from animat.report.margins import margin
from animat.report.sample import sample

MEAN = 400.0
"""The mean lifespan in the first world; in the n-th it is n times that."""


def study(rng: np.random.Generator, lives: int, worlds: int, luck: float) -> pa.Table:
    """Return lives of two agents in all worlds, every one of which ends."""
    agents, places, numbers = (
        axis.ravel() for axis in np.meshgrid(range(2), range(worlds), range(lives), indexing="ij")
    )
    shared = rng.exponential(1.0, lives)[numbers]
    own = rng.exponential(1.0, len(numbers))
    steps = np.ceil(MEAN * (1 + places) * (luck * shared + (1 - luck) * own))
    return pa.table(
        {
            "agent": np.array(["A", "B"])[agents],
            "world": places,
            "seed": np.zeros(len(numbers), np.int64),
            "life": numbers,
            "lifespan": steps,
            "censored": np.zeros(len(numbers), bool),
            **{name: ["made up"] * len(numbers) for name in
               ("death_variable", "death_side", "death_cause")},
            **{name: np.ones(len(numbers)) for name in ("acts", "successes", "mean_drive")},
        }
    )  # fmt: skip


def main() -> None:
    """Draw studies, and print shares of them."""
    parser = argparse.ArgumentParser(description="Try the report's intervals on made-up lives.")
    parser.add_argument("--lives", type=int, default=40, help="lives of a case")
    parser.add_argument("--worlds", type=int, default=2)
    parser.add_argument("--luck", type=float, default=0.5, help="how much of a life it makes")
    parser.add_argument("--studies", type=int, default=400)
    given = parser.parse_args()
    truth = MEAN * (1 + np.arange(given.worlds)).mean() + 0.5  # steps are counted upwards
    held = np.zeros(4)
    for seed in range(given.studies):
        rng = np.random.default_rng(seed)
        lives = study(rng, given.lives, given.worlds, given.luck)
        found = margin(sample(lives, ["agent", "world"]), "agent", resamples=399, seed=seed)
        compared = found.comparisons[0]
        mean = found.levels[0].summary.mean
        held += [
            mean.low <= truth <= mean.high,
            compared.ratio.low <= 1.0 <= compared.ratio.high,
            compared.delta.low <= 0.0 <= compared.delta.high,
            compared.test.p < 0.05,
        ]
    mean, ratio, delta, wolf = held / given.studies
    print(f"resampled: {found.resampled}")
    print(f"95 % intervals hold the mean {mean:.1%}, the ratio {ratio:.1%}, the delta {delta:.1%}")
    print(f"p < 0.05 where nothing differs: {wolf:.1%}")


if __name__ == "__main__":
    main()

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

from animat.statistics.factor_effects import margin
from animat.statistics.sample import sample
from animat.statistics.two_factors import interactions

MEAN = 400.0
"""The mean lifespan in the first world; in the n-th it is n times that."""

TOLD = (
    "mean", "ratio", "Cliff's delta", "difference of pairs", "outlives in", "rank-biserial",
    "difference of differences", "ratio of ratios", "p < 0.05: log-rank",
    "p < 0.05: interaction of differences", "p < 0.05: interaction of ratios",
)  # fmt: skip
"""What is counted; the tests cry wolf, as nothing differs."""


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
    parser.add_argument("--worlds", type=int, default=2, help="2 or more")
    parser.add_argument("--luck", type=float, default=0.5, help="how much of a life it makes")
    parser.add_argument("--studies", type=int, default=400)
    given = parser.parse_args()
    truth = MEAN * (1 + np.arange(given.worlds)).mean() + 0.5  # steps are counted upwards
    held = np.zeros(len(TOLD))
    for seed in range(given.studies):
        rng = np.random.default_rng(seed)
        lives = study(rng, given.lives, given.worlds, given.luck)
        read = sample(lives, ["agent", "world"])
        found = margin(read, "agent", resamples=399, seed=seed)
        compared = found.comparisons[0]
        mean = found.levels[0].summary.mean
        pairs = compared.paired
        assert pairs is not None
        (both,) = interactions(read, ["agent", "world"], resamples=9)
        contrast = both.contrasts[0]
        told = [
            (mean, truth), (compared.ratio, 1.0), (compared.delta, 0.0), (pairs.difference, 0.0),
            (pairs.outlives, (1.0 - pairs.ties) / 2), (pairs.rank_biserial, 0.0),
            (contrast.difference, 0.0), (contrast.ratio, 1.0),
        ]  # fmt: skip
        held += [
            *(estimate.low <= value <= estimate.high for estimate, value in told),
            compared.test.p < 0.05,
            both.differences.p < 0.05,
            both.ratios.p < 0.05,
        ]
    print(f"resampled: {found.resampled}; 95 % intervals hold the truth in")
    for name, share in zip(TOLD, held / given.studies, strict=True):
        print(f"{share:7.1%}  {name}")


if __name__ == "__main__":
    main()

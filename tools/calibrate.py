"""Look among random layouts for Worlds 1 and 2, whose Figure 2 is lost.

For each layout: the mean lifespan of BLIND, the ratio of an agent that knows Table 1 (ORACLE) to
it, and how far the networks of robots that learn there are from Table 1 in the worst of their
twelve likelihoods. The number and the places of objects are all that differs.

    python tools/calibrate.py --counts 2 2 2 2 --layouts 40
"""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path

import numpy as np

import animat
from animat.study.experiment1 import learn

TYPES = ("TS", "TL", "CS", "CL")


def worst_likelihood(world: animat.World, robots: int) -> float:
    """Return the largest distance of a mean likelihood from Table 1 after Experiment 1."""
    final = learn(
        animat.Mind(), world, animat.Khepera(), robots=robots, steps=300_000, seed=7
    ).final
    likelihood = final["likelihood"].to_numpy().reshape(robots, -1)
    afforded = final["afforded"].to_numpy().reshape(robots, -1)[0]
    return float(np.abs(likelihood.mean(axis=0) - afforded).max())


def main() -> None:
    """Print a line for each layout."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--counts", type=int, nargs=4, required=True, metavar=TYPES)
    parser.add_argument("--first", type=int, default=0, help="seed of the first layout")
    parser.add_argument("--layouts", type=int, default=40)
    parser.add_argument("--lives", type=int, default=200)
    parser.add_argument("--robots", type=int, default=16)
    parser.add_argument("--gap", type=float, default=70.0)
    parser.add_argument("--save", type=Path, help="save the first layout here")
    options = parser.parse_args()
    counts = dict(zip(TYPES, options.counts, strict=True))
    out = csv.writer(sys.stdout, delimiter="\t")
    out.writerow(("objects", "layout", "BLIND", "ORACLE", "ratio", "learning error"))
    for seed in range(options.first, options.first + options.layouts):
        world = animat.World.random(counts, seed=seed, gap=options.gap)
        if options.save:
            world.save(options.save)
            return
        means = [
            animat.live_many(animat.Mind(agent=agent), world, lives=options.lives, seed=7)
            .table["lifespan"]
            .to_numpy()
            .mean()
            for agent in ("BLIND", "ORACLE")
        ]
        error = worst_likelihood(world, options.robots) if options.robots else float("nan")
        out.writerow(
            (
                sum(options.counts),
                seed,
                f"{means[0]:.0f}",
                f"{means[1]:.0f}",
                f"{means[1] / means[0]:.2f}",
                f"{error:.3f}",
            )
        )
        sys.stdout.flush()


if __name__ == "__main__":
    main()

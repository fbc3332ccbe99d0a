"""Look among random layouts for Worlds 1 and 2, whose Figure 2 is lost.

For each layout: robots learn in it (or in the world of --teacher), then BLIND and AF live in it.
Told are the mean lifespan of BLIND, the ratio of AF to it, and the distance of the networks from
Table 1: the mean over robots in the worst of the twelve likelihoods. The number and the places of
the objects are all that differs.

    python tools/calibrate.py --counts 2 2 2 2 --layouts 40
    python tools/calibrate.py --counts 2 1 1 1 --layouts 40 --teacher world1.toml
    python tools/calibrate.py --counts 2 2 2 2 --first 17 --save world1.toml
"""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path

import numpy as np

import animat
from animat.life.batch import Batch
from animat.life.likelihoods import afforded, likelihoods
from animat.life.scenario import bring_together

TYPES = ("TS", "TL", "CS", "CL")
SEED = 20_030_401
"""Of the lives a layout is tried with; others judge the claims."""


def main() -> None:
    """Print a line for each layout."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--counts", type=int, nargs=4, required=True, metavar=TYPES)
    parser.add_argument("--first", type=int, default=0, help="seed of the first layout")
    parser.add_argument("--layouts", type=int, default=40)
    parser.add_argument("--lives", type=int, default=200)
    parser.add_argument("--robots", type=int, default=16)
    parser.add_argument("--gap", type=float, default=70.0)
    parser.add_argument("--teacher", type=Path, help="the world file robots learn in")
    parser.add_argument("--save", type=Path, help="save the first layout here and stop")
    options = parser.parse_args()
    counts = dict(zip(TYPES, options.counts, strict=True))
    learner = animat.Mind(agent="LEARNING")
    hidden = learner.learning.hidden_units
    robots = np.arange(options.robots, dtype=np.uint64)
    out = csv.writer(sys.stdout, delimiter="\t")
    out.writerow(("objects", "layout", "BLIND", "AF", "ratio", "learning error"))
    for seed in range(options.first, options.first + options.layouts):
        world = animat.World.random(counts, seed=seed, gap=options.gap)
        if options.save:
            world.save(options.save)
            return
        school = animat.World.load(options.teacher) if options.teacher else world
        setting = bring_together(learner, school)
        states = Batch(setting, SEED, 300_000).run(robots).states
        error = np.abs(likelihoods(setting, states).mean(axis=0) - afforded(setting)).max()
        networks = [
            animat.Networks(tuple(learner.behaviours), school.feature_names, hidden, weights)
            for weights in states["weights"]
        ]
        blind, knowing = (
            animat.live_many(
                animat.Mind(agent=agent), world, lives=options.lives, seed=SEED, networks=known
            )
            .table["lifespan"]
            .to_numpy()
            .mean()
            for agent, known in (("BLIND", None), ("AF", networks))
        )
        out.writerow(
            (
                sum(options.counts),
                seed,
                f"{blind:.0f}",
                f"{knowing:.0f}",
                f"{knowing / blind:.2f}",
                f"{error:.3f}",
            )
        )
        sys.stdout.flush()


if __name__ == "__main__":
    main()

"""How the gain of knowing affordances depends on the number of objects and on their layout.

For each number of objects, random layouts of the four types in equal shares; in each, BLIND and an
agent that knows Table 1 (ORACLE), with the same luck. Writes a table and a figure.

    python tools/density.py --layouts 12 --lives 200 --out results/density
"""

from __future__ import annotations

import argparse
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

import animat

ORDER = ("TS", "CL", "CS", "TL")
"""Which types get one more where the number is no multiple of four."""

GAP = 50.0
"""mm between objects, so that 40 of them fit; the robot does not pass through the narrowest."""

NUMBERS = (3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 24, 28, 32, 36, 40)


def layout(objects: int, seed: int) -> animat.World:
    """Return a random world with so many objects."""
    counts = {name: (objects + 3 - n) // 4 for n, name in enumerate(ORDER)}
    return animat.World.random(counts, seed=seed, gap=GAP)


def lifespans(world: animat.World, lives: int, steps: int, physiology: str) -> tuple[float, float]:
    """Return the mean lifespans of BLIND and ORACLE, restricted at `steps`."""
    means = []
    for agent in ("BLIND", "ORACLE"):
        mind = animat.Mind(agent=agent, physiology=physiology)
        table = animat.live_many(mind, world, lives=lives, steps=steps).table
        means.append(float(table["lifespan"].to_numpy().mean()))
    return means[0], means[1]


def main() -> None:
    """Run the study and write its table and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--layouts", type=int, default=12)
    parser.add_argument("--lives", type=int, default=200)
    parser.add_argument("--steps", type=int, default=300_000)
    parser.add_argument("--physiology", default="excess")
    parser.add_argument("--numbers", type=int, nargs="+", default=list(NUMBERS))
    parser.add_argument("--out", type=Path, default=Path("results/density"))
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for objects in options.numbers:
        for seed in range(options.layouts):
            blind, knowing = lifespans(
                layout(objects, seed), options.lives, options.steps, options.physiology
            )
            rows.append(
                {
                    "objects": objects,
                    "layout": seed,
                    "blind": blind,
                    "knowing": knowing,
                    "ratio": knowing / blind,
                }
            )
        here = sorted(row["ratio"] for row in rows if row["objects"] == objects)
        blind = sorted(row["blind"] for row in rows if row["objects"] == objects)
        print(
            f"{objects:3d} objects: BLIND {blind[0]:8.0f} {blind[len(blind) // 2]:8.0f}"
            f" {blind[-1]:8.0f}   ratio {here[0]:6.2f} {here[len(here) // 2]:6.2f} {here[-1]:6.2f}"
            "   (least, median, most over layouts)",
            flush=True,
        )
        pq.write_table(pa.Table.from_pylist(rows), options.out / "density.parquet")
    from animat.figures.ratio import ratio_figure
    from animat.figures.style import save

    save(ratio_figure(pa.Table.from_pylist(rows)), options.out / "density")


if __name__ == "__main__":
    main()

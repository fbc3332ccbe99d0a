"""Tables of lives from designs whose answer is known, for the tests of the report."""

import numpy as np
import pyarrow as pa


def lived(cases, lives, *, paired=True, cap=3_000, seed=0, luck_counts=0.5):
    """A table of lives: `cases` are (factors as a dict, scale of the lifespans in steps) each.

    `luck_counts` is how much of a lifespan is the luck that lives of one number share.
    """
    rng = np.random.default_rng(seed)
    luck = rng.exponential(1.0, lives)
    rows = []
    for number, (factors, scale) in enumerate(cases):
        own = rng.exponential(1.0, lives)
        steps = np.ceil(scale * (luck_counts * luck + (1 - luck_counts) * own) if paired
                        else scale * own)  # fmt: skip
        for life in range(lives):
            acts = int(rng.integers(0, 30))
            died = bool(steps[life] < cap)
            rows.append(
                {
                    "case": number,
                    "world": "w",
                    "agent": "BLIND",
                    "seed": 7,
                    "life": life if paired else number * lives + life,
                    "lifespan": int(max(1, min(steps[life], cap))),
                    "censored": not died,
                    "death_variable": "nutrition" if died else None,
                    "death_side": "low" if died else None,
                    "death_cause": ("metabolism", "failure")[life % 2] if died else None,
                    "acts": acts,
                    "successes": int(rng.binomial(acts, 0.6)),
                    "mean_drive": float(rng.normal(0.3, 0.05)),
                    "acts_eat": acts,
                    "successes_eat": acts // 2,
                }
                | factors
            )
    return pa.Table.from_pylist(rows)


def crossed(**levels):
    """Every combination of the levels, first factor slowest, as dicts."""
    made = [{}]
    for name, values in levels.items():
        made = [one | {name: value} for one in made for value in values]
    return made

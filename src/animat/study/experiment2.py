"""Experiment 2: does knowing affordances lengthen life? ("Second Experiment Set"; Figure 5)

BLIND against AF in an abundant and a scarce world. Life i of every cell starts in the same pose
and meets the same luck, and AF has the networks of the i-th robot of Experiment 1.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyarrow as pa

from animat.life.life import Progress
from animat.life.lives import live_chunks
from animat.life.setting import bring_together
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.robot.khepera import Khepera
from animat.world.world import World

AGENTS = ("BLIND", "AF")


def compare(
    mind: Mind,
    worlds: Sequence[World],
    robot: Khepera,
    networks: Sequence[Networks],
    *,
    lives: int,
    steps: int,
    seed: int,
    progress: Progress | None = None,
) -> pa.Table:
    """Return the table of lives of every cell, `lives` a cell, `networks` taken in turn.

    `progress` is called with lives lived. Raises LifeError for what cannot be lived.
    """
    weights = np.array([one.weights for one in networks])
    cells = []
    for world in worlds:
        for agent in AGENTS:
            knowing = {"networks": networks[0] if agent == "AF" else None}
            setting = bring_together(
                mind.model_copy(update={"agent": agent, **knowing}), world, robot
            )
            known = weights if agent == "AF" else None
            for chunk in live_chunks(setting, seed, 0, lives, steps, known):
                cells.append(pa.table(chunk))
                if progress:
                    progress(cells[-1].num_rows)
    return pa.concat_tables(cells).unify_dictionaries()

"""The robots that teach: what they learnt, read from their table."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from animat.files.checksummed import read_parquet
from animat.files.settings import SettingsError
from animat.study.plan.plan import Plan, world_of
from animat.study.plan.shard import part_identity, problem_of


def read_networks(directory: Path, plan: Plan, place: int) -> NDArray[np.float64]:
    """Return the weights [robots, B, W] of a class, all of whose parts are finished.

    They are NaN for robots that failed. Raises SettingsError where a file is not as it was written.
    """
    parts = {directory / part.file: part for part in plan.parts_of_class(place)}
    wrong = [problem_of(file, part_identity(plan, part)) for file, part in parts.items()]
    if any(wrong):
        raise SettingsError(*filter(None, wrong))
    return networks_of(plan, place, pa.concat_tables(read_parquet(file) for file in parts))


def networks_of(plan: Plan, place: int, table: pa.Table) -> NDArray[np.float64]:
    """Return the weights [robots, B, W] of a class; NaN of robots that failed.

    `table` holds the rows of all robots of the class, and may hold others.
    """
    each = plan.classes[place]
    own = table.filter(pc.field("identity") == each.identity).sort_by("robot")
    inputs = len(world_of(each.teacher.world).feature_names)
    shape = (each.robots, len(each.mind.behaviours), each.mind.weight_count(inputs))
    weights = np.full(shape, np.nan)
    whole = np.asarray(own["weights"].is_valid())
    flat = own["weights"].combine_chunks().flatten()
    weights[whole] = np.asarray(flat).reshape(-1, *shape[1:])
    return weights

"""Which parameters a lifespan depends on: Sobol's indices from a study of Saltelli's points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from animat.files.settings import SettingsError
from animat.statistics.sobol import sobol_table
from animat.study.file.study import Study
from animat.study.store.results import Results

AGENT = "mind.agent"


class Sensitivity(NamedTuple):
    """Sobol's indices of each agent, and what share of the variance is random.

    `indices` is of `sobol_table`; `noise` how much of the variance of an agent's mean lifespans
    over all points is that of a mean of so few lives.
    """

    study: Study
    indices: pa.Table
    noise: dict[str, float]


def check(study: Study) -> None:
    """Refuse a study of which no indices can be had. Raises SettingsError."""
    sample = study.design.sample
    problems = []
    if sample is None or sample.method != "saltelli":
        problems.append('needs a [design.sample] with method = "saltelli"')
    if list(study.design.grid) != [AGENT] or study.design.cases or study.design.exclude:
        problems.append(f'needs a grid of "{AGENT}" alone, no listed cases and no exclusions')
    if study.lives < 2:
        problems.append("needs at least 2 lives at each point")
    if problems:
        raise SettingsError(*(f"{study.name}: {problem}" for problem in problems))


def sensitivity(results: Results) -> Sensitivity:
    """Return the indices of the lifespans in a results directory that is finished.

    Raises SettingsError for a study that is none of Saltelli's points, or with lives that failed.
    """
    study = results.study
    check(study)
    sample = study.design.sample
    assert sample is not None
    total, squares, lives = _sums(results)
    if np.any(lives != study.lives):
        raise SettingsError(
            f"{results.directory}: {int((lives != study.lives).sum()):,} cases have lives that"
            " failed or are missing, and indices need all points"
        )
    mean = total / lives
    spread = (squares / lives - mean**2) / (lives - 1)
    agents = [str(agent) for agent in study.design.grid[AGENT]]
    logs = np.log(mean).reshape(len(agents), sample.size)
    random = (spread / mean**2).reshape(len(agents), sample.size)
    return Sensitivity(
        study,
        sobol_table(dict(zip(agents, logs, strict=True)), [name_of(key) for key in sample.over]),
        {
            agent: float(noise.mean() / values.var()) if np.ptp(values) else 0.0
            for agent, values, noise in zip(agents, logs, random, strict=True)
        },
    )


def name_of(key: str) -> str:
    """Return the key of a parameter in words: nutrition rate, success effect."""
    parts = key.split(".")
    return " ".join(parts[-2:] if len(parts) > 3 else parts[-1:]).replace("_", " ")


def _sums(results: Results) -> tuple[NDArray, NDArray, NDArray]:
    """Sum, sum of squares and number of the lifespans of every case, read a part at a time."""
    cases = results.cases.num_rows
    total, squares, lives = np.zeros(cases), np.zeros(cases), np.zeros(cases)
    for batch in results.batches({"case", "lifespan", "error"}):
        lived = batch.filter(pc.field("error").is_null())
        case = np.asarray(lived["case"])
        span = np.asarray(lived["lifespan"]).astype(np.float64)
        total += np.bincount(case, span, cases)
        squares += np.bincount(case, span**2, cases)
        lives += np.bincount(case, minlength=cases)
    return total, squares, lives

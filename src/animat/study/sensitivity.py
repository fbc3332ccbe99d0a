"""Which parameters a lifespan depends on: Sobol's indices from a study of Saltelli's points."""

from __future__ import annotations

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray
from pyarrow import csv

from animat.files import whole
from animat.report import page
from animat.report.estimates import Estimate
from animat.report.figures.sobol import ORDERS, sobol_figure
from animat.report.figures.style import save
from animat.report.multiverse.sensitivity import sobol_table
from animat.report.numerals import numeral
from animat.settings import SettingsError
from animat.study.design.factors import Range
from animat.study.design.study import Study
from animat.study.inputs import inputs_sections
from animat.study.provenance import provenance
from animat.study.store.results import Results

AGENT = "mind.agent"

FIGURE = (
    "Share of the variance of the logarithm of the mean lifespan that each parameter explains:"
    " alone, and with all its interactions. Lines are 95 % intervals."
)


class Sensitivity(NamedTuple):
    """Sobol's indices of each agent, and what share of the variance is luck.

    `indices` is of `sobol_table`; `luck` how much of the variance of an agent's mean lifespans
    over all points is that of a mean of so few lives.
    """

    study: Study
    indices: pa.Table
    luck: dict[str, float]


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
    of_luck = (spread / mean**2).reshape(len(agents), sample.size)
    return Sensitivity(
        study,
        sobol_table(dict(zip(agents, logs, strict=True)), [name_of(key) for key in sample.over]),
        {
            agent: float(noise.mean() / values.var()) if np.ptp(values) else 0.0
            for agent, values, noise in zip(agents, logs, of_luck, strict=True)
        },
    )


def name_of(key: str) -> str:
    """Return the key of a parameter in words: nutrition rate, success effect."""
    parts = key.split(".")
    return " ".join(parts[-2:] if len(parts) > 3 else parts[-1:]).replace("_", " ")


def publish(found: Sensitivity, directory: Path, command: str) -> None:
    """Write the indices, their figure and a page, over what is there. Raises SettingsError."""
    with whole(directory / "indices.csv") as path:
        csv.write_csv(found.indices, path)
    drawn, _ = save(sobol_figure(found.indices), directory / "sobol")
    study = found.study
    page.write_page(
        directory / "sensitivity.html",
        "Which parameters a lifespan depends on",
        [
            page.Section(
                "Sobol's indices",
                pictures=[page.picture_file(drawn, FIGURE, FIGURE)],
                tables=[_table(found.indices)],
            ),
            page.Section("The parameters", tables=[_ranges(study)]),
            page.Section(
                "How this was made",
                paragraphs=[f"{command} makes the same again; it goes on where it was ended."],
                code=study.to_toml() + "\n" + json.dumps(provenance(), indent=2),
            ),
            *inputs_sections(directory),
        ],
        lead=[_lead(found)],
    )


def short(found: Sensitivity, most: int = 3) -> list[str]:
    """Return a line for each agent: the parameters with the largest total indices."""
    lines = []
    for agent in found.luck:
        rows = [r for r in found.indices.to_pylist() if r["agent"] == agent]
        totals = sorted((r for r in rows if r["order"] == "total"), key=lambda r: -r["index"])
        told = ", ".join(
            f"{row['parameter']} {page.interval(_estimate(row), '.0%')}" for row in totals[:most]
        )
        lines.append(f"{agent}: {told}; luck {found.luck[agent]:.0%}")
    return lines


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


def _lead(found: Sensitivity) -> str:
    study = found.study
    luck = ", ".join(f"{share:.0%} for {agent}" for agent, share in found.luck.items())
    sample = study.design.sample
    assert sample is not None
    return (
        f"{sample.size:,} points of {len(sample.over)} parameters, {study.lives:,} lives of each"
        f" agent at each, up to {study.steps:,} steps. The mean of so few lives is itself in part"
        f" luck: that makes {luck} of the variance, and appears as interactions of everything."
    )


def _table(indices: pa.Table) -> page.TableBlock:
    rows = indices.to_pylist()
    agents = list(dict.fromkeys(row["agent"] for row in rows))
    told: dict[str, list[str]] = {}
    for row in rows:
        told.setdefault(row["parameter"], [])
    for agent in agents:
        for order in ORDERS:
            for row in rows:
                if (row["agent"], row["order"]) == (agent, order):
                    told[row["parameter"]].append(page.interval(_estimate(row), ".0%"))
    columns = ["Parameter"] + [f"{agent}, {words}" for agent in agents for words in ORDERS.values()]
    return page.TableBlock(columns, [[name, *cells] for name, cells in told.items()])


def _ranges(study: Study) -> page.TableBlock:
    sample = study.design.sample
    assert sample is not None
    rows = []
    for key, over in sample.over.items():
        spread = (
            f"{numeral(over.low)} to {numeral(over.high)}"
            f"{', by its logarithm' if over.scale == 'log' else ''}"
            if isinstance(over, Range)
            else ", ".join(map(str, over))
        )
        rows.append((name_of(key), key, spread))
    return page.TableBlock(("Parameter", "Key", "Range"), rows)


def _estimate(row: dict) -> Estimate:
    return Estimate(row["index"], row["low"], row["high"])

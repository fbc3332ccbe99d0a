"""The page on a sensitivity analysis: Sobol's indices, their figure and how it was made."""

from __future__ import annotations

import json
from pathlib import Path

import pyarrow as pa
from pyarrow import csv

from animat.experiments.sensitivity import Sensitivity, name_of
from animat.figures.sobol import ORDERS, sobol_figure
from animat.figures.style import save
from animat.files.atomic import whole
from animat.files.provenance import provenance
from animat.report import page
from animat.report.inputs import inputs_sections
from animat.statistics.estimates import Estimate
from animat.statistics.numerals import numeral
from animat.study.file.factors import Range
from animat.study.file.study import Study

FIGURE = (
    "Share of the variance of the logarithm of the mean lifespan that each parameter explains:"
    " alone, and with all its interactions. Lines are 95 % intervals."
)


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

"""The page on a sensitivity analysis: Sobol's indices, their figure and how it was made."""

from __future__ import annotations

import json
from pathlib import Path

from pyarrow import csv

from animat.experiments.sensitivity import Sensitivity, name_of
from animat.figures.sobol import ORDERS, sobol_figure
from animat.figures.style import save
from animat.files.atomic import whole
from animat.files.provenance import provenance
from animat.report import page
from animat.report.inputs import inputs_of
from animat.statistics.numerals import numeral
from animat.study.file.factors import Range
from animat.study.file.study import Study


def publish(found: Sensitivity, directory: Path, command: str) -> None:
    """Write the indices, their figure and a page, over what is there. Raises SettingsError."""
    with whole(directory / "indices.csv") as path:
        csv.write_csv(found.indices, path)
    drawn, _ = save(sobol_figure(found.indices), directory / "sobol")
    rows = found.indices.to_pylist()
    agents = dict.fromkeys(row["agent"] for row in rows)
    columns = [(agent, order) for agent in agents for order in ORDERS]
    told: dict[str, list[str]] = {row["parameter"]: [] for row in rows}
    for wanted in columns:
        for row in rows:
            if (row["agent"], row["order"]) == wanted:
                told[row["parameter"]].append(page.interval(_estimate(row), ".0%"))
    page.write_page(
        directory / "sensitivity.html",
        "sensitivity",
        found=found,
        study=found.study,
        sample=found.study.design.sample,
        columns=["Parameter", *(f"{agent}, {ORDERS[order]}" for agent, order in columns)],
        indices=told,
        ranges=_ranges(found.study),
        picture=page.address_of(drawn),
        command=command,
        made=found.study.to_toml() + "\n" + json.dumps(provenance(), indent=2),
        files=inputs_of(directory),
    )


def short(found: Sensitivity, most: int = 3) -> list[str]:
    """Return a line for each agent: the parameters with the largest total indices."""
    lines = []
    for agent in found.noise:
        rows = [r for r in found.indices.to_pylist() if r["agent"] == agent]
        totals = sorted((r for r in rows if r["order"] == "total"), key=lambda r: -r["index"])
        told = ", ".join(
            f"{row['parameter']} {page.interval(_estimate(row), '.0%')}" for row in totals[:most]
        )
        lines.append(f"{agent}: {told}; {found.noise[agent]:.0%} of the variance is random")
    return lines


def _ranges(study: Study) -> list[tuple[str, str, str]]:
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
    return rows


def _estimate(row: dict[str, float]) -> tuple[float, float, float]:
    return row["index"], row["low"], row["high"]

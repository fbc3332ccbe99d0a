"""A multiverse as a directory: tables, figures and one page."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from matplotlib.figure import Figure
from pyarrow import csv

from animat.experiments.multiverse import Multiverse
from animat.figures.causes import causes_figure
from animat.figures.marginal import factors_figure, points_figure
from animat.figures.specification import specification_figure
from animat.figures.style import save
from animat.figures.verdicts import verdicts_figure
from animat.files.atomic import whole, write_whole
from animat.files.provenance import provenance
from animat.report import page
from animat.report.inputs import inputs_of
from animat.report.multiverse_tables import WORDS, sets_table, shares_table
from animat.statistics.claims import CELLS, CLAIMS, EFFECTS
from animat.statistics.estimates import mean, share
from animat.statistics.lives import column
from animat.statistics.marginal_effects import largest_imbalance
from animat.statistics.predict import Prediction
from animat.statistics.sufficient_sets import NEARLY_ALL, SUPPORT, SURELY
from animat.statistics.survival import ALIVE, DeathCount

GAINS = {
    "abundant_gain": "factor on the abundant gain",
    "scarce_gain": "factor on the scarce gain",
}

CURVES = {
    "abundant_gain": ("C1", "AF / BLIND, abundant", (1.0, 2.0)),
    "scarce_gain": ("C2", "AF / BLIND, scarce", (1.0, 1.5)),
}
"""Effects drawn as specification curves: the claim whose verdicts colour them, words, lines."""

FIGURES = ("verdicts", "points", "factors", "causes", *(f"curve_{effect}" for effect in CURVES))
"""Every figure by the name of its file."""


def publish(found: Multiverse, directory: Path, command: str, tell: Callable[[], None]) -> None:
    """Write tables, figures and the page into `directory`, which is there, over what is there.

    `tell` is called for each figure and for the page. Raises SettingsError if it cannot be written.
    """
    _write_tables(found, directory)
    pictures = {}
    for name, draw in _drawings(found).items():
        drawn, _ = save(draw(), directory / name)
        pictures[name] = page.address_of(drawn)
        tell()
    shares, sets = shares_table(found), sets_table(found)
    page.write_page(
        directory / "report.html",
        "multiverse",
        found=found,
        study=found.study,
        pictures=pictures,
        effects=EFFECTS,
        shares=shares,
        sets=sets,
        cells=_cells(found),
        uneven=largest_imbalance(found.table, found.universes.names()),
        nearly_all=NEARLY_ALL,
        surely=SURELY,
        support=SUPPORT,
        command=command,
        made=found.study.to_toml() + "\n" + json.dumps(provenance(), indent=2),
        files=inputs_of(directory),
    )
    tell()


def _cells(found: Multiverse) -> list[list[str]]:
    """Lifespans, survival and success of each cell over all universes."""
    rows = []
    for world, agent in CELLS:
        rows.append([f"{agent}, {world}"])
        for what, form in (("mean", ",.0f"), ("alive", ".1%"), ("success", ".1%")):
            values = column(found.table, f"{what}_{world}_{agent}")
            rows[-1].append(page.interval(mean(values[~np.isnan(values)]), form))
    return rows


def _drawings(found: Multiverse) -> dict[str, Callable[[], Figure]]:
    names = found.universes.names()
    drawings = {
        "verdicts": lambda: verdicts_figure(found.shares, WORDS),
        "points": lambda: points_figure(found.marginal, CLAIMS),
        "factors": lambda: factors_figure(found.marginal, GAINS),
        "causes": lambda: causes_figure(_causes(found)),
    }
    for effect, (claim, words, marks) in CURVES.items():
        drawings[f"curve_{effect}"] = lambda effect=effect, claim=claim, words=words, marks=marks: (
            specification_figure(found.table, names, effect, claim, label=words, marks=marks)
        )
    return drawings


def _write_tables(found: Multiverse, directory: Path) -> None:
    for name, table in (("universes", found.table), ("deaths", found.deaths)):
        with whole(directory / f"{name}.parquet") as path:
            pq.write_table(table, path)
    tables = {
        "shares": found.shares,
        "marginal_effects": found.marginal,
        "interactions": found.interactions,
        "cap": found.time_limit,
    }
    for name, table in tables.items():
        if table is not None:
            with whole(directory / f"{name}.csv") as path:
                csv.write_csv(table, path)
    sets = {
        claim: one and {
            "conditions": {c.reading: list(c.values) for c in one.conditions},
            "universes": one.universes,
            "share": one.share._asdict(),
            "confirmed": (fresh := found.confirmed.get(claim))
            and {
                "universes": fresh.universes,
                "share": fresh.share._asdict(),
                "verdict": fresh.verdict,
            },
        }
        for claim, one in found.found.items()
    }  # fmt: skip
    models = [_model(one) for one in found.predicted or ()]
    text = json.dumps({"smallest_sets": sets, "models": models}, indent=2) + "\n"
    write_whole(directory / "findings.json", text.encode())


def _model(one: Prediction) -> dict[str, object]:
    scores = {name: getattr(one, name)._asdict() for name in ("single", "pairs", "tree")}
    rules = [
        {"conditions": rule.conditions, "universes": rule.universes, "share": rule.share._asdict()}
        for rule in one.rules
    ]
    return {"claim": one.claim, "always": one.always, **scores, "rules": rules}


def _causes(found: Multiverse) -> dict[str, list[DeathCount]]:
    counts: dict[str, dict[tuple[str, str, str], int]] = {
        f"{agent}, {world}": {} for world, agent in CELLS
    }
    for row in found.deaths.to_pylist():
        way = (row["death_variable"] or ALIVE, row["death_side"] or "", row["death_cause"] or "")
        ways = counts[f"{row['agent']}, {row['world']}"]
        ways[way] = ways.get(way, 0) + row["lives"]
    return {
        cell: [DeathCount(*way, n, share(n, sum(ways.values()))) for way, n in ways.items()]
        for cell, ways in counts.items()
    }

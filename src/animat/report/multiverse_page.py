"""A multiverse as a directory: tables, figures and one page."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

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
from animat.report.inputs import inputs_sections
from animat.report.multiverse_tables import (
    WORDS,
    cap_table,
    cells_table,
    interactions_tables,
    left_out_table,
    readings_table,
    shares_table,
    smallest_table,
)
from animat.statistics.claims import CELLS, CLAIMS
from animat.statistics.estimates import share
from animat.statistics.predict import Foretold
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

FIGURES = {
    "verdicts": "In how many universes each claim holds, is undecided, or fails.",
    "points": (
        "By how many points each value of a reading changes the share of universes in which a"
        " claim holds. Grey on white: the 95 % interval has 0 in it. Blank: too few universes."
    ),
    "factors": (
        "By what factor each value changes the ratio of lifespans AF / BLIND, in the geometric mean"
        " over universes, with 95 % intervals. Grey: the interval has 1 in it."
    ),
    "curve_abundant_gain": (
        "Specification curve of the abundant gain. Above, every universe; below, the darker, the"
        " more of the universes there have taken that value. The dashed line is the paper's figure."
    ),
    "curve_scarce_gain": "The same of the scarce gain.",
    "causes": "How the lives of all universes ended.",
}


def publish(found: Multiverse, directory: Path, command: str, tell: Callable[[], None]) -> None:
    """Write tables, figures and the page into `directory`, which is there, over what is there.

    `tell` is called for each figure and for the page. Raises SettingsError if it cannot be written.
    """
    _write_tables(found, directory)
    pictures = {}
    for name, draw in _drawings(found).items():
        drawn, _ = save(draw(), directory / name)
        pictures[name] = page.picture_file(drawn, FIGURES[name], FIGURES[name])
        tell()
    page.write_page(
        directory / "report.html",
        "The multiverse of the paper",
        [*_sections(found, pictures, command), *inputs_sections(directory)],
        lead=[_lead(found)],
    )
    tell()


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
        "cap": found.cap,
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
    models = [_model(one) for one in found.foretold or ()]
    text = json.dumps({"smallest_sets": sets, "models": models}, indent=2) + "\n"
    write_whole(directory / "findings.json", text.encode())


def _model(one: Foretold) -> dict[str, object]:
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


def _lead(found: Multiverse) -> str:
    study = found.study
    assert study.teacher is not None
    return (
        f"The paper leaves much open. Here are {found.table.num_rows:,} universes, each with one"
        f" value for each of {len(found.universes.readings)} readings. In each,"
        f" {study.teacher.robots} robots learnt for {study.teacher.steps:,} steps, {study.lives:,}"
        f" lives were lived in each of the four cells of Experiment 2, up to {study.steps:,} steps,"
        " and the paper's seven claims were judged."
    )


def _sections(
    found: Multiverse, pictures: dict[str, page.Picture], command: str
) -> list[page.Section]:
    return [
        page.Section(
            "How often each claim holds",
            tables=[shares_table(found)],
            pictures=[pictures["verdicts"]],
        ),
        page.Section(
            "What each reading does",
            paragraphs=[
                "A value is compared with the first value of its reading, in the universes in which"
                " either was possible. Intervals are of each comparison alone; of the values"
                " that change nothing, about one in twenty has an interval that says otherwise."
                " marginal_effects.csv has all of them."
            ],
            pictures=[pictures["points"], pictures["factors"]],
        ),
        page.Section(
            "Specification curves", pictures=[pictures[f"curve_{effect}"] for effect in CURVES]
        ),
        page.Section("Which readings matter to each other", tables=interactions_tables(found)),
        page.Section(
            "The smallest sets of readings",
            paragraphs=[
                f"The fewest readings with which a claim holds in at least {NEARLY_ALL:.0%} of"
                f" universes here, and by its interval in more than {SURELY:.0%}, the others being"
                f" what they may; at least {SUPPORT} universes must meet them. Being the best of"
                " very many sets, it may still owe something to chance; so it is judged by fresh"
                " universes, with other layouts and other lives."
            ],
            tables=[smallest_table(found)],
        ),
        _cap(found),
        page.Section(
            "Lives and deaths", tables=[cells_table(found)], pictures=[pictures["causes"]]
        ),
        page.Section("The universes", tables=[readings_table(found), left_out_table(found)]),
        page.Section(
            "How this was made",
            paragraphs=[f"{command} makes the same again; it goes on where it was ended."],
            code=found.study.to_toml() + "\n" + json.dumps(provenance(), indent=2),
        ),
    ]


def _cap(found: Multiverse) -> page.Section:
    title = "What the cap does"
    if found.cap is None:
        return page.Section(title, paragraphs=["No universe was lived to a later cap."])
    first = found.cap.column("universes")[0].as_py()
    told = (
        f"The first {first:,} universes, lived to {found.study.steps:,} steps and to a later cap."
    )
    return page.Section(title, paragraphs=[told], tables=[cap_table(found.cap)])

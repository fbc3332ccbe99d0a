"""The report on a results directory: one page, from the tables and from what they were made by."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from animat.figures.learning import learning_curve_figure
from animat.files.settings import SettingsError, nearest
from animat.progress import Telling
from animat.report.inputs import inputs_of
from animat.report.methods import model_words, representatives, statistics_words
from animat.report.page import Picture, Section, TableBlock, interval, is_page, picture, write_page
from animat.report.question import asked_section
from animat.report.readings_taken import readings
from animat.report.run_details import how_run_section, notices
from animat.report.sections import in_short, result_sections
from animat.statistics.estimates import mean
from animat.statistics.findings import Findings, find
from animat.statistics.lives import column
from animat.study.file.cases import Case, cases
from animat.study.store.results import Progress, Results

PAGE = "report.html"

NOTHING_YET = "No life is finished yet, or none without an error: there is nothing to report."

CURVES_AT_MOST = 4
"""Cases that each have a figure of how their networks learnt."""

READINGS_AT_MOST = 4
"""Readings of one point that are listed where cases differ."""

LARGE = {"identity", "robot", "weights"}
"""Columns of lives that a report has no use for."""


def write_report(
    results: Results, out: Path | None, by: Sequence[str] | None, tell: Telling
) -> tuple[Path, list[str]]:
    """Write the page, and return where it is and the short of it, a line each.

    `by` names the factors that are told of, all unless given. Raises SettingsError for factors that
    the design has not, and for an `out` that is there and is no page of animat.
    """
    path = out or results.directory / PAGE
    _refuse(results, path, by)
    tell("Report", 0, 3)
    lives, failed = _lives(results)
    progress = _progress(results, lives, failed)
    laid_out = cases(results.study)
    tell("Report", 1, 3)
    found = _found(results, lives, by)
    tell("Report", 1, 3)
    short = in_short(found) if found else [NOTHING_YET]
    inputs = inputs_of(results.directory)
    sections = [
        asked_section(results.study, laid_out),
        how_run_section(results, progress, failed),
        *(result_sections(found) if found else []),
        *_learnt_sections(results),
        _methods_section(results, laid_out, found),
        _readings_section(laid_out),
        Section(
            "The study file",
            [
                "With every setting written out. The same engine makes the same lives of it again"
                f" (animat run){', given the files below' if inputs.digests else ''}."
            ],
            code=results.text,
        ),
    ]
    told = notices(progress, failed)
    write_page(
        path,
        title=f"Study: {results.study.name}",
        sections=sections,
        lead=short,
        notices=told,
        files=inputs,
    )
    tell("Report", 1, 3)
    return path, [*told, *short]


def _refuse(results: Results, path: Path, by: Sequence[str] | None) -> None:
    problems = [
        f'--by "{name}": is no factor of the design{nearest(name, results.factors)}'
        for name in by or ()
        if name not in results.factors
    ]
    if path.is_dir():
        problems.append(f"{path}: is a directory; give the name of a file")
    elif path.exists() and not is_page(path):
        problems.append(f"{path}: is there already and is no page of animat; give another name")
    if problems:
        raise SettingsError(*problems)


def _lives(results: Results) -> tuple[pa.Table, pa.Table]:
    """Return the lives that did not fail, with `same_as` of their case, and those that failed."""
    there = ["case", *results.factors]
    there += [n for n in results.dataset().schema.names if n not in {*there, *LARGE}]
    lives = results.lives(there)
    same = results.cases["same_as"].combine_chunks()
    lives = lives.append_column("same_as", same.take(lives["case"].combine_chunks()))
    failed = pc.field("error").is_valid()
    return lives.filter(~failed), lives.filter(failed)


def _progress(results: Results, *lives: pa.Table) -> Progress:
    """Return how far a study was when its lives were read; cases of equal lives count once."""
    own = [table.filter(pc.field("case") == pc.field("same_as")).num_rows for table in lives]
    return Progress(sum(own), results.numbering["lives"].total)


def _found(results: Results, lives: pa.Table, by: Sequence[str] | None) -> Findings | None:
    if not lives.num_rows:
        return None
    measures = [
        name
        for name in lives.column_names
        if name.startswith("likelihood_") and lives[name].null_count < lives.num_rows
    ]
    return find(lives, results.factors, by=by, measures=measures)


def _learnt_sections(results: Results) -> list[Section]:
    teachers = results.teachers()
    if teachers.num_rows:
        teachers = teachers.filter(pc.field("error").is_null())
    section = learnt_section(teachers, _curves(results))
    return [section] if section else []


def _curves(results: Results) -> dict[str, pa.Table]:
    """Return learning curves by what they are of: each case, where they are few."""
    study = results.study
    if "learning_curve" not in study.measures:
        return {}
    table = results.curves()
    if not table.num_rows:
        return {}
    # The figure tells robots apart by one number.
    robot = table["case"].to_numpy() * study.lives + table["life"].to_numpy()
    table = table.append_column("seed", pa.array(robot))
    if results.cases.num_rows > CURVES_AT_MOST:
        return {"all cases": table}
    told = {}
    for row in results.cases.to_pylist():
        name = ", ".join(f"{factor} = {row[factor]}" for factor in results.factors) or "all lives"
        part = table.filter(pc.field("case") == row["case"])
        if part.num_rows:
            told[name] = part
    return told


def _methods_section(results: Results, laid_out: Sequence[Case], found: Findings | None) -> Section:
    versions = results.manifest["runs"][0]["versions"]
    told = model_words(laid_out, versions, results.manifest["engine"])
    if found:
        import scipy

        told += statistics_words(found, scipy.__version__)
    return Section(
        "Methods and citation",
        [*told, "To cite the paper and animat:"],
        code=bibtex(versions["animat"]),
    )


def _readings_section(laid_out: Sequence[Case]) -> Section:
    """What the paper leaves open, and how each point was settled, in some case or in all."""
    taken: dict[str, tuple[str, dict[str, None], dict[str, None]]] = {}
    for case in representatives(laid_out):
        for point, setting, reading in readings(case.settings.mind, case.settings.robot):
            _, settings, seen = taken.setdefault(point, (point, {}, {}))
            settings[setting] = None
            seen[reading] = None
    rows = [(point, _either(settings), _either(seen)) for point, settings, seen in taken.values()]
    return Section(
        "The readings taken",
        tables=[TableBlock(("What the paper leaves open", "Setting", "Reading taken"), rows)],
    )


def _either(texts: Collection[str]) -> str:
    if len(texts) > READINGS_AT_MOST:
        return "differs between cases, as asked"
    return "; or ".join(texts)


PREFIX = "likelihood_"


def learnt_section(teachers: pa.Table | None, curves: Mapping[str, pa.Table]) -> Section | None:
    """What robots had learnt before the lives began, and how the networks of lives came to know.

    `teachers` has a row for each robot, with a column likelihood_NETWORK_OBJECT for each network
    and object type; `curves` are tables as in `learning_curve_figure`, by what they are of. None
    if there is nothing to tell.
    """
    tables = [_robots(teachers)] if teachers is not None and teachers.num_rows else []
    pictures = [_curve(name, table) for name, table in curves.items()]
    if not tables and not pictures:
        return None
    return Section("What the networks learnt", tables=tables, pictures=pictures)


def _robots(teachers: pa.Table) -> TableBlock:
    rows = []
    for name in teachers.column_names:
        if name.startswith(PREFIX):
            network, _, thing = name.removeprefix(PREFIX).rpartition("_")
            values = column(teachers, name).astype(np.float64)
            known = values[~np.isnan(values)]
            if len(known):
                rows.append((network, thing, interval(mean(known), ".2f")))
    return TableBlock(
        ("Network", "Object", "Mean likelihood"),
        rows,
        f"The {teachers.num_rows:,} robots whose networks AF has, after their training.",
        title="Training robots",
    )


def _curve(name: str, table: pa.Table) -> Picture:
    return picture(
        learning_curve_figure(table),
        f"What the networks say of each object type, over the acts each has learnt from; mean and"
        f" the middle 90 % of lives ({name}).",
        f"Likelihood against episodes, {name}",
    )


PAPER = """\
@misc{cosaguilera2003motivation,
  author = {Cos-Aguilera, I. and Ca{\\~n}amero, Lola and Hayes, G. M.},
  title  = {Motivation-Driven Learning of Object Affordances: First Experiments Using a
            Simulated {Khepera} Robot},
  year   = {2003}
}
"""

ANIMAT = """\
@software{{animat,
  author  = {{{{animat contributors}}}},
  title   = {{animat: a laboratory for motivated robots}},
  version = {{{version}}},
  license = {{MIT}}
}}
"""


def bibtex(version: str) -> str:
    """The paper, and animat of a version."""
    return PAPER + "\n" + ANIMAT.format(version=version)

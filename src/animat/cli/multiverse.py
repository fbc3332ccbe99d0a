"""`animat multiverse`."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from animat.cli.app import DONE, INTERRUPTED, app
from animat.cli.options import Debug, Out, Quick, Set, StudyFile, Threads

if TYPE_CHECKING:
    from animat.experiments.multiverse import Multiverse
    from animat.study.file.study import Study

QUICK = (
    "lives=10",
    "steps=5_000",
    "teacher.robots=3",
    "teacher.steps=30_000",
    "design.sample.points=128",
)

CONFIRMED_QUICKLY = 60


@app.command()
def multiverse(
    study: StudyFile = "multiverse",
    universes: Annotated[
        int | None, typer.Option(help="About how many universes; 1,922 unless given.", min=1)
    ] = None,
    full: Annotated[
        bool, typer.Option("--full", help="Every combination of readings: for a cluster.")
    ] = False,
    out: Out = None,
    changes: Set = None,
    threads: Threads = None,
    quick: Quick = False,
    debug: Debug = False,
) -> int:
    """Run every reading of the paper, and report which of them its claims need.

    A finished directory is analysed again; an unfinished one is resumed.
    """
    from animat.experiments.multiverse import InterruptedStudyError, Size, run_multiverse
    from animat.experiments.multiverse_designs import of_size
    from animat.experiments.universes import readings_of
    from animat.files.provenance import provenance
    from animat.progress import telling
    from animat.report.multiverse_page import FIGURES, publish
    from animat.study.execute.run import threads as workers_of
    from animat.study.file.builtin import study_file
    from animat.study.file.read import read_study

    asked = read_study(study_file(study), [*(QUICK if quick else ()), *(changes or ())])
    readings_of(asked)
    if universes is not None:
        asked = of_size(asked, universes)
    directory = out or Path("results") / asked.name
    size = Size(confirming=CONFIRMED_QUICKLY, longer=0) if quick else Size()
    if not full:
        _say_what(asked, directory)
    started = time.monotonic()
    try:
        with telling() as tell, workers_of(threads) as workers:
            found = run_multiverse(asked, directory, size, workers, tell, full=full)
            command = str(provenance()["command"])
            publish(
                found, directory, command, lambda: tell("Figures and page", 1, len(FIGURES) + 1)
            )
    except InterruptedStudyError as error:
        print(f"animat: interrupted; the same command resumes {error}", file=sys.stderr)
        return INTERRUPTED
    _print(found)
    print(f"{time.monotonic() - started:.0f} s; open {directory / 'report.html'}")
    return DONE


def _say_what(asked: Study, directory: Path) -> None:
    from animat.experiments.multiverse_designs import count
    from animat.experiments.universes import readings_of
    from animat.statistics.claims import CELLS
    from animat.study.file.cases import excluded

    print(
        f"{asked.name}: {count(asked):,} universes of {len(readings_of(asked))} readings,"
        f" {asked.lives:,} lives a cell; results in {directory}"
    )
    for rule in excluded(asked):
        print(f"left out, {rule.count // len(CELLS):,} universes: {rule.why}")
    sys.stdout.flush()


def _print(found: Multiverse) -> None:
    """Print the shares of the claims, and the smallest sets."""
    from rich.console import Console
    from rich.table import Table

    from animat.cli.reproduce import PRINTED_WIDTH
    from animat.report.multiverse_tables import sets_table, shares_table

    console = Console(width=None if sys.stdout.isatty() else PRINTED_WIDTH)
    if found.missing:
        print(f"{found.missing:,} universes are left out: a life or a robot of them failed")
    for block in (shares_table(found), sets_table(found)):
        table = Table(*block.columns)
        for row in block.rows:
            table.add_row(*row)
        console.print(table)

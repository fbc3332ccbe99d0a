"""`animat multiverse`."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from animat.cli.app import DONE, FAILED, INTERRUPTED, app
from animat.cli.options import Debug, compiling_told

if TYPE_CHECKING:
    from animat.study.multiverse.run import Multiverse

QUICK = ("lives=10", "steps=5_000", "teacher.robots=3", "teacher.steps=30_000")
QUICK_UNIVERSES = 60


@app.command()
def multiverse(
    study: Annotated[
        str, typer.Argument(help="The study: a .toml file, or the one that comes with animat.")
    ] = "multiverse",
    universes: Annotated[
        int | None, typer.Option(help="About how many universes; 1,922 unless given.", min=1)
    ] = None,
    full: Annotated[
        bool, typer.Option("--full", help="Every combination of readings: for a cluster.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option(help="The directory; results/NAME unless given.")
    ] = None,
    set_: Annotated[
        list[str] | None, typer.Option("--set", help="Another value for a key: KEY=VALUE.")
    ] = None,
    threads: Annotated[
        int | None, typer.Option(help="Threads; as many as cores unless given.", min=1)
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Small, for a look.")] = False,
    debug: Debug = False,
) -> int:
    """Live every reading of the paper, and say which of them its claims need.

    A directory that is finished is analysed again; one that is not is gone on with.
    """
    from animat.progress import telling
    from animat.study.lock import HeldError
    from animat.study.multiverse.designs import of_size
    from animat.study.multiverse.page import FIGURES, publish
    from animat.study.multiverse.run import InterruptedStudyError, Size, run_multiverse
    from animat.study.multiverse.universes import readings_of
    from animat.study.provenance import provenance
    from animat.study.run import threads as workers_of
    from animat.study.shipped import study_file
    from animat.study.store import StoreError
    from animat.study.study import read_study

    asked = read_study(study_file(study), [*(QUICK if quick else ()), *(set_ or ())])
    readings_of(asked)
    wanted = universes or (QUICK_UNIVERSES if quick else None)
    if wanted is not None:
        asked = of_size(asked, wanted)
    directory = out or Path("results") / asked.name
    size = Size(confirming=QUICK_UNIVERSES, longer=0) if quick else Size()
    started = time.monotonic()
    try:
        with compiling_told(), telling() as tell, workers_of(threads) as workers:
            found = run_multiverse(asked, directory, size, workers, tell, full=full)
            command = str(provenance()["command"])
            publish(
                found, directory, command, lambda: tell("Figures and page", 1, len(FIGURES) + 1)
            )
    except InterruptedStudyError as error:
        print(f"animat: interrupted; the same command goes on with {error}", file=sys.stderr)
        return INTERRUPTED
    except (HeldError, StoreError) as error:
        print(f"animat: {error}", file=sys.stderr)
        return FAILED
    _print(found)
    print(f"{time.monotonic() - started:.0f} s; open {directory / 'report.html'}")
    return DONE


def _print(found: Multiverse) -> None:
    """Print what was left out, the shares of the claims, and the smallest sets."""
    from rich.console import Console
    from rich.table import Table

    from animat.cli.reproduce import PRINTED_WIDTH
    from animat.study.multiverse.tables import left_out_table, shares_table, smallest_table

    console = Console(width=None if sys.stdout.isatty() else PRINTED_WIDTH)
    for count, why in left_out_table(found).rows:
        print(f"left out, {count} universes: {why}")
    for block in (shares_table(found), smallest_table(found)):
        table = Table(*block.columns)
        for row in block.rows:
            table.add_row(*(cell if isinstance(cell, str) else cell.verdict for cell in row))
        console.print(table)

"""`animat reproduce`."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from animat.cli.app import app
from animat.cli.options import CheckFunctions, Debug, Seed, SettingsFile, settings_of

if TYPE_CHECKING:
    from animat.experiments.reproduction import Reproduction

PRINTED_WIDTH = 120
"""Characters in a line of a table that is printed elsewhere than on a terminal."""


@app.command()
def reproduce(
    lives: Annotated[int | None, typer.Option(help="Lives in each of the four cells.")] = None,
    seeds: Annotated[int | None, typer.Option(help="Robots of Experiment 1.")] = None,
    steps: Annotated[int | None, typer.Option(help="The cap of a life, in steps.")] = None,
    physiology: Annotated[
        str | None, typer.Option(help="excess (default), decay, relax or linear.")
    ] = None,
    seed: Seed = 0,
    out: Annotated[Path, typer.Option(help="The directory to write.")] = Path(
        "results/reproduction"
    ),
    settings: SettingsFile = None,
    quick: Annotated[bool, typer.Option("--quick", help="Small, under 15 s; for a look.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an earlier result.")] = False,
    check_functions: CheckFunctions = False,
    debug: Debug = False,
) -> None:
    """Run both experiments of the paper and judge its claims."""
    from animat.experiments.reproduction import QUICK, Size, check
    from animat.experiments.reproduction import reproduce as run
    from animat.progress import telling
    from animat.report.reproduction_page import FIGURES, publish
    from animat.study.store.atomic_directory import fresh_directory

    size = QUICK if quick else Size()
    given = {"lives": lives, "robots": seeds, "steps": steps}
    size = size._replace(**{name: value for name, value in given.items() if value is not None})
    chosen = settings_of(settings, physiology=physiology)
    check(chosen, seed, size)
    started = time.monotonic()
    with fresh_directory(out, force=force) as directory, telling() as tell:
        with kept_told(directory):
            result = run(
                chosen,
                seed=seed,
                size=size,
                directory=directory,
                tell=tell,
                anew=force,
                check_functions=check_functions,
            )
        publish(result, directory, lambda: tell("Figures and page", 1, len(FIGURES) + 1))
    _print_result(result)
    print(f"{time.monotonic() - started:.0f} s; open {out / 'report.html'}")


@contextmanager
def kept_told(directory: Path) -> Iterator[None]:
    """Say after an interruption where that is which is finished."""
    try:
        yield
    except KeyboardInterrupt:
        kept = f"finished work is stored in {directory}; the same command resumes it"
        print(f"animat: {kept}", file=sys.stderr)
        raise


def _print_result(result: Reproduction) -> None:
    """Print the tables of the claims and of the four cells."""
    from rich.console import Console
    from rich.table import Table

    from animat.report.page import interval
    from animat.statistics.estimates import Estimate

    console = Console(width=None if sys.stdout.isatty() else PRINTED_WIDTH)
    claims = Table("", "claim", "paper", "here (95 % interval)", "verdict")
    for claim in result.claims:
        ours = interval(Estimate(claim.ours, claim.low, claim.high), ".2f")
        claims.add_row(claim.id, claim.text, claim.paper, ours, claim.verdict)
    cells = Table("world", "agent", "lives", "mean lifespan", "the paper's 20", "acts succeed")
    for summary, papers in zip(result.summaries, result.papers, strict=True):
        cells.add_row(
            *summary.cell,
            f"{summary.lives:,}",
            interval(summary.mean, ",.0f"),
            interval(papers.mean, ",.0f"),
            interval(summary.success_rate, ".0%"),
        )
    console.print(claims)
    console.print(cells)

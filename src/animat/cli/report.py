"""`animat report`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from animat.cli.app import app
from animat.cli.options import Debug, ResultsDirectory


@app.command()
def report(
    directory: ResultsDirectory,
    by: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FACTOR", help="A factor to tell of, all unless given; again for more."
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="The page to write; DIR/report.html unless given.")
    ] = None,
    debug: Debug = False,
) -> None:
    """Write one page on a study: what was asked, how it was run, what came out."""
    from animat.progress import telling
    from animat.report.study_page import write_report
    from animat.study.store.results import open as open_results

    results = open_results(directory)
    with telling() as tell:
        path, short = write_report(results, out, by, tell)
    for line in short:
        print(line)
    print(f"open {path}")

"""`animat export`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from animat.cli.app import app
from animat.cli.options import Debug, ResultsDirectory


@app.command()
def export(
    directory: ResultsDirectory,
    to: Annotated[str, typer.Option(help="csv, parquet or nc (NetCDF).")],
    out: Annotated[Path, typer.Option(help="The file to write.")],
    force: Annotated[bool, typer.Option("--force", help="Replace the file.")] = False,
    debug: Debug = False,
) -> None:
    """Write the lives of a study, with the factors of their cases, as one file."""
    from animat.study.store.export import export as write
    from animat.study.store.results import open as open_results

    rows = write(open_results(directory), to, out, force=force)
    print(f"{rows:,} lives are in {out}")

"""`animat new`."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

import typer

from animat.cli.app import app
from animat.cli.options import Debug


@app.command()
def new(
    file: Annotated[Path, typer.Argument(help="The study file to write, as lifespan.toml.")],
    force: Annotated[bool, typer.Option("--force", help="Replace the file.")] = False,
    debug: Debug = False,
) -> None:
    """Write a study file to start from: small, with a comment on every line that matters."""
    from animat.study.file.builtin import write_starter

    write_starter(file, force=force)
    print(f"{file} is written; {shlex.join(['animat', 'check', str(file)])} says what it would run")

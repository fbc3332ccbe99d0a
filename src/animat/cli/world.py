"""`animat world`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from animat.cli.app import app
from animat.cli.options import Debug


@app.command()
def world(
    file: Annotated[
        str, typer.Argument(metavar="WORLD", help="A world's .toml file, abundant or scarce.")
    ],
    figure: Annotated[
        Path | None, typer.Option(help="Draw the world to this .svg, .png or .pdf file.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the file.")] = False,
    debug: Debug = False,
) -> None:
    """Show a world before anyone lives in it, with hints at likely slips."""
    from rich.console import Console
    from rich.table import Table

    from animat.cli.one_world import draw, look, table
    from animat.files.settings import SettingsError

    seen = look(file)
    arena = seen.file.arena
    print(f"{seen.file.name}: arena of {arena.width:g} x {arena.height:g} mm")
    shown = Table("type", "mm", "objects", "spares", "affords")
    for row in table(seen.file):
        shown.add_row(*row)
    width = None if sys.stdout.isatty() else 120
    Console(width=width, markup=False, emoji=False, highlight=False).print(shown)
    if seen.room is not None:
        whole = arena.width * arena.height / 1e6
        print(
            f"free: {seen.room.free:.3f} of {whole:.3f} m²;"
            f" the centre of a robot has {seen.room.roomy:.3f} m²"
        )
    for hint in seen.hints:
        print(f"hint: {hint}")
    if figure is not None:
        draw(seen.file, figure, force=force)
    if seen.problems:
        raise SettingsError(*seen.problems)

"""`animat life`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from animat.cli.app import app
from animat.cli.options import Debug, Seed, SettingsFile, compiling_told, settings_of


@app.command()
def life(
    world: Annotated[
        str | None, typer.Option(help="abundant (default), scarce, or a world's .toml file.")
    ] = None,
    agent: Annotated[
        str | None, typer.Option(help="BLIND (default), AF, LEARNING, ORACLE or RANDOM.")
    ] = None,
    physiology: Annotated[
        str | None, typer.Option(help="excess (default), decay, relax or linear.")
    ] = None,
    seed: Seed = 0,
    index: Annotated[
        int, typer.Option("--life", help="Which life of the seed.", min=0, max=2**63 - 1)
    ] = 0,
    steps: Annotated[int, typer.Option(help="The cap of the life, in steps.")] = 300_000,
    settings: SettingsFile = None,
    trace: Annotated[
        Path | None, typer.Option(help="Write the trace to this .parquet file.")
    ] = None,
    figure: Annotated[
        Path | None, typer.Option(help="Draw the life to this .svg, .png or .pdf file.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace these files.")] = False,
    debug: Debug = False,
) -> None:
    """Live one life, and say how it went and why it ended."""
    from animat.progress import telling
    from animat.study.one_life import OneLife, live_one, story

    chosen = settings_of(settings, physiology=physiology, agent=agent, world=world)
    asked = OneLife(chosen, seed, index, steps, trace, figure, force)
    with compiling_told(), telling() as tell:
        lived = live_one(asked, tell)
    for line in story(lived):
        print(line)

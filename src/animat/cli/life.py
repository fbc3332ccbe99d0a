"""`animat life`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from animat.cli.app import app
from animat.cli.options import CheckFunctions, Debug, Seed, Set, SettingsFile, settings_of

BY_RECORDING = {
    "world": "--world",
    "agent": "--agent",
    "physiology": "--physiology",
    "seed": "--seed",
    "index": "--life",
    "settings": "--settings",
    "changes": "--set",
    "networks": "--networks",
}
"""Options that say what a recording says."""


@app.command()
def life(
    context: typer.Context,
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
    steps: Annotated[
        int | None, typer.Option(help="The cap of the life, in steps; 300,000 unless given.")
    ] = None,
    settings: SettingsFile = None,
    changes: Set = None,
    networks: Annotated[
        Path | None, typer.Option(help="The .toml file of the networks it is born with.")
    ] = None,
    trace: Annotated[
        Path | None, typer.Option(help="Write the trace to this .parquet or .csv file.")
    ] = None,
    figure: Annotated[
        Path | None, typer.Option(help="Draw the life to this .svg, .png or .pdf file.")
    ] = None,
    save_networks: Annotated[
        Path | None, typer.Option(help="Write its networks at the end to this .toml file.")
    ] = None,
    record: Annotated[
        Path | None,
        typer.Option(help="Write a recording to this .parquet file; see animat replay."),
    ] = None,
    every: Annotated[
        int | None,
        typer.Option(help="Store the whole state in it every so many steps; 1,000 unless given."),
    ] = None,
    source: Annotated[
        Path | None, typer.Option("--from", help="Resume the life of this recording.")
    ] = None,
    at: Annotated[
        int | None,
        typer.Option(help="Resume after so many steps; after its last one unless given."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace these files.")] = False,
    check_functions: CheckFunctions = False,
    debug: Debug = False,
) -> None:
    """Simulate one life, and say how it went and why it ended."""
    from animat.cli.one_life import OneLife, live_one, story
    from animat.progress import telling

    _check_together(context)
    chosen = settings_of(settings, changes, physiology=physiology, agent=agent, world=world)
    asked = OneLife(
        chosen, seed, index, steps, trace, figure, force, record, every, source, at,
        check_functions, networks, save_networks,
    )  # fmt: skip
    with telling() as tell:
        lived = live_one(asked, tell)
    for line in story(lived):
        print(line)


def _check_together(context: typer.Context) -> None:
    """Refuse options that do not go together."""
    from animat.files.settings import SettingsError

    given = {
        name
        for name in context.params
        if getattr(context.get_parameter_source(name), "name", "") == "COMMANDLINE"
    }
    wrong = []
    if "every" in given and "record" not in given:
        wrong.append("--every is of a recording; give --record FILE with it")
    if "at" in given and "source" not in given:
        wrong.append("--at is a step of a recording; give --from FILE with it")
    if "source" in given:
        wrong += [
            f"{option} cannot go with --from: the recording says it"
            for name, option in BY_RECORDING.items()
            if name in given
        ]
    if wrong:
        raise SettingsError(*wrong)

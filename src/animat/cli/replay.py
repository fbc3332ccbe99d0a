"""`animat replay`."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from animat.cli.app import FAILED, app
from animat.cli.options import Debug

if TYPE_CHECKING:
    from animat.recording.divergence import Difference
    from animat.recording.recording import Recording


@app.command()
def replay(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="A recording, of animat life --record.")
    ],
    verify: Annotated[
        bool,
        typer.Option("--verify", help="Live the life again, and say where it differs, if it does."),
    ] = False,
    debug: Debug = False,
) -> None:
    """Show what a recording holds, or live its life again and compare."""
    from animat.progress import telling
    from animat.recording.recording import Recording

    recording = Recording.load(file)
    if not verify:
        for line in _shown(recording):
            print(line)
        return
    head = recording.head
    steps = head.last - head.first
    with telling() as tell:
        found = recording.verify(lambda more: tell("Life again, steps", more, steps))
    if found is not None:
        for line in _told(found):
            print(line)
        raise typer.Exit(FAILED)
    print(f"the same life: all {steps:,} steps and {head.moments:,} states agree")


def _shown(recording: Recording) -> list[str]:
    """Return in lines what a recording holds."""
    import tomli_w

    head = recording.head
    mind, world = head.mind, head.world
    made = head.made
    counts = Counter(site.type for site in world.objects)
    standing = ", ".join(f"{counts[kind.name]} {kind.name}" for kind in world.types)
    versions = ", ".join(f"{name} {each}" for name, each in made.get("versions", {}).items())
    lines = [
        f"{mind.agent} in {world.name}, physiology {mind.physiology}, seed {head.seed},"
        f" life {head.life}",
        f"steps {head.first:,} to {head.last - 1:,} of {head.steps:,} at most;"
        f" {f'died of {head.death}' if head.death else 'alive at the end'}",
        f"{head.moments:,} states, one every {head.every:,} steps;"
        f" digest at the end {head.end.digest}",
        f"world of {world.arena.width:g} x {world.arena.height:g} mm: {standing};"
        f" {len(world.spares)} spare sites",
        f"networks {'as trained before' if head.networks else 'untrained at birth'}",
        *(f"{role} {function}" for role, function in mind.own_functions().items()),
        f"made {made.get('made')} by {made.get('command')}",
        f"engine {head.engine}, {versions}",
    ]
    changed = {
        section: settings.model_dump(mode="json", exclude_defaults=True, exclude_none=True)
        for section, settings in (("robot", head.robot), ("mind", mind))
    }
    told = {section: settings for section, settings in changed.items() if settings}
    if told:
        lines += ["settings that are not the defaults:", "", *tomli_w.dumps(told).splitlines()]
    return lines


def _told(found: Difference) -> list[str]:
    """Return in lines where a life parts from its recording."""
    rows = [("", "recorded", "simulated again"), *found.fields]
    widths = [max(len(row[column]) for row in rows) for column in range(2)]
    return [
        f"another life: step {found.step:,} is the first that differs",
        *(f"  {name:<{widths[0]}}  {old:<{widths[1]}}  {new}" for name, old, new in rows),
    ]

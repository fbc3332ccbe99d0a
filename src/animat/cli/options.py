"""What several commands take."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from animat.study.file.settings import LifeSettings

SettingsFile = Annotated[
    Path | None,
    typer.Option("--settings", help="A TOML file with [mind] and [robot] settings."),
]
StudyFile = Annotated[
    str, typer.Argument(metavar="STUDY", help="A study file, or a study that comes with animat.")
]
Set = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change a line of the file; again for more."),
]
ResultsDirectory = Annotated[
    Path, typer.Argument(metavar="DIR", help="The results directory of a study.")
]
Out = Annotated[Path | None, typer.Option(help="The directory; results/NAME unless given.")]
Threads = Annotated[int | None, typer.Option(help="As many as cores unless given.", min=1)]
Quick = Annotated[bool, typer.Option("--quick", help="Small, for a look.")]
Seed = Annotated[int, typer.Option(help="The seed of everything random.", min=0, max=2**63 - 1)]

CheckFunctions = Annotated[
    bool,
    typer.Option("--check-functions", help="Check every index that custom functions use; slower."),
]

# Only declared: whoever explains an error looks for it, as an unknown option ends the reading.
Debug = Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")]


def settings_of(
    file: Path | None, changes: Sequence[str] | None = None, **given: str | None
) -> LifeSettings:
    """Return the settings of a file, if any, changed by what the command line gives.

    `changes` are those of --set. Raises SettingsError.
    """
    from pydantic import ValidationError

    from animat.files.settings import SettingsError, parse_toml, validated
    from animat.files.validation_errors import mistakes, written
    from animat.study.file.keys import UnknownKeyError, put
    from animat.study.file.overrides import led_by, override
    from animat.study.file.settings import LifeSettings

    data = {} if file is None else parse_toml(file)
    changed, problems = override(data, LifeSettings, changes or ())
    options = []
    for name, value in given.items():
        if value is None:
            continue
        key = ("world", "layout") if name == "world" else ("mind", name)
        if key in changed:
            problems.append(f"--set {written(key)}: --{name} sets it, too; give one of them")
        try:
            put(data, LifeSettings, key, value)
        except UnknownKeyError:
            continue  # the file has no table there, of which it is told below
        options.append(key)
    lines: list[str] = []
    try:
        settings = validated(data, LifeSettings)
    except ValidationError as error:
        lines = mistakes(error, LifeSettings)
    else:
        if not problems:
            return settings
    leads = [("--set", changed), ("command line", options)]
    where = str(file) if file is not None else "command line"
    raise SettingsError(*problems, *(f"{led_by(line, leads, where)}: {line}" for line in lines))

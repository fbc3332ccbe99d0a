"""What several commands take, and word of a compilation."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from animat.study.design.settings import LifeSettings

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


def settings_of(file: Path | None, **given: str | None) -> LifeSettings:
    """Return the settings of a file, if any, changed by what the command line gives."""
    from pydantic import ValidationError

    from animat.settings import explain, read_toml
    from animat.study.design.settings import LifeSettings

    settings = read_toml(file, LifeSettings) if file is not None else LifeSettings()
    chosen = {name: value for name, value in given.items() if value is not None}
    layout = chosen.pop("world", None)
    changes = {"mind": chosen} | ({} if layout is None else {"world": {"layout": layout}})
    merged = settings.model_dump(exclude_unset=True)
    for section, values in changes.items():
        merged[section] = {**merged.get(section, {}), **values}
    try:
        return LifeSettings.model_validate(merged, strict=False)
    except ValidationError as error:
        raise explain(error, LifeSettings, "command line") from None


@contextmanager
def compiling_told() -> Iterator[None]:
    """Say so on the error output if anything is compiled meanwhile."""
    from animat.numerics.compiled import announcing

    def tell() -> None:
        print("compiling the simulator, once, some 20 s ...", file=sys.stderr, flush=True)

    with announcing(tell):
        yield

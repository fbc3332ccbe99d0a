"""The command line: `animat reproduce`, `animat life`.

Exit codes: 0 done, 1 failed, 2 wrong usage or input, 130 interrupted. An error is one line for
each mistake; `--debug` shows where it came from.
"""

from __future__ import annotations

import os
import sys
import time
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

if TYPE_CHECKING:
    from animat.study.reproduction import Reproduction
    from animat.study.settings import StudySettings

app = typer.Typer(
    name="animat",
    help="A laboratory for motivated robots: reproduce the paper of 2003, live a life.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,  # to load rich would take most of the time of --help
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

DONE, FAILED, WRONG_INPUT, INTERRUPTED = 0, 1, 2, 130

PRINTED_WIDTH = 120
"""Characters in a line of a table that is printed elsewhere than on a terminal."""

SettingsFile = Annotated[
    Path | None,
    typer.Option("--settings", help="A TOML file with [mind] and [robot] settings."),
]
Seed = Annotated[int, typer.Option(help="The seed of everything random.", min=0, max=2**63 - 1)]

# Only declared: whoever explains an error looks for it, as an unknown option ends the reading.
Debug = Annotated[bool, typer.Option("--debug", help="Show the traceback of an error.")]


@app.callback()
def _animat(debug: Debug = False) -> None:
    """Read the options that go before every command."""


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
    debug: Debug = False,
) -> None:
    """Run both experiments of the paper and judge its claims."""
    from animat.progress import telling
    from animat.study.output import fresh_directory
    from animat.study.publication import FIGURES, publish
    from animat.study.reproduction import QUICK, Size, check
    from animat.study.reproduction import reproduce as run

    size = QUICK if quick else Size()
    given = {"lives": lives, "robots": seeds, "steps": steps}
    size = size._replace(**{name: value for name, value in given.items() if value is not None})
    chosen = _settings(settings, physiology=physiology)
    check(chosen, seed, size)
    started = time.monotonic()
    with fresh_directory(out, force=force) as directory, _compiling_told(), telling() as tell:
        result = run(chosen, seed=seed, size=size, tell=tell)
        publish(result, directory, lambda: tell("Figures and page", 1, len(FIGURES) + 1))
    _print_result(result)
    print(f"{time.monotonic() - started:.0f} s; open {out / 'report.html'}")


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

    chosen = _settings(settings, physiology=physiology, agent=agent, world=world)
    asked = OneLife(chosen, seed, index, steps, trace, figure, force)
    with _compiling_told(), telling() as tell:
        lived = live_one(asked, tell)
    for line in story(lived):
        print(line)


def _settings(file: Path | None, **given: str | None) -> StudySettings:
    """Return the settings of a file, if any, changed by what the command line gives."""
    from pydantic import ValidationError

    from animat.settings import explain, read_toml
    from animat.study.settings import StudySettings

    settings = read_toml(file, StudySettings) if file is not None else StudySettings()
    chosen = {name: value for name, value in given.items() if value is not None}
    layout = chosen.pop("world", None)
    changes = {"mind": chosen} | ({} if layout is None else {"world": {"layout": layout}})
    merged = settings.model_dump(exclude_unset=True)
    for section, values in changes.items():
        merged[section] = {**merged.get(section, {}), **values}
    try:
        return StudySettings.model_validate(merged, strict=False)
    except ValidationError as error:
        raise explain(error, StudySettings, "command line") from None


@contextmanager
def _compiling_told() -> Iterator[None]:
    from animat.numerics.compiled import announcing

    def tell() -> None:
        print("compiling the simulator, once, some 20 s ...", file=sys.stderr, flush=True)

    with announcing(tell):
        yield


def _print_result(result: Reproduction) -> None:
    """Print the tables of the claims and of the four cells."""
    from rich.console import Console
    from rich.table import Table

    from animat.report.estimates import Estimate
    from animat.report.page import interval

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


def main() -> None:
    """Run the command line and exit with its code."""
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")
    try:
        code = app(standalone_mode=False)
        sys.stdout.flush()
    except KeyboardInterrupt:
        code = INTERRUPTED
    except Exception as error:
        _explain(error)
    if code == INTERRUPTED:
        _leave("interrupted; nothing is half-written", INTERRUPTED)
    sys.exit(code if isinstance(code, int) else DONE)


def _explain(error: Exception) -> NoReturn:
    """Say what went wrong in a line for each mistake, and exit."""
    from animat.settings import SettingsError

    if "--debug" in sys.argv:
        traceback.print_exception(error)
    if isinstance(error, BrokenPipeError):
        _leave("", FAILED)
    if usage := getattr(error, "format_message", None):
        _leave(usage(), WRONG_INPUT)
    if isinstance(error, SettingsError):
        _leave(str(error), WRONG_INPUT)
    what = str(error)
    if isinstance(error, OSError) and error.filename:
        what = f"{error.filename}: {error.strerror}"
    what = " ".join(what.split())
    _leave(f"{type(error).__name__}: {what} (--debug shows where)", FAILED)


def _leave(text: str, code: int) -> NoReturn:
    for line in text.splitlines():
        print(f"animat: {line}", file=sys.stderr)
    try:
        sys.stdout.flush()
    except OSError:
        # Python would try once more at its end, and complain.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    sys.exit(code)

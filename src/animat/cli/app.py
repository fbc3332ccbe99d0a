"""The command itself: how it is called, how it ends, and what it says of what went wrong."""

from __future__ import annotations

import os
import sys
import threading
import traceback
import warnings
from typing import Annotated, NoReturn

import typer

from animat.cli.options import Debug
from animat.cli.streams import steady_streams, why_output_was_lost
from animat.version import __version__

app = typer.Typer(
    name="animat",
    help="A laboratory for motivated robots: reproduce the paper of 2003, study, live a life.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,  # to load rich would take most of the time of --help
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

KERNEL_THREAD = "animat"
"""The name of the threads of `animat.numerics.threads`, which may still be at work at the end."""

DONE, FAILED, WRONG_INPUT, INTERRUPTED = 0, 1, 2, 130


def _say_version(asked: bool) -> None:
    if asked:
        print(f"animat {__version__}")
        raise typer.Exit


@app.callback()
def _animat(
    debug: Debug = False,
    version: Annotated[
        bool,
        typer.Option(
            "--version", help="Say which version this is.", callback=_say_version, is_eager=True
        ),
    ] = False,
) -> None:
    """Read the options that go before every command."""


def main() -> None:
    """Run the command line and exit with its code."""
    steady_streams()
    _set_environment()
    try:
        _check_not_empty(sys.argv[1:])
        code = app(standalone_mode=False)
        if why := why_output_was_lost():
            _leave(f"the output cannot be written: {why}", FAILED)
    except KeyboardInterrupt:
        code = INTERRUPTED
    except Exception as error:
        _explain(error)
    if code == INTERRUPTED:
        _leave("interrupted; nothing is half-written", INTERRUPTED)
    sys.exit(code if isinstance(code, int) else DONE)


def _set_environment() -> None:
    """Keep variables that are meant for others from stopping a command."""
    os.environ["MPLBACKEND"] = "agg"  # nothing is shown
    os.environ.pop("NUMBA_NUM_THREADS", None)  # nothing is run on numba's threads
    # Numba warns, at length, of a variable of its own that it cannot read.
    warnings.filterwarnings("error", "Environment variable", RuntimeWarning)


def _check_not_empty(arguments: list[str]) -> None:
    """Refuse an empty argument: as a path it would be the working directory."""
    from animat.files.settings import SettingsError

    for before, argument in zip(["", *arguments], arguments, strict=False):
        option = argument or before
        if not argument or (argument.startswith("--") and argument.endswith("=")):
            name = f"{option.rstrip('=')}: " if option.startswith("-") else "an argument "
            raise SettingsError(f"{name}is empty")


def _explain(error: Exception) -> NoReturn:
    """Say what went wrong in a line for each mistake, and exit."""
    from animat.files.atomic import RunError
    from animat.files.settings import SettingsError

    if "--debug" in sys.argv:
        traceback.print_exception(error)
    if isinstance(error, RuntimeWarning):
        _leave(str(error).partition("\n")[0], WRONG_INPUT)
    if usage := getattr(error, "format_message", None):
        _leave(usage(), WRONG_INPUT)
    if isinstance(error, SettingsError):
        failed = type(error).__name__ == "FailedLifeError"  # its module takes Numba to import
        _leave(str(error), FAILED if failed else WRONG_INPUT)
    if isinstance(error, RunError):
        _leave(str(error), FAILED)
    what = str(error)
    if isinstance(error, OSError) and error.filename:
        what = f"{error.filename}: {error.strerror}"
    what = " ".join(what.split())
    _leave(f"{type(error).__name__}: {what} (--debug shows where)", FAILED)


def _leave(text: str, code: int) -> NoReturn:
    sys.stdout.flush()
    for line in text.splitlines():
        print(f"animat: {line}", file=sys.stderr)
    if code == INTERRUPTED and any(t.name == KERNEL_THREAD for t in threading.enumerate()):
        # Compiled code that never returns must not see Python taken down around it.
        sys.stderr.flush()
        os._exit(code)
    sys.exit(code)

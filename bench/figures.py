"""What the measuring programs share: targets, tables as text and as Markdown, and telling a run.

Times are of the processor where that can be had, because the clock also counts the time that other
programs took. What is compared is measured in turns, forwards and backwards, and the least of the
repeats is shown: whatever else runs on a machine only ever adds to a time.
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from animat.files.provenance import provenance

Key = TypeVar("Key")
Taken = TypeVar("Taken")

ROOT = Path(__file__).parents[1]

LARGE = 1000.0
"""From here on figures are shown as whole numbers, of three digits that count."""


class Target(NamedTuple):
    """A figure, what it ought to be, and whether more or less of it is better."""

    value: float
    limit: float
    at_least: bool

    @property
    def met(self) -> bool:
        """Whether the figure is what it ought to be."""
        return self.value >= self.limit if self.at_least else self.value <= self.limit

    def __str__(self) -> str:
        """Say what was asked for, and that it is met or how far it is."""
        asked = f"at {'least' if self.at_least else 'most'} {self.limit:g}"
        if self.met:
            return f"{asked}: met"
        far = f"{self.value:g}"
        if self.limit:
            far = f"{abs(self.value / self.limit - 1.0):.0%}"
        return f"{asked}: {far} too {'little' if self.at_least else 'much'}"


class Table(NamedTuple):
    """A table: a title, rows of one set of columns, and what must be known to read it."""

    title: str
    rows: list[dict[str, Any]]
    note: str = ""


def in_turns(measures: Mapping[Key, Callable[[], Taken]], repeat: int) -> dict[Key, list[Taken]]:
    """Call every measure `repeat` times, in turns, every other turn backwards."""
    taken: dict[Key, list[Taken]] = {key: [] for key in measures}
    for turn in range(repeat):
        for key in list(measures)[:: 1 if turn % 2 == 0 else -1]:
            taken[key].append(measures[key]())
    return taken


def cell(value: Any) -> str:
    """Return a value as a table shows it, floats to three digits."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, float):
        short = float(f"{value:.3g}")
        return f"{short:,.0f}" if abs(short) >= LARGE else f"{short:g}"
    return str(value)


def written(table: Table, markdown: bool) -> str:
    """Return a table with its title and note, as Markdown or aligned for a terminal."""
    columns = list(table.rows[0])
    lines = [columns, *([cell(row[column]) for column in columns] for row in table.rows)]
    numbers = [type(table.rows[0][column]) in (int, float) for column in columns]
    if markdown:
        bars = ["| " + " | ".join(line) + " |" for line in lines]
        rule = "|" + "|".join("---:" if number else "---" for number in numbers) + "|"
        body = [bars[0], rule, *bars[1:]]
    else:
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        body = [
            "  ".join(
                text.rjust(width) if number else text.ljust(width)
                for text, width, number in zip(line, widths, numbers, strict=True)
            ).rstrip()
            for line in lines
        ]
    title = f"### {table.title}" if markdown else table.title
    parts = [title, "\n".join(body), *([table.note] if table.note else [])]
    return "\n\n".join(parts) + "\n"


def run(
    doc: str | None, tables: Callable[[int, bool], Iterable[Callable[[], Table]]], repeat: int
) -> None:
    """Measure and print tables, as the command line asks; `doc` begins with what is measured.

    `tables(repeat, tiny)` gives a function for every table, called one after another.
    """
    parser = argparse.ArgumentParser(description=(doc or "").partition("\n")[0])
    parser.add_argument("--repeat", type=times, default=repeat, help="how often all is measured")
    add_output(parser)
    options = parser.parse_args()
    made = opened(options.markdown)
    for measure in tables(options.repeat, options.tiny):
        tell(measure(), made, options.markdown)
    closed(made, options.json)


def times(text: str) -> int:
    """Read a whole number of at least 1, for argparse."""
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("at least 1")
    return number


def add_output(parser: argparse.ArgumentParser) -> None:
    """Add the options that every measuring program has."""
    parser.add_argument("--json", type=Path, help="write the figures to this file as well")
    parser.add_argument("--markdown", action="store_true", help="print tables as Markdown")
    parser.add_argument(
        "--tiny", action="store_true", help="so little work that the figures mean nothing"
    )


def opened(markdown: bool) -> dict[str, Any]:
    """Print on what machine, with what and by which command this is measured, and return it."""
    made = provenance() | {"command": command()}
    if hasattr(os, "getloadavg"):
        made["load at the start"] = [round(load, 2) for load in os.getloadavg()]
    lines = []
    for key, value in made.items():
        told = str(value).strip("[]")
        if isinstance(value, dict):
            told = ", ".join(f"{name} {part}" for name, part in value.items())
        lines.append(f"{'* ' * markdown}{key}: {told}")
    print("\n".join(lines) + "\n", flush=True)
    return made


def command() -> str:
    """Return what to type in the root of the project to measure this again."""
    program = Path(sys.argv[0]).resolve()
    arguments = sys.argv[1:]
    if "--json" in arguments:
        at = arguments.index("--json")
        del arguments[at : at + 2]
    if program.is_relative_to(ROOT):
        program = program.relative_to(ROOT)
    return shlex.join(["python", str(program), *arguments])


def tell(table: Table, made: dict[str, Any], markdown: bool) -> None:
    """Print a table, and put it among what was made."""
    print(written(table, markdown), flush=True)
    rows = [{name: _plain(value) for name, value in row.items()} for row in table.rows]
    made.setdefault("tables", []).append({"title": table.title, "note": table.note, "rows": rows})


def closed(made: dict[str, Any], file: Path | None) -> None:
    """Write what was made as JSON, if a file is given."""
    if file:
        file.write_text(json.dumps(made, indent=2) + "\n", encoding="utf-8")


def _plain(value: Any) -> Any:
    """Return a value as JSON has it."""
    return {**value._asdict(), "met": value.met} if isinstance(value, Target) else value

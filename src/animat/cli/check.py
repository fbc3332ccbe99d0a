"""`animat check`."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from animat.cli.app import app
from animat.cli.options import Debug, Set, StudyFile

if TYPE_CHECKING:
    from rich.table import Table

    from animat.study.file.cases import Case
    from animat.study.file.factors import Scalar
    from animat.study.plan.cost import Expectation, Range

PRINTED_WIDTH = 120
"""Characters in a line of a table that is printed elsewhere than on a terminal."""

FIRST, LAST = 12, 4
"""Cases that are shown of many."""

COLUMNS = 6
"""Factors that have a column each; more are told in one."""


@app.command()
def check(study: StudyFile, changes: Set = None, debug: Debug = False) -> None:
    """Say what a study would run, and what that would cost, without running it."""
    from rich.console import Console

    from animat.study.file.builtin import study_file
    from animat.study.file.cases import excluded
    from animat.study.file.read import read_study
    from animat.study.plan.cost import expect
    from animat.study.plan.plan import Plan
    from animat.study.plan.preflight import check_livable

    path = study_file(study)
    asked = read_study(path, changes or ())
    left_out = excluded(asked)
    plan = Plan(asked)
    check_livable(plan)
    expected = expect(plan)
    cases = "1 case" if len(plan.cases) == 1 else f"{len(plan.cases):,} cases"
    print(f"{asked.name} ({path}): {cases}, {asked.lives:,} lives each")
    if any(case.factors for case in plan.cases):
        width = None if sys.stdout.isatty() else PRINTED_WIDTH
        console = Console(width=width, markup=False, emoji=False, highlight=False)
        console.print(_table(plan.cases))
    for rule in left_out:
        print(f"left out: {rule.count:,} combinations: {rule.why}")
    if again := len(plan.cases) - len(plan.lived):
        print(f"simulated once: {again:,} cases have the same lives as others")
    for line in _costs(expected):
        print(line)


def _table(cases: Sequence[Case]) -> Table:
    """Return the cases as a table, of many only the first and the last ones."""
    from rich.table import Table

    from animat.study.file.factors import identity

    names = list(dict.fromkeys(name for case in cases for name in case.factors))
    in_columns = len(names) <= COLUMNS
    table = Table("case", *(names if in_columns else ["what it is"]))
    shown = cases if len(cases) <= FIRST + LAST else [*cases[:FIRST], *cases[-LAST:]]
    said = {
        name: _said([case.factors[name] for case in shown if name in case.factors])
        for name in names
    }
    for place, case in enumerate(shown):
        if place == FIRST and len(shown) < len(cases):
            table.add_row("...")
        told = {
            name: said[name].get(identity(value), str(value))
            for name, value in case.factors.items()
        }
        if in_columns:
            table.add_row(str(case.number), *(told.get(name, "") for name in names))
        else:
            each = ", ".join(f"{name} = {told[name]}" for name in names if name in told)
            table.add_row(str(case.number), each)
    return table


def _said(values: Sequence[Scalar]) -> dict[tuple[bool, Scalar], str]:
    """Return the numbers among values in words that tell them apart."""
    from animat.statistics.numerals import numerals

    numbers = [v for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
    return {(False, number): said for number, said in numerals(numbers).items()}


def _costs(expected: Expectation) -> list[str]:
    from animat.study.plan.cost import STEPS

    learning = ""
    if expected.robots:
        learning = (
            f", and {expected.learning_steps:,} steps of {expected.robots:,} robots that learn"
        )
    traces = ""
    if expected.trace_bytes.high:
        traces = f", {_from_to(expected.trace_bytes, _size)} of traces"
    cases = "1 case" if expected.measured_cases == 1 else f"{expected.measured_cases} cases"
    lines = [
        f"at most: {expected.most_steps:,} steps of {expected.lives:,} lives{learning}",
        f"expected: {_from_to(expected.seconds, _words)} on the {os.cpu_count()} cores here,"
        f" {_size(expected.tables_bytes)} of tables{traces}",
        f"estimated from {expected.measured_lives:,} lives of {cases}, up to {STEPS:,} steps each",
    ]
    if expected.seconds.low < expected.seconds.high:
        lines[-1] += "; the larger figures let all who were alive then live to the cap"
    if expected.errors:
        failed, lives = len(expected.errors), expected.measured_lives
        lines.append(f"{failed:,} of these {lives:,} lives fail, such as: {expected.errors[0]}")
    return lines


def _from_to(ends: Range, told: Callable[[float], str]) -> str:
    low, high = map(told, ends)
    return low if low == high else f"{low} to {high}"


def _words(seconds: float) -> str:
    from animat.progress import in_words

    return in_words(max(1.0, seconds))


def _size(count: float) -> str:
    for unit, length in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count >= length:
            return f"{count / length:,.1f} {unit}"
    return f"{count:.0f} bytes"

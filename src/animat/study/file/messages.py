"""How mistakes that cases share are told: once, with the cases that have it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from animat.files.validation_errors import shown
from animat.study.file.factors import Scalar, identity

MOST_LINES = 20
"""Mistakes that are told one by one."""


def told(lines: Iterable[str]) -> list[str]:
    """Return lines of mistakes, each once, and of very many only the first."""
    found = list(dict.fromkeys(lines))
    if len(found) <= MOST_LINES:
        return found
    return [*found[:MOST_LINES], f"... and {len(found) - MOST_LINES:,} mistakes more"]


class InCases(NamedTuple):
    """In how many cases a mistake is, the factors of the first, and what they all have alike."""

    count: int
    first: Mapping[str, Scalar]
    alike: Mapping[str, Scalar]

    def and_in(self, factors: Mapping[str, Scalar]) -> InCases:
        """Return this with one case more."""
        alike = {
            name: value
            for name, value in self.alike.items()
            if name in factors and identity(factors[name]) == identity(value)
        }
        return InCases(self.count + 1, self.first, alike)

    def told(self, line: str, cases: int) -> str:
        """Return the line of the mistake, led by those of so many cases that have it."""
        count, first, alike = self
        if count == cases:
            return line
        which = "cases such as" if count > 1 and not alike else "where"
        return f"{which} {_listed(alike or first)} ({count:,} of {cases:,} cases): {line}"


def _listed(factors: Mapping[str, Scalar]) -> str:
    return ", ".join(f"{name}{shown(value)}" for name, value in factors.items())

"""The errors of animat: all are kinds of `Error`, and each says in a line what is wrong."""

from __future__ import annotations


class Error(Exception):
    """Something that animat cannot do; `str` gives a line for each of its `problems`."""

    def __init__(self, *problems: str) -> None:
        """Keep the problems, one line each."""
        self.problems = tuple(printable(problem) for problem in problems)
        super().__init__(*self.problems)

    def __str__(self) -> str:
        """Return the problems, one line each."""
        return "\n".join(self.problems)


class SettingsError(Error, ValueError):
    """Everything that is wrong with what a user gave: settings, arguments, files."""


def printable(text: str) -> str:
    """Return a text with escapes for what cannot be printed, or would move a terminal's cursor."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)

"""The names that tables, modes and legends have of their own, and which are left to users.

A column is called by a template: `{variable}` stands for the name of every variable, and so on.
The tables are made from these templates, and no name is taken that would give a column twice.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby, product

from animat.files.validation_errors import plain

Templates = Sequence[str]

TRACE: Templates = (
    "step", "x", "y", "heading", "infrared_{sensor}", "left", "right", "{variable}", "{drive}",
    "winning_drive", "behaviour", "object", "site", "likelihood_{behaviour}", "reward", "event",
)  # fmt: skip
"""The columns of a trace."""

WHICH = ("case", "life")
"""The columns of the traces of a study that tell which life a row is of."""

KEPT = ("kept_state", "kept_present", "kept_digest")
"""The columns of a recording beside its trace; they hold states, and are null in most rows."""

LIVES: Templates = (
    "world", "agent", "seed", "life", "lifespan", "censored", "death_variable", "death_side",
    "death_cause", "encounters", "acts", "successes", "failures", "disregarded", "unreached",
    "blocked", "trainings", "mean_drive", "acts_{behaviour}", "successes_{behaviour}",
)  # fmt: skip
"""The columns of a table of lives."""

LIKELIHOOD = "likelihood_{behaviour}_{object}"
"""What networks say of every object type: columns of the tables of lives of a study."""

OF_A_STUDY: Templates = (
    "case", "identity", "same_as", "error", "robot", LIKELIHOOD, "weights", "weight", "life_index",
)  # fmt: skip
"""The columns that the tables and exports of a study have besides its factors and LIVES."""

MODES = ("wander", "approach", "leave")
"""What a robot does besides its behaviours."""

MARKS = ("success", "failure", "start", "end")
"""What a figure marks on the path of a life, beside the object types."""


def spelled(templates: Templates, **names: Iterable[str]) -> Iterator[str]:
    """Yield the names of columns, a template's or alike templates' for every name in turn."""
    for holders, alike in groupby(templates, lambda each: re.findall(r"{(\w+)}", each)):
        together = list(alike)
        for chosen in product(*(names[holder] for holder in holders)):
            named = dict(zip(holders, chosen, strict=True))
            yield from (template.format(**named) for template in together)


def malformed(name: str) -> str | None:
    """Return what keeps a name from being a column or an entry of a legend, None for nothing."""
    if not name or name != name.strip():
        return "a name has at least one character, and no blanks around it"
    if not name.isprintable() or unicodedata.normalize("NFC", name) != name:
        return "a name is one line of characters that can be printed, in composed form (NFC)"
    if name.startswith("_") or "/" in name:
        return "a name does not begin with _, which legends leave out, and has no /"
    return None


def column_like(name: str, *tables: Templates) -> str | None:
    """Return the column of some tables that a name would give a second time, if there is one.

    Of columns that are called by the names of something, as likelihood_BEHAVIOUR_OBJECT.
    """
    for template in (each for table in tables for each in table):
        if template in {"{variable}", "{drive}"}:
            continue
        pattern = re.sub(r"\\{(\w+)\\}", r"(.+)", re.escape(template))
        if re.fullmatch(pattern, name):
            return re.sub(r"{(\w+)}", lambda holder: holder[1].upper(), template)
    return None


def name_problems(
    kind: str,
    names: Iterable[str],
    *,
    tables: Sequence[Templates] = (),
    others: Sequence[tuple[str, Iterable[str]]] = (),
) -> list[str]:
    """Return a line for every name of some `kind` that cannot be taken.

    It may be like no column of `tables`, and like none of the `others`, each what these are and
    their names.
    """
    found = []
    for name in names:
        where = f"{kind} {plain(name)}"
        if problem := malformed(name):
            found.append(f"{where}: {problem}")
        elif column := column_like(name, *tables):
            found.append(f"{where} is called like the column {column} of a table")
        else:
            found += [f"{where} is called like {what}" for what, taken in others if name in taken]
    return found

"""Mistakes in what a user wrote, told one to a line: what, where, and what to do."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from typing import Any, get_args

from pydantic import BaseModel, ValidationError


class WorldError(ValueError):
    """Everything that is wrong with a world, at once; `str` gives a line for each problem."""

    def __init__(self, problems: Iterable[str]) -> None:
        """Keep the problems, one line each."""
        self.problems = tuple(problems)
        super().__init__("\n".join(self.problems))


def nearest_name(name: str, known: Iterable[str]) -> str:
    """Return '; nearest: X' for the known name most like `name`, or '' when none is like it."""
    folded = name.casefold()
    by_folded = {known_name.casefold(): known_name for known_name in reversed(list(known))}
    close = difflib.get_close_matches(folded, by_folded, n=1)
    if not close:
        # Two letters swapped make short names look unlike: ST for TS.
        close = [other for other in by_folded if sorted(other) == sorted(folded)]
    return f"; nearest: {by_folded[close[0]]}" if close else ""


def explained(error: ValidationError, model: type[BaseModel]) -> list[str]:
    """Return a line for every mistake pydantic found: key, value, what is allowed."""
    return [_line(entry, model) for entry in error.errors(include_url=False)]


def key_of(location: Sequence[int | str]) -> str:
    """Return where a value stands as a user would write it: objects[3].x."""
    key = ""
    for part in location:
        key += f"[{part}]" if isinstance(part, int) else f".{part}"
    return key.removeprefix(".")


def _line(entry: Any, model: type[BaseModel]) -> str:
    key = key_of(entry["loc"])
    if entry["type"] == "extra_forbidden":
        known = list(_model_at(model, entry["loc"][:-1]).model_fields)
        unknown = str(entry["loc"][-1])
        allowed = ", ".join(known)
        return (
            f"{key} = {_short(entry['input'])}: unknown key{nearest_name(unknown, known)}; "
            f"allowed: {allowed}"
        )
    if entry["type"] == "missing":
        return f"{key}: missing; it has to be given"
    message = entry["msg"].removeprefix("Value error, ")
    if message.startswith("Input should "):
        message = "it should " + message.removeprefix("Input should ")
    if isinstance(entry["input"], dict | list | BaseModel):
        return f"{key}: {message}" if key else message
    return f"{key} = {_short(entry['input'])}: {message}"


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _model_at(model: type[BaseModel], location: Sequence[int | str]) -> type[BaseModel]:
    for part in location:
        if isinstance(part, str):
            inner = _model_in(model.model_fields[part].annotation)
            if inner is not None:
                model = inner
    return model


def _model_in(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for argument in get_args(annotation):
        found = _model_in(argument)
        if found is not None:
            return found
    return None

"""The design of a study: what is varied."""

from __future__ import annotations

import re
from typing import Annotated, Any

import tomli_w
from pydantic import AfterValidator, Field

from animat.files.settings import Settings
from animat.study.file.factors import Factor, Scalar, Value, Values
from animat.study.file.sampling import Sample


def _one_line(text: str) -> str:
    if not text.isprintable():
        raise ValueError("must be one line of what can be printed")
    return text


class Exclusion(Settings):
    """Combinations left out: where every factor named has one of the values given, and why."""

    when: Annotated[dict[str, Value | Values], Field(min_length=1)]
    why: Annotated[str, Field(min_length=1), AfterValidator(_one_line)]

    def listed(self, factor: str) -> list[Scalar]:
        """Return the values of a factor that are left out."""
        values = self.when[factor]
        return values if isinstance(values, list) else [values]


class Design(Settings):
    """Every combination of the grid's factors, the sample's points and the cases listed."""

    grid: dict[str, Factor] = {}
    sample: Sample | None = None
    cases: list[Annotated[dict[str, Value], Field(min_length=1)]] = []
    exclude: list[Exclusion] = []

    def to_toml(self) -> str:
        """Return the design as a part of a study file, with its factors in their order."""
        # TOML writes inner tables after all values, which would change the order of factors.
        data = self.model_dump(mode="json", exclude_none=True)
        text = ""
        if data["grid"]:
            text += "\n[design.grid]\n" + _lines(data["grid"])
        if "sample" in data:
            over = data["sample"].pop("over")
            text += "\n[design.sample]\n" + _lines(data["sample"])
            text += "\n[design.sample.over]\n" + _lines(over)
        for name in ("cases", "exclude"):
            for row in data[name]:
                text += f"\n[[design.{name}]]\n" + _lines(row)
        return text


def _lines(table: dict[str, Any]) -> str:
    return "".join(f"{_bare(key)} = {_inline(value)}\n" for key, value in table.items())


def _inline(value: Any) -> str:
    """Return a value as TOML on one line."""
    if isinstance(value, dict):
        pairs = (f"{_bare(key)} = {_inline(inner)}" for key, inner in value.items())
        return "{ " + ", ".join(pairs) + " }" if value else "{}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    return tomli_w.dumps({"value": value}).removeprefix("value = ").rstrip("\n")


def _bare(key: str) -> str:
    """Return a key as TOML writes it, in quotes only where it must be."""
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _inline(key)

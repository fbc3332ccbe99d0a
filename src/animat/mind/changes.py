"""Tables of named parts that change what a mind has anyway: one more, another one, one less.

What is given for a name that the paper has takes the place of the paper's, another name is added,
and `false` (in Python also None) takes the paper's away. A table that names all of the paper's
orders them as well; else the paper's come first.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import (
    SerializerFunctionWrapHandler,
    ValidatorFunctionWrapHandler,
    WrapSerializer,
    WrapValidator,
)

from animat.files.settings import nearest


class Complete(dict[str, Any]):
    """Parts as a mind has them; what another mind is given so, it takes as it is."""


def changing(paper: Mapping[str, Any], model: Any) -> tuple[WrapValidator, WrapSerializer]:
    """Return how parts of a `model`, given beside the paper's, are checked and written down."""

    def check(given: Any, validate: ValidatorFunctionWrapHandler) -> Complete:
        if isinstance(given, Complete):
            return Complete(validate(dict(given)))
        kept, removed = _split(given, paper)
        if isinstance(kept, dict) and not paper.keys() <= kept.keys() | removed:
            stay = {name: part for name, part in paper.items() if name not in removed}
            kept = {**stay, **kept}
        return Complete(validate(kept))

    def write(parts: dict[str, Any], serialize: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return serialize(parts) | {name: False for name in paper if name not in parts}

    return _check(check, model), WrapSerializer(write)


def removing(paper: Mapping[str, Any], model: Any) -> tuple[WrapValidator, WrapSerializer]:
    """Return the same of changes that are kept as they were given, the removed ones as False."""

    def check(given: Any, validate: ValidatorFunctionWrapHandler) -> dict[str, Any]:
        kept, removed = _split(given, paper)
        return validate(kept) | {name: False for name in paper if name in removed}

    def write(parts: dict[str, Any], serialize: SerializerFunctionWrapHandler) -> dict[str, Any]:
        removed = {name: False for name, part in parts.items() if part is False}
        kept = {name: part for name, part in parts.items() if name not in removed}
        return serialize(kept) | removed

    return _check(check, model), WrapSerializer(write)


def _check(check: Any, model: Any) -> WrapValidator:
    return WrapValidator(check, json_schema_input_type=dict[str, model | Literal[False]])


def _split(given: Any, paper: Mapping[str, Any]) -> tuple[Any, set[str]]:
    """Return what is given without what it takes away, and the names of that.

    Raises ValueError for a name that the paper does not have.
    """
    if not isinstance(given, Mapping):
        return given, set()
    removed = {name for name, part in given.items() if part is None or part is False}
    unknown = [str(name) for name in given if name in removed and name not in paper]
    if unknown:
        raise ValueError(
            "\n".join(
                f"{name} = false: there is nothing of this name to remove{nearest(name, paper)}"
                for name in unknown
            )
        )
    return {name: part for name, part in given.items() if name not in removed}, removed

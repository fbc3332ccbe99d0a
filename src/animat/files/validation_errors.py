"""What pydantic found wrong, in a user's words: one line for each mistake.

Pydantic says where a mistake is by a path that also names the branches of a union it tried. The
path is followed through the annotations of the model, so that the user sees only keys that can be
written, is told which keys or choices there are, and is told once of a value no branch accepts.
"""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from animat.errors import printable

KINDS = {
    "float_type": "must be a number",
    "float_parsing": "must be a number",
    "int_type": "must be a whole number",
    "int_parsing": "must be a whole number",
    "int_from_float": "must be a whole number",
    "bool_type": "must be true or false",
    "bool_parsing": "must be true or false",
    "string_type": "must be a string",
    "callable_type": "must be a function",
    "dict_type": "must be a table",
    "model_type": "must be a table",
    "model_attributes_type": "must be a table",
    "list_type": "must be a list",
    "tuple_type": "must be a list",
    "finite_number": "must be a finite number",
}

MISSING = "missing key; it must be given"

LONGEST_VALUE = 60
"""Characters of a value that are worth repeating."""

CLOSE_ENOUGH = 0.6
"""The similarity (difflib's ratio) from which a name is taken for a misspelling."""


def nearest(name: str, known: Iterable[str]) -> str:
    """Return '; did you mean "x"?' for the known name most like `name`, else '; known: ...'."""
    names = [str(each) for each in known]
    close = _closest(name, names)
    if close is not None:
        return f'; did you mean "{close}"?'
    return f"; known: {', '.join(names)}" if names else ""


def mistakes(error: ValidationError, model: type[BaseModel]) -> list[str]:
    """Return a line for every mistake, `key a.b[0] = VALUE: what is wrong with it`."""
    lines = [line for mistake in mistakes_found(error, model) for line in mistake.lines()]
    return list(dict.fromkeys(lines))


def mistakes_found(error: ValidationError, model: type[BaseModel]) -> list[Mistake]:
    """Return every mistake in what should be settings of `model`."""
    found = [_found(detail, model) for detail in error.errors(include_url=False)]
    return _without_other_branches(found)


class Mistake(NamedTuple):
    """What is wrong with the value of a key; `value` is " = VALUE", or empty."""

    key: tuple[str | int, ...]
    value: str
    message: str
    union: tuple[str | int, ...] | None = None  # the key of the outermost union on the way
    branch: str | int | None = None  # which of its branches this mistake belongs to

    def lines(self) -> list[str]:
        """Return a line for each mistake that a validator of ours reported together."""
        name = f"key {written(self.key)}{self.value}: " if self.key else ""
        return [name + line for line in self.message.split("\n")]


def _found(detail: ErrorDetails, model: type[BaseModel]) -> Mistake:
    here: Any = model
    key: list[str | int] = []
    union = branch = None
    of_key = False
    holder: Any = None
    for part in detail["loc"]:
        options = allowed_types(here)
        if part == "[key]":
            of_key = True
            here = _argument(holder, 0)
        elif len(options) > 1:
            if union is None:
                union, branch = tuple(key), part
            here = _branch(options, part)
        else:
            holder = options[0]
            key.append(part)
            here = inside(holder, part)
    if detail["type"] in {"union_tag_invalid", "union_tag_not_found"}:
        return _untagged(detail, tuple(key))
    message = _message(detail, allowed_types(here)[0], holder, of_key)
    silent = of_key or detail["type"] in {"missing", "extra_forbidden"}
    value = "" if silent else shown(detail["input"])
    return Mistake(tuple(key), value, message, union, branch)


def _untagged(detail: ErrorDetails, key: tuple[str | int, ...]) -> Mistake:
    """Return what is wrong with the key by whose value the branch of a union is chosen."""
    context = detail.get("ctx", {})
    tag = context["discriminator"].strip("'")
    if detail["type"] == "union_tag_not_found":
        return Mistake((*key, tag), "", MISSING)
    choices = re.findall(r"'([^']*)'", context["expected_tags"])
    value = context["tag"]
    return Mistake((*key, tag), shown(value), _not_among(choices, value, False))


def _without_other_branches(found: Sequence[Mistake]) -> list[Mistake]:
    """Report of each union only the branch the user meant, or all of them in one mistake."""
    unions: dict[tuple[str | int, ...], dict[str | int | None, list[Mistake]]] = {}
    for mistake in found:
        if mistake.union is not None:
            unions.setdefault(mistake.union, {}).setdefault(mistake.branch, []).append(mistake)
    kept: list[Mistake] = []
    for mistake in found:
        if mistake.union is None:
            kept.append(mistake)
            continue
        branches = unions.pop(mistake.union, None)
        if branches is None:
            continue
        meant = [ms for ms in branches.values() if any(len(m.key) > len(mistake.union) for m in ms)]
        if meant:
            kept += min(meant, key=len)
        else:
            messages = dict.fromkeys(m.message for ms in branches.values() for m in ms)
            first, *others = messages
            either = [first, *(message.removeprefix("must be ") for message in others)]
            kept.append(mistake._replace(message=" or ".join(either)))
    return kept


def _message(detail: ErrorDetails, here: Any, holder: Any, of_key: bool) -> str:
    """Return what is wrong; `holder` is what the key stands in, `here` what it should be."""
    kind = detail["type"]
    if kind in KINDS:
        return KINDS[kind]
    if kind == "missing":
        return MISSING
    if kind == "extra_forbidden":
        fields = holder.model_fields if is_model(holder) else ()
        return f"unknown key{nearest(str(detail['loc'][-1]), fields)}"
    if kind == "literal_error" and get_origin(here) is Literal:
        return _not_among(get_args(here), detail["input"], of_key)
    if kind == "value_error":
        return str(detail.get("ctx", {}).get("error") or detail["msg"])
    message = re.sub(r"^(Input|Value|String|List|Tuple|Dictionary) should ", "must ", detail["msg"])
    return " ".join(message.replace(" after validation,", ",").split())


def _not_among(choices: Sequence[Any], value: Any, of_key: bool) -> str:
    names = [str(choice) for choice in choices]
    if of_key:
        return f"unknown key{nearest(str(value), names)}"
    close = _closest(value, names) if isinstance(value, str) else None
    hint = f'; did you mean "{close}"?' if close is not None else ""
    return f"must be one of {', '.join(map(plain, choices))}{hint}"


def _closest(name: str, known: Sequence[str]) -> str | None:
    folded = name.casefold()
    by_folded = {each.casefold(): each for each in reversed(known)}
    close = difflib.get_close_matches(folded, by_folded, n=1, cutoff=CLOSE_ENOUGH)
    if not close:
        # Two letters swapped make short names look unlike: FA for AF.
        close = [other for other in by_folded if sorted(other) == sorted(folded)]
    return by_folded[close[0]] if close else None


def written(key: Sequence[str | int]) -> str:
    """Return a key as TOML writes it, list entries as [0], [1], ..."""
    text = ""
    for part in key:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            text += "." + (part if re.fullmatch(r"[A-Za-z0-9_-]+", part) else plain(part))
    return text.removeprefix(".")


def shown(value: Any) -> str:
    """Return ' = VALUE', or nothing where the value is a table or a list."""
    if isinstance(value, Mapping | list | tuple | set | BaseModel):
        return ""
    return f" = {brief(value)}"


def brief(value: Any) -> str:
    """Return a value as `plain` does, cut short where it is long."""
    text = plain(value)
    return text if len(text) <= LONGEST_VALUE else text[: LONGEST_VALUE - 3] + "..."


def plain(value: Any) -> str:
    """Return a value as TOML writes it, on one line and without what a terminal would obey."""
    if isinstance(value, bool | str):
        text = json.dumps(value, ensure_ascii=False)
    else:
        try:
            text = " ".join(str(value).split())
        except Exception:
            # A whole number of thousands of digits, or an object that does not tell what it is.
            text = f"a value of type {type(value).__name__}"
    return printable(text)


def allowed_types(annotation: Any) -> list[Any]:
    """Return what an annotation allows besides None, at least one."""
    while get_origin(annotation) is Annotated or hasattr(annotation, "__value__"):
        annotation = getattr(annotation, "__value__", None) or _argument(annotation, 0)
    if get_origin(annotation) not in {Union, UnionType}:
        return [annotation]
    options = [each for each in get_args(annotation) if each is not NoneType]
    return options if len(options) > 1 else allowed_types(options[0])


def _branch(options: Sequence[Any], label: str | int) -> Any:
    """Return the branch of a union that pydantic calls `label`, None if it cannot be told."""
    for option in options:
        here = allowed_types(option)[0]
        if is_model(here):
            if here.__name__ == label or any(
                label in get_args(field.annotation) for field in here.model_fields.values()
            ):
                return here
        elif str(label).startswith(f"{getattr(get_origin(here), '__name__', '-').lower()}["):
            return here
    return None


def inside(holder: Any, part: str | int) -> Any:
    """Return what stands under a key of a model, a dict or a list, None if unknown."""
    if is_model(holder):
        field = holder.model_fields.get(part)
        return field.annotation if field is not None else None
    if isinstance(part, int) and get_origin(holder) is tuple and Ellipsis not in get_args(holder):
        return _argument(holder, part)
    return _argument(holder, 1 if get_origin(holder) is dict else 0)


def _argument(annotation: Any, index: int) -> Any:
    arguments = get_args(annotation)
    return arguments[index] if index < len(arguments) else None


def is_model(annotation: Any) -> bool:
    """Tell whether an annotation is a model of settings."""
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)

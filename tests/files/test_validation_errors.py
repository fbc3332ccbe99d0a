"""Mistakes in settings of every form pydantic knows, told in words of the user."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field, StringConstraints, field_validator, model_validator

from animat.files.settings import Settings, SettingsError

Positive = Annotated[float, Field(gt=0)]


class Wheel(Settings):
    radius: Positive = 1.0
    spokes: int = 8
    grip: Positive | Annotated[int, Field(gt=0)] = 1.0


class Track(Settings):
    length: Positive
    links: int


class Legs(Settings):
    kind: Literal["legs"]
    count: Positive


class Wings(Settings):
    kind: Literal["wings"]
    span: Positive


class Robot(Settings):
    name: Annotated[str, StringConstraints(min_length=1)] = "r"
    law: str | Callable[..., Any] = "decay"
    drive: Wheel | Track | Literal["none"] = "none"
    limbs: Annotated[Legs | Wings, Field(discriminator="kind")] | None = None
    wheels: list[Wheel] = []
    pair: tuple[Wheel, Track] | None = None
    bounds: dict[Literal["low", "high"], Positive] = {}
    size: int | float | None = None
    sizes: Annotated[dict[str, Positive] | list[Positive], Field()] = []
    either: Annotated[Wheel | None, Field()] = None

    @field_validator("name")
    @classmethod
    def _not_taken(cls, name: str) -> str:
        if name == "robot":
            raise ValueError("is taken")
        return name

    @model_validator(mode="after")
    def _fits(self) -> Robot:
        if self.wheels and self.pair:
            raise ValueError("wheels and pair exclude each other")
        return self


def wrong(**data: Any) -> list[str]:
    with pytest.raises(SettingsError) as caught:
        Robot(**data)
    return list(caught.value.problems)


CASES: dict[str, tuple[dict[str, Any], list[str]]] = {
    "a union of types": ({"law": 3}, ["key law = 3: must be a string or a function"]),
    "a union of numbers": ({"size": "3"}, ['key size = "3": must be a whole number or a number']),
    "the table meant": (
        {"drive": {"length": -1, "links": 3}},
        ["key drive.length = -1: must be greater than 0"],
    ),
    "a union in the table meant": (
        {"drive": {"grip": -1}},
        ["key drive.grip = -1: must be greater than 0"],
    ),
    "neither table nor choice": (
        {"drive": "nome"},
        ['key drive = "nome": must be a table or one of "none"; did you mean "none"?'],
    ),
    "a tagged table": (
        {"limbs": {"kind": "wings", "spam": 3}},
        [
            "key limbs.span: missing key; it must be given",
            'key limbs.spam: unknown key; did you mean "span"?',
        ],
    ),
    "an unknown tag": (
        {"limbs": {"kind": "wing", "span": 3}},
        ['key limbs.kind = "wing": must be one of "legs", "wings"; did you mean "wings"?'],
    ),
    "no tag": (
        {"limbs": {"span": 3}},
        ["key limbs.kind: missing key; it must be given"],
    ),
    "a list entry": (
        {"wheels": [{}, {"spoke": 1}]},
        ['key wheels[1].spoke: unknown key; did you mean "spokes"?'],
    ),
    "places of a pair": (
        {"pair": ({"radius": 0}, {"length": 1, "lnks": 1, "links": 1})},
        [
            "key pair[0].radius = 0: must be greater than 0",
            'key pair[1].lnks: unknown key; did you mean "links"?',
        ],
    ),
    "a key among choices": (
        {"bounds": {"hihg": 1}},
        ['key bounds.hihg: unknown key; did you mean "high"?'],
    ),
    "a union of containers": ({"sizes": {"a": 0}}, ["key sizes.a = 0: must be greater than 0"]),
    "a list in a union": ({"sizes": [1, 0]}, ["key sizes[1] = 0: must be greater than 0"]),
    "an optional table": (
        {"either": {"radus": 1}},
        ['key either.radus: unknown key; did you mean "radius"?'],
    ),
    "a key with spaces": ({"sizes": {"a b": 0}}, ['key sizes."a b" = 0: must be greater than 0']),
    "a constraint of pydantic's": ({"name": ""}, ['key name = "": must have at least 1 character']),
    "a validator of a field": ({"name": "robot"}, ['key name = "robot": is taken']),
    "a validator of the whole": (
        {"wheels": [{}], "pair": ({}, {"length": 1, "links": 1})},
        ["wheels and pair exclude each other"],
    ),
    "a long value": ({"wheels": "x" * 100}, [f'key wheels = "{"x" * 56}...: must be a list']),
    "a value of many lines": ({"wheels": "a\nb"}, ['key wheels = "a\\nb": must be a list']),
    "a value a terminal would obey": (
        {"wheels": "\x1b[2J\x9b\u202e"},
        ['key wheels = "\\u001b[2J\\x9b\\u202e": must be a list'],
    ),
    "an object of many lines": ({"name": range(2)}, ["key name = range(0, 2): must be a string"]),
}


@pytest.mark.parametrize("case", CASES)
def test_the_line(case):
    data, lines = CASES[case]
    assert wrong(**data) == lines


ANY = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["kind", "radius", "low", "a\nb", "length"]), inner)
    ),
    max_leaves=6,
)


@given(data=st.dictionaries(st.sampled_from([*Robot.model_fields, "nome", "a b"]), ANY, max_size=4))
def test_whatever_is_wrong_is_told_without_pydantics_words(data):
    try:
        Robot(**data)
    except SettingsError as error:
        lines = error.problems
        assert lines
        assert len(set(lines)) == len(lines)
        for line in lines:
            assert "\n" not in line
            assert not any(word in line for word in ("Input", "function-", "literal[", "[key]"))

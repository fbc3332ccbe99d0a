from typing import Annotated

import pytest
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from animat.world.problems import WorldError, explained, key_of, nearest_name


class Inner(BaseModel):
    model_config = ConfigDict(extra="forbid")
    speed: Annotated[float, Field(ge=0)]


class Outer(BaseModel):
    model_config = ConfigDict(extra="forbid")
    name: str
    parts: tuple[Inner, ...] = ()
    spare: Inner | None = None

    @model_validator(mode="after")
    def _no_bad_name(self):
        if self.name == "bad":
            raise ValueError("this name is taken")
        return self


def lines(**data):
    with pytest.raises(ValidationError) as caught:
        Outer.model_validate(data)
    return explained(caught.value, Outer)


def test_every_mistake_has_a_line_with_key_value_and_what_is_allowed():
    assert lines(parts=[{"speed": 1}, {"sped": 2, "speed": -3}], spare={"speed": "x", "s": 1}) == [
        "name: missing; it has to be given",
        "parts[1].speed = -3: it should be greater than or equal to 0",
        "parts[1].sped = 2: unknown key; nearest: speed; allowed: speed",
        "spare.speed = 'x': it should be a valid number, unable to parse string as a number",
        "spare.s = 1: unknown key; allowed: speed",
    ]


def test_unknown_keys_of_the_whole_are_compared_with_its_own():
    assert lines(name="a", pats=1) == [
        "pats = 1: unknown key; nearest: parts; allowed: name, parts, spare"
    ]


def test_what_a_model_itself_refuses_is_told_in_its_words():
    assert lines(name="bad") == ["this name is taken"]


def test_long_values_are_shortened():
    (line,) = lines(name="a", spare={"speed": "x" * 500})
    assert len(line) < 160


@pytest.mark.parametrize(
    ("name", "nearest"),
    [("ts", "; nearest: TS"), ("TSS", "; nearest: TS"), ("circle", ""), ("ST", "; nearest: TS")],
)
def test_the_nearest_name_is_told_only_when_one_is_near(name, nearest):
    assert nearest_name(name, ["TS", "TL", "CS", "CL"]) == nearest


def test_keys_read_as_a_user_writes_them():
    assert key_of(("objects", 3, "x")) == "objects[3].x"


def test_an_error_tells_all_its_problems():
    error = WorldError(["one", "two"])
    assert error.problems == ("one", "two")
    assert str(error) == "one\ntwo"
    assert isinstance(error, ValueError)

"""The JSON schema of study files: it is one, knows every setting, and refuses what we refuse."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import pytest
import tomli_w
from pydantic import BaseModel

from animat.files.settings import SettingsError
from animat.files.validation_errors import allowed_types, is_model
from animat.study.file.keys import Key, fields, known_keys
from animat.study.file.read import read_study
from animat.study.file.schema import study_schema
from animat.study.file.settings import CaseSettings
from animat.study.file.study import Study

SCHEMA = study_schema()


@pytest.fixture(scope="module")
def file(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("schema") / "study.toml"


def references(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        yield from [schema["$ref"]] if "$ref" in schema else []
        schema = list(schema.values())
    if isinstance(schema, list):
        for inner in schema:
            yield from references(inner)


def at(reference: str) -> Any:
    assert reference.startswith("#/")
    here: Any = SCHEMA
    for part in reference.removeprefix("#/").split("/"):
        here = here[part]
    return here


def test_every_reference_leads_to_a_schema():
    found = set(references(SCHEMA))
    assert len(found) > 50
    for reference in found:
        assert isinstance(at(reference), dict)


def models(model: type[BaseModel]) -> Iterator[type[BaseModel]]:
    """The models of all tables in a model, itself among them."""
    yield model
    for name in fields(model):
        for option in allowed_types(model.model_fields[name].annotation):
            inner = [option, *(each for each in get_args(option) if is_model(each))]
            for each in inner:
                if is_model(each):
                    yield from models(each)


def test_every_setting_is_in_it():
    tables = {model.__name__: model for model in models(Study)}
    assert set(SCHEMA["$defs"]) >= set(tables) - {"Study"}
    for name, model in tables.items():
        schema = SCHEMA if name == "Study" else SCHEMA["$defs"][name]
        assert list(schema["properties"]) == fields(model)
        assert schema["additionalProperties"] is False
        required = [name for name in fields(model) if model.model_fields[name].is_required()]
        assert schema.get("required", []) == required


def test_a_design_may_vary_every_setting_that_is_one_value():
    design = SCHEMA["$defs"]["Design"]["properties"]
    over = SCHEMA["$defs"]["Sample"]["properties"]["over"]
    tables = {"robot.sensors"}
    known = {key for key in known_keys({}, CaseSettings) if not key.startswith("mind.variables")}
    keys = {key for key in known if key not in tables and "counts" not in key}
    keys -= {key for key in known if key.startswith(("mind.drives", "mind.behaviours"))}
    assert set(design["grid"]["properties"]) == keys
    assert set(over["properties"]) == set(design["cases"]["items"]["properties"]) == keys
    for key, values in design["grid"]["properties"].items():
        section, _, name = key.rpartition(".")
        setting = at(values["items"]["$ref"])
        assert setting is at(over["properties"][key]["anyOf"][0]["items"]["$ref"])
        assert setting["title"].lower() == name.replace("_", " "), section


def test_nothing_is_in_it_that_toml_cannot_say():
    text = json.dumps(SCHEMA)
    assert "null" not in text
    assert "networks" not in SCHEMA["$defs"]["Mind"]["properties"]


def wrong_values(setting: dict[str, Any]) -> Iterator[Any]:
    """Values that the schema of a setting does not allow."""
    if "anyOf" in setting:
        return
    kind = setting.get("type")
    wrong = {
        "string": [1, 0.5, True, ["a"], {"a": "b"}],
        "integer": [0.5, 1.0, True, "1", [1], {"a": 1}, float("nan")],
        "number": [True, "0.1", [0.1], {"a": 0.1}, float("nan"), float("inf")],
        "boolean": [0, 1, 1.0, "true", [True], {}],
        "array": [1, "a", True, {"a": 1}],
        "object": [1, "a", True, [1]],
    }
    yield from wrong.get(str(kind), ())
    if "enum" in setting:
        yield from ("", "no such", setting["enum"][0] + "x", setting["enum"][-1].swapcase())
    for limit, step in (("minimum", -1), ("maximum", 1)):
        if limit in setting:
            yield setting[limit] + step
    for limit in ("exclusiveMinimum", "exclusiveMaximum"):
        if limit in setting:
            yield setting[limit]


def settings_of(schema: dict[str, Any], key: Key = ()) -> Iterator[tuple[Key, dict[str, Any]]]:
    """Every setting with a fixed name below a schema, and its own schema."""
    for name, setting in schema.get("properties", {}).items():
        if name in {"grid", "over", "cases", "exclude"}:
            continue
        inner = SCHEMA["$defs"][setting["$ref"].split("/")[-1]] if "$ref" in setting else setting
        yield (*key, name), inner
        yield from settings_of(inner, (*key, name))


NEEDED = {"record": {"what": "all"}, "design": {"sample": {"method": "sobol", "points": 1}}}

WRONG = [
    pytest.param(key, value, id=f"{'.'.join(map(str, key))}={value!r}")
    for key, setting in settings_of(SCHEMA)
    for value in wrong_values(setting)
]


@pytest.mark.parametrize(("key", "value"), WRONG)
def test_what_the_schema_does_not_allow_is_refused_by_its_key(file, key, value):
    data: dict[str, Any] = {"name": "x"}
    holder = data
    for depth, part in enumerate(key[:-1]):
        holder = holder.setdefault(part, copy.deepcopy(NEEDED.get(part, {})) if not depth else {})
    holder[key[-1]] = value
    file.write_text(tomli_w.dumps(data))
    named = ".".join(map(str, key))
    with pytest.raises(SettingsError) as caught:
        read_study(file)
    assert any(line.startswith(f"{file}: key {named}") for line in caught.value.problems)

"""The JSON schema of a study file, for editors that complete and check TOML."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import PydanticOmit, core_schema

from animat.study.file.keys import fields, table_of
from animat.study.file.settings import CaseSettings
from animat.study.file.study import Study

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def study_schema() -> dict[str, Any]:
    """Return the JSON schema of a study file.

    It knows the keys that a design may vary; what its levels set it leaves to `animat check`.
    """
    schema = Study.model_json_schema(schema_generator=_OfToml)
    parts = schema["$defs"]
    grid = parts["Design"]["properties"]["grid"]
    over = parts["Sample"]["properties"]["over"]
    row = parts["Design"]["properties"]["cases"]["items"]
    for key, reference in _settings(CaseSettings, "", "#"):
        values = {"type": "array", "minItems": 1, "items": {"$ref": reference}}
        grid.setdefault("properties", {})[key] = values
        over.setdefault("properties", {})[key] = {"anyOf": [values, {"$ref": "#/$defs/Range"}]}
        row.setdefault("properties", {})[key] = {"$ref": reference}
    return {"$schema": DIALECT, **schema}


class _OfToml(GenerateJsonSchema):
    """Leaves out what TOML cannot say: functions and networks, and that there is nothing."""

    def callable_schema(self, schema: core_schema.CallableSchema) -> JsonSchemaValue:
        raise PydanticOmit

    def dataclass_schema(self, schema: core_schema.DataclassSchema) -> JsonSchemaValue:
        raise PydanticOmit

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        if schema.get("default", ...) is None:
            return self.generate_inner(schema["schema"])
        return super().default_schema(schema)

    def encode_default(self, dft: Any) -> Any:
        return _given(super().encode_default(dft))


def _given(default: Any) -> Any:
    """Return a default without what is left out in it."""
    if isinstance(default, dict):
        return {name: _given(value) for name, value in default.items() if value is not None}
    return default


def _settings(model: type[BaseModel], prefix: str, at: str) -> Iterator[tuple[str, str]]:
    """Yield the key of every setting that is one value, and where in the schema it stands."""
    for name in fields(model):
        table = table_of(model.model_fields[name].annotation)
        key, reference = f"{prefix}{name}", f"{at}/properties/{name}"
        if isinstance(table, type) and issubclass(table, BaseModel):
            yield from _settings(table, f"{key}.", f"#/$defs/{table.__name__}")
        elif table is None and name != "sensors":
            yield key, reference

"""`animat schema` as its users meet it."""

from __future__ import annotations

import json

from animat.study.file.schema import study_schema


def test_it_prints_the_schema(animat):
    said = animat("schema")
    assert (said.code, said.err) == (0, "")
    assert json.loads(said.out) == study_schema()

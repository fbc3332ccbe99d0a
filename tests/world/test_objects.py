import numpy as np
import pytest
from pydantic import TypeAdapter

from animat.files.settings import SettingsError
from animat.world.objects import TABLE_1, ObjectType

MINE = {
    "name": "mine", "shape": "square", "size_mm": 20.0,
    "features": {"colour": 0.3}, "affords": {"grasp": 0.5},
}  # fmt: skip


def test_table_1_is_the_papers():
    rows = {
        t.name: (
            t.features["shape"], t.features["size"],
            t.affords["shelter"], t.affords["grasp"], t.affords["interact"],
        )
        for t in TABLE_1
    }  # fmt: skip
    assert rows == {
        "TS": (0, 0, 0, 1, 1), "TL": (0, 1, 1, 0, 1),
        "CS": (1, 0, 0, 1, 1), "CL": (1, 1, 1, 0, 1),
    }  # fmt: skip


def test_table_1_is_drawn_as_the_model_says():
    drawn = {t.name: (len(t.polygon()), t.size_mm) for t in TABLE_1}
    assert drawn == {"TS": (3, 45.0), "TL": (3, 100.0), "CS": (4, 38.0), "CL": (8, 100.0)}


def test_a_type_of_ones_own_has_any_features_and_affordances():
    features = {f"f{i}": i / 7 for i in range(8)}
    own = ObjectType(name="x", shape=5, size_mm=9, features=features, affords={"roll": 0.25})
    assert own.features == features
    assert own.affords == {"roll": 0.25}


def test_corners_are_a_shape():
    corners = [[0, 0], [40, 0], [40, 10], [10, 10], [10, 40], [0, 40]]
    own = ObjectType(**{**MINE, "shape": corners, "size_mm": None})
    assert own.polygon().shape == (6, 2)
    np.testing.assert_allclose(np.ptp(own.polygon(), axis=0), 40.0)


def test_types_are_equal_by_content_and_hash_alike():
    a = ObjectType(**{**MINE, "features": {"a": 1.0, "b": 2.0}})
    b = ObjectType(**{**MINE, "features": {"b": 2.0, "a": 1.0}})
    assert a == b
    assert hash(a) == hash(b)
    assert a != ObjectType(**{**MINE, "features": {"a": 1.0, "b": 2.5}})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"affords": {"grasp": 1.1}}, "less than or equal to 1"),
        ({"affords": {"grasp": -0.1}}, "greater than or equal to 0"),
        ({"affords": {"grasp": float("nan")}}, "affords"),
        ({"affords": {}}, "at least 1"),
        ({"features": {}}, "at least 1"),
        ({"features": {"colour": float("inf")}}, "finite"),
        ({"features": {"colour": "0.3"}}, "must be a number"),
        ({"shape": "squire"}, 'did you mean "square"'),
        ({"shape": 2}, "3 to 64"),
        ({"shape": True}, "a number of sides"),
        ({"shape": [[0, 0], [1]]}, "corners"),
        ({"shape": [[0, 0], [9, 9], [9, 0], [0, 9]], "size_mm": None}, "cross"),
        ({"size_mm": 0.0}, "greater than 0"),
        ({"size_mm": None}, "needs a size"),
        ({"name": ""}, "name"),
        ({"name": "a\nb"}, "name"),
        ({"colour": 1}, "unknown key"),
    ],
)
def test_impossible_types_are_refused(change, message):
    with pytest.raises(SettingsError, match=message):
        ObjectType(**{**MINE, **change})


def test_types_have_a_json_schema_for_editors():
    schema = TypeAdapter(ObjectType).json_schema()
    assert {"name", "shape", "size_mm", "features", "affords"} == set(schema["properties"])
    assert "triangle" in schema["properties"]["shape"]["anyOf"][0]["enum"]

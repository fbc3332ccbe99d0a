from itertools import product

import pyarrow as pa
import pytest

from animat.experiments.universes import (
    CELL_NAMES,
    label,
    readings_of,
    universes_of,
)
from animat.files.settings import SettingsError, validated
from animat.study.file.study import Study
from animat.study.plan.plan import Plan

ASKED_FOR = {
    "physiology", "lethal margin", "overflow", "failed act", "failure effect", "error", "gate",
    "objects", "encounter range", "interaction steps", "biases", "cycles", "likelihood threshold",
    "abundant world", "scarce world", "infrared", "noise",
}  # fmt: skip
"""What the paper leaves open, by the names of the readings."""


def test_the_study_that_ships_has_every_reading_with_two_values_or_more(small):
    readings = {reading.name: reading.labels for reading in readings_of(small)}
    assert set(readings) == ASKED_FOR
    assert all(len(set(values)) == len(values) >= 2 for values in readings.values())
    assert readings["physiology"] == ("excess", "decay", "relax", "linear")
    assert readings["biases"] == ("true", "false")
    assert readings["failure effect"] == ("0.2", "0")


def test_what_is_spread_over_a_range_is_no_reading(small):
    assert not [reading for reading in readings_of(small) if "seed" in reading.factor]


def test_a_universe_has_its_four_cells_with_the_same_settings(small):
    plan = Plan(small)
    universes = universes_of(small, plan.case_table())
    assert sorted(universes.cases.ravel().tolist()) == list(range(len(plan.cases)))
    for values, cases in zip(universes.values, universes.cases, strict=True):
        four = [plan.cases[case] for case in cases]
        assert [case.factors["cell"] for case in four] == list(CELL_NAMES)
        for case in four:
            had = [label(case.factors[r.factor]) for r in universes.readings]
            assert tuple(had) == values
        worlds = [case.settings.world for case in four]
        assert worlds[0] == worlds[1] != worlds[2] == worlds[3]
        assert {case.settings.robot for case in four} == {four[0].settings.robot}
        assert [case.settings.mind.agent for case in four] == ["BLIND", "AF"] * 2
        assert four[1].teacher is not None
        assert four[1].teacher.world == worlds[0]


def test_columns_say_what_names_say(small):
    universes = universes_of(small, Plan(small).case_table())
    columns = universes.columns()
    assert list(columns) == list(universes.names())
    for name, values in universes.names().items():
        assert set(columns[name].to_pylist()) <= set(values)


def test_layouts_differ_from_universe_to_universe_and_the_published_ones_do_not(small):
    plan = Plan(small)
    random, fixed = [], []
    for case in plan.cases:
        if case.factors["cell"] == "abundant BLIND":
            where = fixed if case.factors["abundant world"] == "8 fixed" else random
            where.append(case.settings.world)
    assert len({choice.seed for choice in random}) == len(random)
    assert {choice.layout for choice in fixed} == {"abundant"}


SAMPLE_OF_STEPS = {"method": "sobol", "points": 4, "over": {"steps": [9, 10]}}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"design": {"grid": {"mind.agent": ["BLIND", "AF"]}}}, r"needs a factor \[design.grid"),
        ({"teacher": None}, r"needs a \[teacher\]"),
        ({"paired": False}, "paired = true"),
        ({"design": {"sample": None}}, "has no reading"),
        ({"design": {"sample": SAMPLE_OF_STEPS}}, "steps is no reading"),
    ],
)
def test_a_study_that_is_none_is_refused(small, change, message):
    data = small.model_dump(mode="json", exclude_none=True)
    for name, value in change.items():
        if isinstance(value, dict):
            data[name] = {**data[name], **value}
        else:
            data[name] = value
    design = {name: part for name, part in data["design"].items() if part is not None}
    data["design"] = {**design, "exclude": []}
    with pytest.raises(SettingsError, match=message):
        readings_of(validated({n: v for n, v in data.items() if v is not None}, Study))


def test_readings_whose_keys_end_alike_are_told_by_the_whole_key(small):
    data = small.model_dump(mode="json", exclude_none=True)
    over = {
        "mind.variables.nutrition.rate": [1e-4, 2e-4],
        "mind.variables.stamina.rate": [1e-4, 2e-4],
        "mind.overflow": ["clamp", "lethal"],
    }
    data["design"]["sample"]["over"] = over
    data["design"]["exclude"] = []
    names = [reading.name for reading in readings_of(validated(data, Study))]
    assert names == ["mind.variables.nutrition.rate", "mind.variables.stamina.rate", "overflow"]


def test_universes_that_differ_in_a_range_alone_are_two(small):
    rows = [
        {"case": number, "cell": cell, "mind.overflow": "clamp", "worlds.rich.seed": seed}
        for number, (cell, seed) in enumerate(product(CELL_NAMES, (1, 2)))
    ]
    over = {"mind.overflow": ["clamp", "lethal"], "worlds.rich.seed": {"low": 1, "high": 9}}
    data = small.model_dump(mode="json", exclude_none=True)
    data["design"]["sample"]["over"] = over
    data["design"]["exclude"] = []
    universes = universes_of(validated(data, Study), pa.Table.from_pylist(rows))
    assert universes.cases.tolist() == [[0, 2, 4, 6], [1, 3, 5, 7]]

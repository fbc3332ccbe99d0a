"""Names that users give: whatever is accepted, no table has a column twice."""

from __future__ import annotations

import unicodedata
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from animat.errors import Error, SettingsError
from animat.life.birth import born
from animat.life.scenario import LifeError, checked_parameters, counts_of
from animat.life.summary import summary
from animat.life.trace import ROW, table
from animat.mind.mind import Mind
from animat.names import KEPT, LIKELIHOOD, LIVES, MARKS, MODES, OF_A_STUDY, TRACE, spelled
from animat.robot.khepera import Khepera
from animat.study.file.cases import cases
from animat.study.file.design import Design
from animat.study.file.settings import CaseSettings, WorldChoice
from animat.study.file.study import Study
from animat.world.objects import TABLE_1, ObjectType
from animat.world.world import World

LIKE = [*TRACE, *LIVES, *KEPT, *MODES, *MARKS, *OF_A_STUDY, "infrared_0", "likelihood_a_b"]
NAME = st.sampled_from([*LIKE, "a", "b", "a_b", "b_b", "é", "e\u0301", "", " a", "_a", "a\nb"])
NAMES = st.lists(NAME | st.text(max_size=4), min_size=1, max_size=3, unique=True)

VARIABLE = {"law": "decay", "rate": 0.01, "set_point": 0.5}


def mind_of(variables, drives, behaviours) -> Mind:
    return Mind(
        variables=dict.fromkeys(variables, VARIABLE),
        drives={name: {"a": {variables[0]: 1.0}} for name in drives},
        behaviours={name: {"serves": drives[0], "needs": "grasp"} for name in behaviours},
    )


def world_of(types) -> World:
    kinds = tuple(ObjectType(**{**dict(TABLE_1[0]), "name": name}) for name in types)
    return World.random({types[0]: 1}, types=kinds)


def columns(mind: Mind, world: World) -> tuple[list[str], list[str]]:
    """Return the columns of a trace, and of a table of lives."""
    counts = counts_of(mind, len(world.feature_names), len(Khepera().sensors))
    states = born(counts, checked_parameters(mind, world), 0, None)
    setting: Any = SimpleNamespace(mind=mind, world=world)
    rows = np.zeros(0, ROW.dtype(counts._asdict()))
    lives = summary(setting, 0, np.zeros(0, np.uint64), states)
    return table(rows, mind, world).column_names, list(lives)


@settings(deadline=None, max_examples=200)
@given(NAMES, NAMES, NAMES, NAMES)
@example(["v"], ["d"], ["eat", "eat_a"], ["a_b", "b"])
@example(["likelihood_b"], ["d"], ["b"], ["a"])
@example(["v"], ["v"], ["b"], ["a"])
@example(["{variable}"], ["{drive}"], ["{behaviour}"], ["{object}"])
def test_whatever_names_are_accepted_no_column_is_there_twice(variables, drives, behaviours, types):
    refused: list[str] = []
    try:
        mind, world = mind_of(variables, drives, behaviours), world_of(types)
        trace, lives = columns(mind, world)
    except Error as error:
        refused.extend(error.problems)
    if refused:
        assert all(line and "\n" not in line for line in refused)
        return
    # What the paper has is there as well.
    assert {*drives} <= {*mind.drives}
    assert {*behaviours} <= {*mind.behaviours}
    drives, behaviours = list(mind.drives), list(mind.behaviours)
    known = len(mind.resolved_variables()) + len(drives) + len(behaviours)
    assert len({*trace, *KEPT, "case", "life"}) == 20 + known + len(KEPT) + 2
    likelihoods = list(spelled([LIKELIHOOD], behaviour=behaviours, object=types))
    fixed = [name for name in OF_A_STUDY if "{" not in name]
    study = [*fixed, *lives, *likelihoods]
    assert len(set(study)) == len(study)
    assert len({*MODES, *behaviours}) == 3 + len(behaviours)
    assert not {*types} & {*MARKS}
    for name in (*variables, *drives, *behaviours, *types):
        assert name.isprintable()
        assert unicodedata.normalize("NFC", name) == name


@pytest.mark.parametrize("name", [n for n in (*TRACE, *KEPT, "case", "life") if "{" not in n])
def test_a_column_of_a_trace_is_no_variable_and_no_drive(name):
    for given_names in ((name, "d"), ("v", name)):
        with pytest.raises(SettingsError, match=f'"{name}" is called like the column {name}'):
            mind_of([given_names[0]], [given_names[1]], ["b"])


def test_both_sides_of_a_collision_are_named():
    with pytest.raises(SettingsError, match=r'^drive "nutrition" is called like a variable$'):
        mind_of(["v"], ["nutrition"], ["b"])
    with pytest.raises(SettingsError, match=r'^behaviour "leave" is called like one of the modes'):
        mind_of(["v"], ["d"], ["leave"])
    with pytest.raises(LifeError) as caught:
        columns(mind_of(["v"], ["d"], ["eat", "eat_a"]), world_of(["a_b", "b"]))
    assert str(caught.value) == (
        'behaviour "eat_a" with object type "b" and behaviour "eat" with object type "a_b"'
        " give one column, likelihood_eat_a_b"
    )
    with pytest.raises(SettingsError, match="2 are called"):
        CaseSettings(worlds={"a": WorldChoice(name="b"), "b": WorldChoice()})


BAD = ["", " a", "a ", "a\nb", "a\tb", "a\x1b[0m", "_a", "a/b", "e\u0301", "a\u200bb", "a\u2028b"]


@pytest.mark.parametrize("name", BAD, ids=ascii)
def test_what_cannot_be_shown_is_no_name_anywhere(name):
    worlds = {"a": WorldChoice()}
    for wrong in (
        lambda: mind_of([name], ["d"], ["b"]),
        lambda: mind_of(["v"], [name], ["b"]),
        lambda: mind_of(["v"], ["d"], [name]),
        lambda: ObjectType(**{**dict(TABLE_1[0]), "name": name}),
        lambda: ObjectType(**{**dict(TABLE_1[0]), "features": {name: 1.0}}),
        lambda: ObjectType(**{**dict(TABLE_1[0]), "affords": {name: 1.0}}),
        lambda: World(World.abundant().layout, name),
        lambda: WorldChoice(name=name),
        lambda: CaseSettings(worlds={**worlds, name: WorldChoice()}),
        lambda: cases(Study(name="s", design=Design(grid={name: {"one": {}}}))),
        lambda: cases(Study(name="s", design=Design(grid={"factor": {name: {}}}))),
    ):
        with pytest.raises(SettingsError) as caught:
            wrong()
        assert all("\n" not in line for line in caught.value.problems)


@pytest.mark.parametrize("name", [n for n in (*LIVES, *OF_A_STUDY) if "{" not in n])
def test_no_factor_is_called_like_a_column(name):
    grid: Any = {name: {"one": {"mind.agent": "BLIND"}, "two": {"mind.agent": "ORACLE"}}}
    with pytest.raises(SettingsError, match=f"like the column {name} of a table|is a section"):
        cases(Study(name="s", design=Design(grid=grid)))

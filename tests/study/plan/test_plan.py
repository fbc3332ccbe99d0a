"""The plan of a study: which lives there are, and that equal ones are lived once."""

from __future__ import annotations

import pytest

from animat.files.settings import SettingsError
from animat.study.file.settings import WorldChoice
from animat.study.plan import plan as module
from animat.study.plan.numbering import Part
from animat.study.plan.plan import LIFE_STEPS, TEACHER_STEPS, plan_of, world_of

STUDY = """
name = "plan"
lives = 30
steps = 1_000
[teacher]
robots = 20
steps = 2_000
[design.grid]
"mind.agent" = ["BLIND", "AF", "ORACLE"]
"mind.learning.cycles" = [10, 1]
"mind.likelihood_threshold" = [0.5, 0.8]
"""


@pytest.fixture(scope="module")
def plan(faults):
    return faults.plan(STUDY)


def test_cases_of_equal_lives_are_lived_once(plan):
    factors = [tuple(case.factors.values()) for case in plan.cases]
    lived_by = [factors[number] for number in plan.same_as]
    for own, other in zip(factors, lived_by, strict=True):
        agent, cycles, threshold = own
        expected = {
            "BLIND": ("BLIND", 10, 0.5),
            "AF": (agent, cycles, threshold),
            "ORACLE": ("ORACLE", 10, threshold),
        }[agent]
        assert other == expected
    assert len(plan.lived) == 1 + 4 + 2
    assert plan.shares == [4, 1, 1, 1, 1, 2, 2]
    assert sum(plan.shares) == len(plan.cases)


def test_robots_that_learn_alike_are_one_class(plan):
    assert len(plan.classes) == 2
    classes = {}
    for place, case in enumerate(plan.lived):
        own = plan.class_of(place)
        assert (own is None) == (case.settings.mind.agent != "AF")
        if own is not None:
            classes.setdefault(case.factors["mind.learning.cycles"], set()).add(own)
    assert classes == {10: {0}, 1: {1}}
    assert plan.steps_to_learn == 2 * 20 * 2_000


def test_a_class_is_as_large_as_the_largest_who_needs_it(faults):
    plan = faults.plan(
        STUDY.replace('"mind.likelihood_threshold" = [0.5, 0.8]', '"teacher.robots" = [3, 20]')
    )
    assert [each.robots for each in plan.classes] == [20, 20]
    assert len(plan.lived) == 1 + 4 + 1


def test_there_are_as_many_lives_as_cases_that_are_lived_have(plan):
    assert plan.numbering["lives"].total == 7 * 30
    assert plan.numbering["teachers"].total == 2 * 20
    parts = list(plan.all_parts())
    assert len(parts) == len(set(parts))
    assert sum(plan.numbering[part.kind].rows(part.number) for part in parts) == 7 * 30 + 2 * 20
    assert [part.number for part in plan.parts_of_class(1)] == [2, 3, 4]


def test_a_plan_is_a_function_of_the_study_alone(plan):
    again = plan_of(plan.text + "\n# a remark\n")
    assert again is not plan
    assert again.text == plan.text
    assert again.identities == plan.identities
    assert again.numbering == plan.numbering
    assert plan_of(plan.text) is plan_of(plan.text)


def test_unpaired_cases_share_no_lives(faults):
    plan = faults.plan(STUDY.replace("steps = 1_000", "steps = 1_000\npaired = false"))
    assert plan.same_as == list(range(12))
    assert len(set(plan.identities)) == 12


def test_long_lives_make_small_parts(faults):
    text = STUDY.replace("lives = 30", "lives = 100_000")
    for steps, robots_steps in ((100, 1_000), (300_000, 300_000), (10**9, 10**9)):
        plan = faults.plan(text.replace("1_000", str(steps)).replace("2_000", str(robots_steps)))
        for kind, most, cap in (
            ("lives", LIFE_STEPS, steps),
            ("teachers", TEACHER_STEPS, robots_steps),
        ):
            rows = plan.numbering[kind].rows(0)
            assert rows == 1 or rows * cap <= most


def test_the_table_of_cases_has_a_column_for_each_factor(plan):
    table = plan.case_table()
    assert table.column_names == [
        "case",
        "mind.agent",
        "mind.learning.cycles",
        "mind.likelihood_threshold",
        "identity",
        "same_as",
    ]
    for row, case in zip(table.to_pylist(), plan.cases, strict=True):
        assert row["case"] == case.number
        assert {name: row[name] for name in case.factors} == case.factors


def test_factors_of_several_kinds_become_texts_and_numbers_numbers():
    columns = {
        "numbers": ([1, 0.5, None], [1.0, 0.5, None]),
        "kinds": ([1, "a", True, None], ["1", "a", "True", None]),
        "truths": ([True, False], [True, False]),
        "whole": ([1, 2], [1, 2]),
    }
    for values, expected in columns.values():
        assert module._alike(values).to_pylist() == expected


def test_a_mistake_is_told_with_the_cases_that_have_it(faults):
    with pytest.raises(SettingsError, match="spare sites") as refused:
        faults.plan(STUDY + '"mind.consumed" = [false, true]\n')
    assert "mind.consumed = true (12 of 24 cases)" in str(refused.value)


def test_the_files_a_study_draws_on_are_known(faults, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.py").write_text(
        "def walk(readings, aheads, sides, memory, u_a, u_b, speed, turn):\n"
        "    return speed, speed\n"
    )
    world_of(WorldChoice()).save(tmp_path / "mine.toml")
    plan = faults.plan(
        'name = "files"\nsteps = 5\n[design.grid]\n"mind.wander" = ["curved", "own.py:walk"]\n'
        '"world.layout" = ["abundant", "mine.toml"]\n'
    )
    assert plan.inputs == {"own.py", "mine.toml"}
    # A world counts by what it holds, not by its file.
    assert plan.same_as == [0, 0, 2, 2]
    assert plan.setting(1).functions is plan.setting(1).functions
    assert plan.setting(1).functions.wander is not plan.setting(0).functions.wander


def test_pieces_are_of_the_kind_asked_for(plan):
    assert [piece.place for piece in plan.pieces(Part("lives", 3))] == [0, 1]
    assert [piece.place for piece in plan.pieces(Part("teachers", 2))] == [0, 1]

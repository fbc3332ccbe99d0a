"""Mistakes in designs: every one is told, where it stands, at once, and in a sensible number."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

from animat.files.settings import SettingsError, validated
from animat.study.file.cases import cases, excluded
from animat.study.file.check import MOST_CASES, design_mistakes, varied_keys, without
from animat.study.file.study import Study
from animat.study.plan.columns import schema
from animat.study.plan.numbering import KINDS
from animat.study.plan.plan import Plan


def study_of(text: str) -> Study:
    return validated({"name": "x", **tomllib.loads(text)}, Study)


def refused(text: str) -> list[str]:
    study = study_of(text)
    with pytest.raises(SettingsError) as caught:
        cases(study)
    return list(caught.value.problems)


GRID = "[design.grid]\n"
OVER = '[design.sample]\nmethod = "sobol"\npoints = 4\n[design.sample.over]\n'
AF = "the agent AF needs networks that a robot has learnt: add a section [teacher]"

MISTAKES = {
    "a value": (
        GRID + '"mind.agent" = ["ORACLE", "BLINDD"]',
        'key design.grid."mind.agent"[1] = "BLINDD": must be one of "BLIND", "AF", "LEARNING",'
        ' "ORACLE", "RANDOM"; did you mean "BLIND"?',
    ),
    "a key": (
        GRID + '"mind.agnt" = ["BLIND", "ORACLE"]',
        'key design.grid."mind.agnt": unknown key; did you mean "mind.agent"?',
    ),
    "no key": (GRID + '"mind agent" = [1]', '"mind agent" is no key; write it as mind.learning'),
    "one for the study": (
        GRID + "lives = [1, 2]",
        "key design.grid.lives: is no setting that may vary; keys begin with world, robot, mind",
    ),
    "half a key": (
        GRID + 'physiology = ["decay"]',
        'key design.grid.physiology: is no setting that may vary; did you mean "mind.physiology"?',
    ),
    "a value of a level": (
        GRID + 'mine = { a = { "mind.success_effect" = 2 } }',
        'key design.grid.mine.a."mind.success_effect" = 2: must be less than or equal to 1',
    ),
    "a key of a level": (
        GRID + 'mine = { a = { "world.layuot" = "scarce" } }',
        'key design.grid.mine.a."world.layuot": unknown key; did you mean "world.layout"?',
    ),
    "a section of a level": (
        GRID + 'mine = { a = { mind.agent = "ORACLE" } }',
        'key design.grid.mine.a.mind: is a section; give its settings one by one, "mind.KEY" =',
    ),
    "inside a level": (
        GRID + 'mine = { a = { "mind.drives.cold" = { a = { nutrition = "1" } } } }',
        'key design.grid.mine.a."mind.drives.cold".a.nutrition = "1": must be a number',
    ),
    "a section": (GRID + '"mind.learning" = [3]', 'design.grid."mind.learning"[0] = 3: must be a'),
    "a bare section": (
        GRID + 'mind = { learning = { "mind.gate" = "always" } }',
        "key design.grid.mind: is a section; for the values of a setting quote its key",
    ),
    "a name with a dot": (
        GRID + '"mind.agent" = { a = {} }',
        'key design.grid."mind.agent": a factor with levels needs a name of your own',
    ),
    "a column": (
        GRID + "agent = { a = {} }",
        "key design.grid.agent: is called like the column agent",
    ),
    "a name twice": (
        GRID + "mine = { a = {} }\n" + OVER + "mine = { a = {} }",
        "key design.sample.over.mine: another factor has this name",
    ),
    "a key twice": (
        GRID + '"mind.gate" = ["always"]\nmine = { a = { "mind.gate" = "positive" } }',
        'key design.grid.mine.a."mind.gate": design.grid."mind.gate" sets mind.gate, too',
    ),
    "a key and a part of it": (
        GRID + '"mind.drives.hunger.a.nutrition" = [1]\n'
        'mine = { a = { "mind.drives" = { hunger = { a = { nutrition = 1 } } } } }',
        'key design.grid.mine.a."mind.drives": design.grid."mind.drives.hunger.a.nutrition" sets',
    ),
    "a part and its whole": (
        GRID + 'mine = { a = { "mind.behaviours.eat" = { serves = "hunger", needs = "grasp" } } }\n'
        '"mind.behaviours.eat.needs" = ["grasp"]',
        'design.grid."mind.behaviours.eat.needs": design.grid.mine sets mind.behaviours.eat.needs',
    ),
    "an end of a range": (
        OVER + '"mind.success_effect" = { low = 0.5, high = 1.5 }',
        'design.sample.over."mind.success_effect".high = 1.5: must be less than or equal to 1',
    ),
    "a broken range": (
        OVER + '"mind.learning.cycles" = { low = 1.5, high = 4 }',
        'key design.sample.over."mind.learning.cycles".low = 1.5: must be a whole number',
    ),
    "a range of no numbers": (
        OVER + '"mind.consumed" = { low = 0, high = 1 }',
        'key design.sample.over."mind.consumed": is no number, so it has no range; give a list',
    ),
    "a listed case": (
        '[[design.cases]]\n"mind.gate" = "always"\n[[design.cases]]\n"mind.gate" = "alway"',
        'key design.cases[1]."mind.gate" = "alway": must be one of "positive", "always"',
    ),
    "a case twice": (
        '[[design.cases]]\n"mind.success_effect" = 1\n'
        '[[design.cases]]\n"mind.success_effect" = 1.0',
        "key design.cases[1]: is the same as design.cases[0]",
    ),
    "an unknown factor": (
        GRID + '"mind.gate" = ["always"]\n'
        '[[design.exclude]]\nwhen = { "mind.gat" = "always" }\nwhy = "so"',
        'key design.exclude[0].when."mind.gat": is no factor of the design; did you mean',
    ),
    "an unknown value": (
        GRID + '"mind.gate" = ["always"]\n'
        '[[design.exclude]]\nwhen = { "mind.gate" = ["alway"] }\nwhy = "so"',
        'design.exclude[0].when."mind.gate": "alway" is none of its values; did you mean "always"',
    ),
    "a value of a range": (
        OVER + '"mind.success_effect" = { low = 0.1, high = 0.2 }\n'
        '[[design.exclude]]\nwhen = { "mind.success_effect" = 0.1 }\nwhy = "so"',
        "is spread over a range, of which no value can be named",
    ),
    "nothing left": (
        GRID + '"mind.gate" = ["always"]\n'
        '[[design.exclude]]\nwhen = { "mind.gate" = "always" }\nwhy = "so"',
        "key design.exclude: leaves no case",
    ),
    "no teacher": (GRID + '"mind.gate" = ["always"]\n[mind]\nagent = "AF"', AF),
    "no teacher for some": (
        GRID + '"mind.agent" = ["BLIND", "AF"]\n"mind.gate" = ["always", "positive"]',
        f'where mind.agent = "AF" (2 of 4 cases): {AF}',
    ),
    "what does not go together": (
        GRID + '"mind.contact_range" = [10, 50]\n"mind.encounter_range" = [20, 60]\n'
        '"mind.gate" = ["always", "positive"]',
        "where mind.contact_range = 50, mind.encounter_range = 20 (2 of 8 cases): key mind:"
        " contact_range = 50.0 is wider than encounter_range = 20.0",
    ),
    "an unknown variable": (
        GRID + '"mind.variables.nutritoin.rate" = [1e-3]',
        "key mind: variables.nutritoin: a new variable must give law, rate and set_point",
    ),
    "an unknown world": (
        GRID + '"world.layout" = ["scarce", "rihc"]\n[worlds.rich]',
        'where world.layout = "rihc" (1 of 2 cases): key world.layout: world "rihc": no such world',
    ),
    "an unknown world of the teacher": (
        '[mind]\nagent = "AF"\n[teacher]\nworld = "abundnt"',
        'key teacher.world.layout: world "abundnt": no such world',
    ),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_is_one_line_that_says_where(case):
    text, told = MISTAKES[case]
    (line,) = refused(text)
    assert told in line


def test_every_mistake_is_told_at_once():
    lines = refused(
        '[design.grid]\n"mind.agent" = ["BLINDD", "AF"]\n"mind.zzz" = [1]\n'
        'mine = { a = { "mind.success_effect" = 2 }, b = {} }\n'
        '[[design.cases]]\n"mind.gat" = 1\n[[design.cases]]\n"mind.gate" = "always"\n'
    )
    for told in ('"BLINDD"', "mind.zzz", "mind.success_effect", "mind.gat", AF):
        assert sum(told in line for line in lines) == 1
    assert len(lines) == 5


def test_what_only_a_lost_rule_lets_in_is_not_told():
    (line,) = refused(
        '[design.grid]\n"mind.agnt" = ["x"]\n"mind.agent" = ["AF", "BLIND"]\n'
        '[[design.exclude]]\nwhen = { "mind.agent" = "AF", "mind.agnt" = "x" }\nwhy = "so"'
    )
    assert "unknown key" in line


def test_of_very_many_mistakes_the_first_are_told():
    values = ", ".join(f'"A{number}"' for number in range(1_000))
    lines = refused(f'[design.grid]\n"mind.agent" = [{values}]')
    assert len(lines) == 21
    assert lines[-1] == "... and 980 mistakes more"


HUGE = "[design.grid]\n" + "".join(
    f'"mind.{key}" = {list(range(1, 101))}\n'
    for key in (
        *("interaction_steps", "approach_steps", "leave_steps", "learning.cycles"),
        *("drives.hunger.a.nutrition", "drives.fatigue.a.stamina"),
    )
)


def test_an_enormous_design_is_refused_in_one_line():
    told = "key design: makes 1,000,000,000,000 combinations; allowed are up to 100,000"
    assert refused(HUGE) == [told]
    with pytest.raises(SettingsError, match="1,000,000,000,000"):
        excluded(study_of(HUGE))


def test_what_is_left_out_counts_as_well():
    each = ", ".join(map(str, range(1, 318)))
    text = f'[design.grid]\n"mind.interaction_steps" = [{each}]\n"mind.leave_steps" = [{each}]'
    (line,) = refused(text)
    assert f"{317**2:,} combinations" in line
    assert MOST_CASES < 317**2


def test_a_mistake_of_a_design_is_told_for_what_it_excludes_too():
    study = study_of(MISTAKES["an unknown factor"][0])
    with pytest.raises(SettingsError, match="is no factor"):
        excluded(study)


BY_NAME = {
    "acts_": "acts_BEHAVIOUR",
    "successes_": "successes_BEHAVIOUR",
    "likelihood_": "likelihood_BEHAVIOUR_OBJECT",
}
"""How the columns of behaviours and object types begin, and how they are told."""


def test_no_factor_can_be_taken_for_a_column():
    text = 'measures = ["likelihoods"]\n[teacher]\n[mind]\nagent = "AF"'
    plan = Plan(study_of(text))
    names = {name for kind in KINDS for name in schema(plan, kind).names}
    assert names >= {"lifespan", "weights", "acts_eat", "likelihood_eat_TS"}
    for name in names | {"case", "identity", "same_as"}:
        (line,) = refused(f"[design.grid]\n{name} = {{ a = {{}} }}")
        assert line.startswith(f"key design.grid.{name}: is ")
        if "is a section" not in line:
            column = next((each for start, each in BY_NAME.items() if name.startswith(start)), name)
            assert f"called like the column {column} of a table; give it another name" in line


@pytest.mark.parametrize("case", MISTAKES)
def test_what_is_wrong_is_taken_out_before_looking_further(case):
    """The rest of a design has no mistake of its own, and as many factors and rows as before."""
    design = study_of(MISTAKES[case][0]).design
    found = design_mistakes(design, {"worlds": {"rich": {}}})
    rest = without(design, found)
    if rest is None:
        assert found
        return
    assert design_mistakes(rest, {"worlds": {"rich": {}}}) == []
    assert (rest == design) == (not found)


def test_the_keys_that_a_design_sets():
    text = '[design.grid]\n"mind.gate" = ["always"]\n"a b" = [1]\nmine = { a = { steps = 1 } }'
    assert varied_keys(study_of(text).design) == {("mind", "gate"), ("steps",)}
    assert varied_keys(study_of(HUGE).design) >= {("mind", "learning", "cycles")}


def test_a_design_has_its_mistakes_whatever_the_base():
    base: dict[str, Any] = {"mind": {"agent": 3}}
    design = study_of('[design.grid]\n"mind.gate" = ["alway"]').design
    (mistake,) = design_mistakes(design, base)
    assert mistake.key == ("design", "grid", "mind.gate", 0)
    assert base == {"mind": {"agent": 3}}

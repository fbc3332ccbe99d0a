"""`animat check` as its users meet it."""

from __future__ import annotations

import re

SMALL = """
name = "small"
lives = 2
steps = 500
[teacher]
robots = 2
steps = 100
[design.grid]
"mind.agent" = ["BLIND", "AF"]
"mind.learning.rate" = [0.25, 0.5]
"mind.gate" = ["always", "positive"]
[[design.exclude]]
when = { "mind.agent" = "AF", "mind.gate" = "positive" }
why = "[it] would take too long"
"""


def cells(table: str) -> list[list[str]]:
    """The rows of a printed table that have a number or dots in front."""
    lines = [line for line in table.splitlines() if line.startswith("│")]
    return [[cell.strip() for cell in line.strip("│").split("│")] for line in lines]


def test_it_says_what_would_run_and_what_that_costs(animat, tmp_path):
    (tmp_path / "small.toml").write_text(SMALL)
    said = animat("check", "small.toml")
    assert said.code == 0
    lines = said.out.splitlines()
    assert lines[0] == "small (small.toml): 6 cases, 2 lives each"
    assert cells(said.out) == [
        ["0", "BLIND", "0.25", "always"],
        ["1", "BLIND", "0.25", "positive"],
        ["2", "BLIND", "0.5", "always"],
        ["3", "BLIND", "0.5", "positive"],
        ["4", "AF", "0.25", "always"],
        ["5", "AF", "0.5", "always"],
    ]
    assert "left out: 2 combinations: [it] would take too long" in lines
    assert "simulated once: 2 cases have the same lives as others" in lines
    assert "at most: 4,000 steps of 8 lives, and 400 steps of 4 robots that learn" in lines
    assert any(re.match(r"expected: 1 s on the \d+ cores here, [\d.]+ kB of tab", x) for x in lines)
    assert any(re.match(r"estimated from \d+ lives of 4 cases, up to 20,000 st", x) for x in lines)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["small.toml"]


def test_a_line_is_changed_by_set(animat, tmp_path):
    (tmp_path / "small.toml").write_text(SMALL)
    said = animat("check", "small.toml", "--set", "lives=3", "--set", "design={}")
    assert said.out.startswith(
        "small (small.toml): 1 case, 3 lives each\nat most: 1,500 steps of 3"
    )


def test_a_study_that_comes_with_animat_goes_by_its_name(animat):
    said = animat("check", "experiment2", "--set", "steps=200", "--set", "teacher.steps=10")
    assert said.code == 0
    assert said.out.startswith("experiment2 (")
    assert [row[1:] for row in cells(said.out)] == [
        ["abundant", "BLIND"], ["abundant", "AF"], ["scarce", "BLIND"], ["scarce", "AF"]
    ]  # fmt: skip


def test_of_many_cases_the_first_and_the_last_are_shown(animat, tmp_path):
    keys = ("success_effect", "failure_effect", "gate", "error", "overflow", "failed_act", "agent")
    values = ("[0.1, 0.2, 0.3]", "[0.1, 0.2, 0.3]", '["always", "positive"]', '["signed"]',
              '["clamp"]', '["clamp"]', '["BLIND"]')  # fmt: skip
    grid = "".join(f'"mind.{key}" = {value}\n' for key, value in zip(keys, values, strict=True))
    (tmp_path / "many.toml").write_text(f'name = "many"\nsteps = 50\n[design.grid]\n{grid}')
    said = animat("check", "many.toml")
    rows = cells(said.out)
    numbers = [row[0] for row in rows if row[0]]
    assert numbers == [*map(str, range(12)), "...", "14", "15", "16", "17"]
    assert "mind.success_effect = 0.1" in rows[0][1]


def test_every_mistake_is_one_line(animat, tmp_path):
    text = SMALL.replace('"AF"]\n"mind.l', '"FA"]\n"mind.l').replace("lives = 2", "lifes = 2")
    (tmp_path / "wrong.toml").write_text(text)
    said = animat("check", "wrong.toml", "--set", "mind.gat=always", "--set", "seed=-1")
    assert (said.code, said.out) == (2, "")
    lines = said.err.splitlines()
    assert all(line.startswith("animat: ") for line in lines)
    for told in ('did you mean "AF"?', 'did you mean "lives"?', '"mind.gate"', "--set: key seed"):
        assert any(told in line for line in lines)


def test_what_is_no_study_is_refused(animat, tmp_path):
    (tmp_path / "empty.toml").touch()
    for name, told in {
        "experment2": 'animat: "experment2": no such study, and no .toml file; did you mean',
        "none.toml": "animat: none.toml: no such file",
        "empty.toml": "animat: empty.toml: is empty: it sets nothing",
        ".": 'animat: ".": no such study',
    }.items():
        said = animat("check", name)
        assert (said.code, said.out) == (2, "")
        assert said.err.startswith(told)
        assert said.err.count("\n") == 1
    assert animat("check").code == 2


def test_a_function_that_raises_is_told_of(animat, tmp_path, lost):
    (tmp_path / "own.py").write_text(lost)
    (tmp_path / "fails.toml").write_text(
        'name = "f"\nsteps = 9\n[mind]\nwander = "own.py:walk"\nturn_speed = 1\n'
    )
    said = animat("check", "fails.toml")
    assert said.code == 0
    last = said.out.splitlines()[-1]
    assert re.fullmatch(
        r"\d+ of these \d+ lives fail, such as: wander: walk raised ValueError: lost, in step 0",
        last,
    )

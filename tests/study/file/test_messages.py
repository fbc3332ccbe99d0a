"""How mistakes that cases share are told."""

from __future__ import annotations

from animat.study.file.messages import MOST_LINES, InCases, told


def in_cases(*factors: dict) -> InCases:
    found = InCases(0, factors[0], factors[0])
    for each in factors:
        found = found.and_in(each)
    return found


def test_a_mistake_of_every_case_is_told_as_it_is():
    assert in_cases({"a": 1}, {"a": 2}).told("wrong", 2) == "wrong"


def test_one_of_some_is_told_with_what_these_have_alike():
    found = in_cases({"a": 1, "b": "x"}, {"a": 2, "b": "x"})
    assert found.told("wrong", 1_000) == 'where b = "x" (2 of 1,000 cases): wrong'


def test_one_of_one_case_is_told_with_all_that_makes_it():
    assert in_cases({"a": 1, "b": True}).told("wrong", 4) == (
        "where a = 1, b = true (1 of 4 cases): wrong"
    )


def test_cases_with_nothing_alike_are_told_by_the_first():
    assert in_cases({"a": 1}, {"a": 2}).told("wrong", 3) == (
        "cases such as a = 1 (2 of 3 cases): wrong"
    )


def test_true_is_not_alike_to_one():
    assert in_cases({"a": 1, "b": 2}, {"a": True, "b": 2.0}).alike == {"b": 2}
    assert in_cases({"a": 1}, {}).alike == {}


def test_lines_are_told_once_and_not_without_end():
    assert told(["a", "b", "a"]) == ["a", "b"]
    lines = [str(number) for number in range(MOST_LINES + 2_000)]
    assert told(lines[:MOST_LINES]) == lines[:MOST_LINES]
    assert told(lines) == [*lines[:MOST_LINES], "... and 2,000 mistakes more"]

"""The axes of a design, and which of their combinations are left out."""

from __future__ import annotations

from typing import Any

import pytest

from animat.files.settings import validated
from animat.study.file.axes import axes, combinations, factors, is_whole, left_out, options, size
from animat.study.file.design import Design
from animat.study.file.keys import UnknownKeyError
from animat.study.file.settings import CaseSettings

DESIGN: dict[str, Any] = {
    "grid": {"mind.gate": ["always", "positive"], "mine": {"a": {"steps": 3}, "b": {}, "c": {}}},
    "sample": {
        "method": "latin_hypercube",
        "points": 5,
        "over": {"mind.success_effect": {"low": 0.1, "high": 0.2}, "mind.consumed": [True, False]},
    },
    "cases": [{"mind.failure_effect": 0.1}, {"mind.failure_effect": 0.3}],
    "exclude": [
        {"when": {"mine": ["a", "b"], "mind.gate": "always"}, "why": "one"},
        {"when": {"mine": "b"}, "why": "two"},
    ],
}


@pytest.fixture
def design() -> Design:
    return validated(DESIGN, Design)


def test_a_design_has_an_axis_for_each_factor_for_the_sample_and_for_the_list(design):
    along = axes(design, CaseSettings())
    assert [len(axis) for axis in along] == [2, 3, 5, 2]
    assert size(design) == len(list(combinations(along))) == 60
    assert size(Design()) == 1
    assert list(combinations(axes(Design(), CaseSettings()))) == [()]


def test_the_first_axis_is_the_slowest(design):
    along = axes(design, CaseSettings())
    told = [factors(along, combination) for combination in combinations(along)]
    assert [one["mind.gate"] for one in told] == ["always"] * 30 + ["positive"] * 30
    assert [one["mind.failure_effect"] for one in told] == [0.1, 0.3] * 30
    assert list(told[0]) == [
        "mind.gate", "mine", "mind.success_effect", "mind.consumed", "mind.failure_effect"
    ]  # fmt: skip


def test_an_option_sets_what_its_level_says():
    first, second = options("mine", {"a": {"steps": 3, "mind.gate": "always"}, "b": {}})
    assert first.changes == {("steps",): 3, ("mind", "gate"): "always"}
    assert (second.factors, second.changes) == ({"mine": "b"}, {})
    with pytest.raises(UnknownKeyError):
        options("a b", [1])


def test_the_first_rule_that_fits_leaves_a_combination_out(design):
    along = axes(design, CaseSettings())
    rules = {
        (one["mind.gate"], one["mine"]): left_out(design, along, combination)
        for combination in combinations(along)
        if (one := factors(along, combination))
    }
    assert rules == {
        ("always", "a"): 0, ("always", "b"): 0, ("always", "c"): None,
        ("positive", "a"): None, ("positive", "b"): 1, ("positive", "c"): None,
    }  # fmt: skip


def test_a_list_is_sampled_as_evenly_as_a_range(design):
    points = axes(design, CaseSettings())[2]
    assert sorted(point.factors["mind.consumed"] for point in points) in (
        [False, False, True, True, True], [False, False, False, True, True]
    )  # fmt: skip


def test_settings_of_whole_numbers_are_known():
    assert is_whole(("mind", "learning", "cycles"))
    assert is_whole(("steps",))
    assert is_whole(("world", "counts", "TS"))
    assert not is_whole(("mind", "learning", "rate"))
    assert not is_whole(("mind", "lethal_margin"))
    assert not is_whole(("mind", "drives", "hunger", "a", "nutrition"))

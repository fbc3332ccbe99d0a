"""The methods of a paper, from the settings that were really used."""

import pytest

from animat.report.methods import MOST_CASES, WORDS, model_words, representatives, statistics_words
from animat.statistics.findings import find
from animat.study.file.cases import cases

from ..statistics.designs import crossed, lived
from .small import FOUR, study_of

VERSIONS = {"animat": "0.1.0", "python": "3.11.7", "numpy": "2.4.6", "numba": "0.68.1"}


def said(text, directory):
    return " ".join(model_words(cases(study_of(text, directory)), VERSIONS, 7))


def test_the_model_is_told_with_its_numbers(tmp_path):
    text = said(FOUR, tmp_path)
    for words in (
        "animat 0.1.0 (engine 7, Python 3.11.7, NumPy 2.4.6, Numba 0.68.1)",
        "radius 27.5 mm with 8 infrared sensors (model michel1996, with noise; motion with noise)",
        'the world "abundant" (1000 by 1000 mm; objects: 2 TS',
        'or the world "scarce"',
        "nutrition (law decay, rate 0.0001 per step, set point 0.9, at birth 0.5, zone [0, 1])",
        "restlessness (law growth, rate 0.001 per step, set point 0.1",
        "A variable outside its viability zone ends the life.",
        "hunger (nutrition), fatigue (stamina) and curiosity (restlessness); the error is signed",
        "BLIND acts on whatever object it meets; AF asks networks",
        "eat (serves hunger, needs grasp)",
        "selected by winner take all (gate positive)",
        "within 30 mm of the robot's rim; an act takes 20 steps, an approach at most 100 steps",
        "A success moves the variable served by 0.2 towards satisfaction (overflow: clamp)",
        "Objects used stay.",
        "2 hidden units, with biases",
        "trained by back-propagation at rate 0.5 for 10 cycles",
        "more than 0.05",
        "likelihood is at least 0.5",
    ):
        assert words in text, words
    assert "lethal margin" not in text


def test_what_differs_between_cases_is_told_with_all_its_values(tmp_path):
    text = said(
        """
name = "differing"
[design.grid]
"mind.physiology" = ["excess", "decay"]
"mind.consumed" = [false, true]
"mind.death" = [true, false]
"robot.infrared_noise" = [true, false]
[design.sample]
method = "sobol"
points = 16
[design.sample.over]
"mind.encounter_range" = { low = 20.0, high = 60.0 }
""",
        tmp_path,
    )
    for words in (
        "stamina (law growth or decay,",
        "lethal margin 0 or 0.05",
        "Objects used stay or appear elsewhere.",
        "ends the life, in the cases where robots are mortal",
        "with noise or without noise; motion with noise",
    ):
        assert words in text, words
    low, high = text.split("An object is met within ")[1].split(" mm")[0].split(" to ")
    assert 20.0 <= float(low) < 25.0
    assert 55.0 < float(high) <= 60.0
    assert "Affordances:" not in text


def test_robots_that_cannot_die_are_told_so(tmp_path):
    text = said('name = "learning"\n[mind]\nagent = "LEARNING"\n', tmp_path)
    assert "No variable ends a life." in text
    assert "LEARNING acts on whatever it meets and trains its networks" in text


def test_many_worlds_are_counted(tmp_path):
    text = said(
        'name = "worlds"\n[world]\nlayout = "random"\ncounts = { CS = 2 }\n[design.grid]\n'
        f'"world.seed" = {list(range(12))}',
        tmp_path,
    )
    assert "It lives in one of 12 worlds with 2 objects." in text


def test_of_many_cases_those_are_read_that_show_every_value(tmp_path):
    study = study_of(
        f"""
name = "many"
[design.grid]
"mind.interaction_steps" = {list(range(1, 21))}
"mind.approach_steps" = {list(range(1, 21))}
"mind.gate" = ["positive", "always"]
""",
        tmp_path,
    )
    every = cases(study)
    assert len(every) > MOST_CASES
    few = representatives(every)
    assert len(few) < 60
    for name in study.design.grid:
        assert {c.factors[name] for c in few} == {c.factors[name] for c in every}


def compared(cases, lives, factors, **given):
    return " ".join(statistics_words(find(lived(cases, lives, **given), factors), "1.2.3"))


def test_only_what_was_done_is_told():
    cases = [(one, 300.0) for one in crossed(agent=["BLIND", "AF"], world=["rich", "poor"])]
    text = compared(cases, 25, ["agent", "world"])
    assert WORDS["stratified log-rank"] in text
    assert "Kruskal" not in text
    assert "Spearman" not in text
    assert "2 tests of factors" in text
    assert "within single combinations by the log-rank test" in text
    assert "6 comparisons" in text
    assert "2 tests of interactions and for the 2 tests of contrasts" in text
    assert "matched-pairs rank-biserial" in text
    assert "Cliff's delta" not in text
    assert "SciPy 1.2.3" in text
    assert "sets of lives" in text
    assert "every life ended" in text.lower()


def test_of_a_single_factor_the_test_has_no_strata():
    text = compared([({"agent": name}, 300.0) for name in ("BLIND", "AF")], 25, ["agent"])
    assert "were tested by the log-rank test. Effect" in text


def test_without_pairs_effect_sizes_are_not_told_as_paired():
    cases = [({"agent": name}, 300.0) for name in ("BLIND", "AF")]
    text = compared(cases, 25, ["agent"], paired=False)
    assert "Cliff's delta" in text
    assert "within pairs" not in text
    assert "interaction" not in text


def test_a_range_is_told_as_it_was_tested():
    cases = [({"gap": k / 30}, 300.0) for k in range(30)]
    text = compared(cases, 3, ["gap"])
    assert WORDS["Spearman"] in text
    assert "cases, each with all its lives" in text


def test_where_nothing_was_compared_no_test_is_told():
    assert "Holm" not in compared([({}, 300.0)], 20, [])
    assert "Holm" not in compared([({"a": k}, 300.0) for k in (1, 2)], 9, ["a"], cap=1)


@pytest.mark.parametrize("cap", [100, 10**6])
def test_the_restriction_is_told(cap):
    text = compared([({}, 300.0)], 20, [], cap=cap)
    assert ("up to 100 steps" in text) == (cap == 100)

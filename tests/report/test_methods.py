"""The methods of a paper, from the settings that were really used."""

from animat.report.methods import MOST_CASES, model_words, representatives
from animat.study.file.cases import cases

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

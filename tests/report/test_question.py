"""A study file in plain words."""

import pytest

from animat.report.question import asked_section
from animat.study.file.cases import cases

from .small import FOUR, study_of

EVERYTHING = """
name = "everything"
lives = 1
paired = false
measures = ["likelihoods", "learning_curve"]
[record]
what = "last:50"
[worlds.rich]
layout = "random"
counts = { TS = 3 }
[design.grid]
"steps" = [100, 200]
[design.grid.meal]
"small and slow" = { "mind.success_effect" = 0.1, "mind.interaction_steps" = 40 }
"as in the paper" = {}
[design.sample]
method = "latin_hypercube"
points = 3
seed = 5
[design.sample.over]
"mind.failure_effect" = { low = 0.1, high = 0.3 }
"mind.learning.rate" = { low = 0.05, high = 2.0, scale = "log" }
"mind.overflow" = ["clamp", "lethal"]
[[design.cases]]
"world.layout" = "rich"
[[design.cases]]
"world.layout" = "scarce"
[[design.exclude]]
when = { meal = "small and slow", steps = 100 }
why = "it would starve"
"""


def said(text, directory):
    study = study_of(text, directory)
    section = asked_section(study, cases(study))
    return section, " ".join([*section.paragraphs, *section.items])


def test_size_pairing_and_teacher_are_told(tmp_path):
    section, text = said(FOUR, tmp_path)
    assert "4 cases of 25 lives each, up to 3,000 steps a life, from seed 3" in text
    assert "Paired (common random numbers): life i of every case" in text
    assert "not due to" not in text
    assert "3 robots learnt before" in text
    assert "for 1,500 steps in the world abundant" in text
    assert "what its networks say" in text
    assert list(section.items) == [
        "world.layout: abundant, scarce", "mind.agent: BLIND, AF", "every combination of these",
    ]  # fmt: skip


def test_every_way_to_vary_is_told(tmp_path):
    section, text = said(EVERYTHING, tmp_path)
    for words in (
        "18 cases of 1 life each, up to 100 or 200 steps a life",
        "Not paired",
        "the trace (last:50) of the first 1 lives",
        "how they came to say it",
        "steps: 100, 200",
        'meal: small and slow (mind.success_effect = 0.1, mind.interaction_steps = 40), as in the'
        " paper (nothing set)",
        "3 points spread by a Latin hypercube (seed 5) over mind.failure_effect from 0.1 to 0.3;"
        " mind.learning.rate from 0.05 to 2, evenly over its logarithm; mind.overflow clamp,"
        " lethal",
        "2 cases given one by one, which set world.layout",
        "left out, 6 combinations: it would starve",
    ):  # fmt: skip
        assert words in text
    assert "robots learnt" not in text
    (picture,) = section.pictures
    assert picture.caption == 'The worlds "rich" and "scarce", to scale.'


def test_a_study_of_one_case_is_told_as_one(tmp_path):
    section, text = said('name = "one"\nlives = 2\n', tmp_path)
    assert "One case of 2 lives, up to 300,000 steps a life" in text
    assert list(section.items) == []
    assert len(section.pictures) == 1


@pytest.mark.parametrize(("worlds", "drawn"), [(3, 1), (4, 0)])
def test_worlds_are_drawn_where_they_are_few(tmp_path, worlds, drawn):
    text = 'name = "worlds"\n[world]\nlayout = "random"\ncounts = { TS = 1 }\n[design.grid]\n'
    section, _ = said(text + f'"world.seed" = {list(range(worlds))}', tmp_path)
    assert len(section.pictures) == drawn


def test_a_long_list_is_cut(tmp_path):
    text = f'name = "long"\n[design.grid]\n"mind.interaction_steps" = {list(range(1, 31))}'
    _, told = said(text, tmp_path)
    assert "7, 8, ... (30 in all)" in told

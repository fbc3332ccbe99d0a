import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from animat.mind.mind import Mind
from animat.mind.parameters import parameters
from animat.mind.selection import (
    AFFORDANCE_TIMES_DRIVE,
    CUSTOM_SELECTOR,
    RANDOM,
    WINNER_TAKE_ALL,
    affordance_times_drive,
    random,
    select,
    winner_take_all,
)
from animat.numerics.compiled import compiled

NO_MEMORY = np.zeros(4)
AFFORDANCES = ("grasp", "shelter", "interact")


@st.composite
def choices(draw):
    """Drives [D], likelihoods [B], and the drive each behaviour serves [B]; ties are common."""
    d, b = draw(st.integers(1, 5)), draw(st.integers(1, 6))
    drives = draw(st.lists(st.integers(-4, 4), min_size=d, max_size=d))
    likelihoods = draw(st.lists(st.sampled_from([0, 0.25, 0.5, 1]), min_size=b, max_size=b))
    serves = draw(st.lists(st.integers(0, d - 1), min_size=b, max_size=b))
    return np.array(drives, float), np.array(likelihoods, float), np.array(serves)


@given(choices(), st.floats(0, 1, exclude_max=True))
def test_the_winner_takes_all(choice, u):
    drives, likelihoods, serves = choice
    serving = np.flatnonzero(serves == np.argmax(drives))
    wanted = serving[0] if len(serving) else -1
    assert winner_take_all(drives, likelihoods, serves, u, NO_MEMORY) == wanted


def test_of_equal_drives_the_first_wins_whatever_the_order_of_the_behaviours():
    drives = np.array([0.2, 0.4, 0.4])
    assert winner_take_all(drives, np.ones(3), np.array([2, 1, 0]), 0.9, NO_MEMORY) == 1
    assert winner_take_all(drives, np.zeros(3), np.array([1, 1, 2]), 0.9, NO_MEMORY) == 0
    assert winner_take_all(drives, np.ones(2), np.array([0, 2]), 0.9, NO_MEMORY) == -1


@given(choices(), st.floats(0, 1, exclude_max=True))
def test_affordance_times_drive_takes_the_largest_product(choice, u):
    drives, likelihoods, serves = choice
    wanted = np.argmax(drives[serves] * likelihoods)
    assert affordance_times_drive(drives, likelihoods, serves, u, NO_MEMORY) == wanted


def test_a_random_choice_is_uniform_and_heeds_nothing_but_its_number():
    serves = np.array([0, 0, 1, 2, 1])
    numbers = np.random.default_rng(1).random(20_000)
    chosen = [random(np.zeros(3), np.zeros(5), serves, u, NO_MEMORY) for u in numbers]
    counts = np.bincount(chosen, minlength=5)
    assert len(counts) == 5
    assert stats.chisquare(counts).pvalue > 1e-4
    assert random(np.zeros(3), np.zeros(5), serves, 1 - 2.0**-32, NO_MEMORY) == 4
    assert random(np.zeros(3), np.zeros(5), serves, 0.0, NO_MEMORY) == 0


@compiled
def never(drives, likelihoods, serves, u, memory):
    return -1


@pytest.mark.parametrize(
    ("selector", "wanted"),
    [(WINNER_TAKE_ALL, 1), (AFFORDANCE_TIMES_DRIVE, 0), (RANDOM, 2), (CUSTOM_SELECTOR, -1)],
)
def test_each_selector_answers_to_its_code(selector, wanted):
    drives, likelihoods = np.array([0.3, 0.4, 0.1]), np.array([1.0, 0.1, 1.0])
    assert select(selector, drives, likelihoods, np.arange(3), 0.99, NO_MEMORY, never) == wanted


@pytest.mark.parametrize(
    ("mind", "code"),
    [
        ({}, WINNER_TAKE_ALL),
        ({"agent": "RANDOM"}, RANDOM),
        ({"agent": "RANDOM", "selector": "winner_take_all"}, WINNER_TAKE_ALL),
        ({"selector": "random"}, RANDOM),
        ({"selector": "affordance_times_drive"}, AFFORDANCE_TIMES_DRIVE),
        ({"selector": never.py_func}, CUSTOM_SELECTOR),
        ({"selector": "mine.py:never"}, CUSTOM_SELECTOR),
    ],
)
def test_the_selector_is_the_agents_unless_the_mind_names_another(mind, code):
    assert parameters(Mind(**mind), AFFORDANCES).selector == code

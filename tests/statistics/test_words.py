import pytest

from animat.statistics.words import listed, word, words


@pytest.mark.parametrize(
    ("value", "said"),
    [(True, "yes"), (False, "no"), (1e-4, "0.0001"), (30.0, "30"), (300_000, "300,000"),
     ("clamp", "clamp")],
)  # fmt: skip
def test_a_value_in_words(value, said):
    assert word(value) == said


def test_values_that_differ_are_never_said_alike():
    assert word(0.12345678) != word(0.12345679)
    assert words([0.1, 0.10000001]) == "0.1 or 0.10000001"
    assert words([0.5, 0.1 + 0.2]) == "0.3 or 0.5"


def test_values_are_said_once_numbers_in_their_order():
    assert words([20, 10, 20], "steps") == "10 or 20 steps"
    assert words(["lethal", "clamp", "lethal"]) == "lethal or clamp"
    assert words([0.5] * 9) == "0.5"


def test_many_values_are_said_by_their_ends_or_their_number():
    assert words([k / 10 for k in range(20)], "mm") == "0 to 1.9 mm"
    assert words([f"name {k}" for k in range(20)]) == "one of 20 values"
    assert words([True, False]) == "yes or no"


def test_names_are_listed():
    assert listed([]) == ""
    assert listed(["a"]) == "a"
    assert listed(["a", "b", "c"]) == "a, b and c"

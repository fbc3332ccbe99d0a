import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.statistics.numerals import listed, numerals, shortened, word, words

numbers = st.lists(
    st.floats(allow_nan=False, allow_infinity=False).map(lambda x: x + 0.0)
    | st.integers(-(10**20), 10**20)
    | st.integers(0, 9).map(lambda k: 0.1 + k * 2**-55)
)


@given(numbers)
def test_different_numbers_never_look_alike_and_say_no_more_than_that_takes(values):
    said = numerals(values)
    assert set(said) == set(values)
    assert len(set(said.values())) == len(said)
    short = [f"{v:.6g}" if isinstance(v, float) else str(v) for v in said]
    for value, text in zip(said, short, strict=True):
        assert float(said[value]) == pytest.approx(value, rel=1e-5)
        assert said[value] == text or short.count(text) > 1


def test_as_many_digits_as_tell_numbers_apart():
    assert list(numerals([0.1, 0.25]).values()) == ["0.1", "0.25"]
    assert list(numerals([0.10000001, 0.10000002]).values()) == ["0.10000001", "0.10000002"]
    assert list(numerals([1, 1.0000001]).values()) == ["1", "1.0000001"]


@given(st.lists(st.text("ab…", max_size=30)), st.integers(2, 20))
def test_different_labels_never_look_alike_and_short_ones_are_left_as_they_are(labels, most):
    said = shortened(labels, most)
    assert set(said) == set(labels)
    assert len(set(said.values())) == len(said)
    assert all(said[label] == label for label in labels if len(label) <= most)


def test_long_labels_are_cut_where_they_agree():
    (long,) = shortened(["x" * 45]).values()
    assert long == "x" * 43 + "…"
    laws = ["laws/" + "x" * 60 + end for end in (".py:fast", ".py:slow")]
    one, other = shortened(laws).values()
    assert (one[-5:], other[-5:]) == (":fast", ":slow")
    assert len(one) == len(other) == 44


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

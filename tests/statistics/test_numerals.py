import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.statistics.numerals import numerals, shortened

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

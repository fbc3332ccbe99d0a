"""In what studies differ."""

from hypothesis import given
from hypothesis import strategies as st

from animat.study.store.differences import differences

VALUES = st.recursive(
    st.integers(0, 3) | st.sampled_from(["a", "b"]),
    lambda inner: st.dictionaries(st.sampled_from("xyz"), inner, max_size=3),
    max_leaves=6,
)
TABLES = st.dictionaries(st.sampled_from("pqr"), VALUES, max_size=3)


def test_each_key_that_differs_is_a_line():
    there = {"steps": 10, "name": "a", "mind": {"gate": "always", "learning": {"cycles": 1}}}
    here = {"steps": 10, "name": "b", "mind": {"learning": {"cycles": 2}}, "lives": 3}
    assert differences(there, here) == [
        'name = "a" there and "b" here',
        'mind.gate = "always" there and nothing here',
        "mind.learning.cycles = 1 there and 2 here",
        "lives = nothing there and 3 here",
    ]


@given(one=TABLES, other=TABLES)
def test_there_is_a_line_if_and_only_if_they_differ(one, other):
    assert (differences(one, other) == []) == (one == other)

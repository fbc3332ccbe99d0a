import numpy as np
import pytest
from scipy import stats

from animat.statistics.sobol import sobol_table


def points(count, dimensions, seed=1):
    """Saltelli's points [n * (d + 2), d] in [0, 1)."""
    both = stats.qmc.Sobol(2 * dimensions, rng=seed).random(count)
    a, b = both[:, :dimensions], both[:, dimensions:]
    mixed = [np.where(np.arange(dimensions) == place, b, a) for place in range(dimensions)]
    return np.concatenate([a, b, *mixed])


def ishigami(x):
    x = np.pi * (2.0 * x - 1.0)
    return np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


KNOWN = {("a", "first"): 0.3139, ("b", "first"): 0.4424, ("c", "first"): 0.0,
         ("a", "total"): 0.5576, ("b", "total"): 0.4424, ("c", "total"): 0.2437}  # fmt: skip
"""Of Ishigami's function with 7 and 0.1, from its closed form (Saltelli et al. 2008)."""


def test_the_indices_of_a_known_function_lie_in_their_intervals():
    table = sobol_table({"AF": ishigami(points(1024, 3))}, "abc", resamples=199)
    assert table.num_rows == len(KNOWN)
    for row in table.to_pylist():
        known = KNOWN[row["parameter"], row["order"]]
        assert row["index"] == pytest.approx(known, abs=0.06)
        assert row["low"] - 0.03 <= known <= row["high"] + 0.03
        assert row["high"] - row["low"] < 0.35


def test_a_sum_is_explained_by_its_parts_and_nothing_else():
    x = points(512, 4)
    table = sobol_table({"BLIND": 3.0 * x[:, 0] + x[:, 1]}, "abcd", resamples=99)
    found = {(row["parameter"], row["order"]): row["index"] for row in table.to_pylist()}
    for order in ("first", "total"):
        assert found["a", order] == pytest.approx(0.9, abs=0.03)
        assert found["b", order] == pytest.approx(0.1, abs=0.03)
        assert found["c", order] == pytest.approx(0.0, abs=1e-9)


def test_agents_are_told_apart_and_the_same_seed_gives_the_same_table():
    x = points(64, 2)
    outcomes = {"BLIND": x[:, 0], "AF": x[:, 1]}
    table = sobol_table(outcomes, "ab", resamples=50)
    assert table.equals(sobol_table(outcomes, "ab", resamples=50))
    totals = {(r["agent"], r["parameter"]): r["index"] for r in table.to_pylist()
              if r["order"] == "total"}  # fmt: skip
    assert totals["BLIND", "a"] > 0.9 > 0.1 > totals["BLIND", "b"]
    assert totals["AF", "b"] > 0.9 > 0.1 > totals["AF", "a"]


def test_what_never_varies_has_nothing_to_explain():
    table = sobol_table({"AF": np.full(4 * 4, 7.0)}, "ab", resamples=20)
    assert set(table.column("index").to_pylist()) == {0.0}


def test_points_that_are_missing_are_told():
    with pytest.raises(ValueError, match="15 points are no multiple of 4"):
        sobol_table({"AF": np.zeros(15)}, "ab")

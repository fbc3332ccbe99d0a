import numpy as np
import pyarrow as pa
import pytest
from scipy import stats

from animat.statistics.claims import CLAIMS, RATIOS
from animat.statistics.estimates import share
from animat.statistics.time_limit import time_limit_effects


def universes(numbers, verdict, gain):
    columns = dict.fromkeys(CLAIMS, ["fails"] * len(numbers)) | {"C1": verdict}
    return pa.table(
        {"universe": numbers, **columns, **{name: gain for name in RATIOS}}  # noqa: C420
    )


def test_the_same_universes_are_compared_in_any_order():
    short = universes([0, 1, 2, 3], ["holds", "undecided", "fails", "holds"], [2.0, 1.5, 0.8, 9.0])
    late = universes([2, 0, 1], ["fails", "fails", "holds"], [0.8, 4.0, 3.3])
    rows = {row["outcome"]: row for row in time_limit_effects(short, late).to_pylist()}
    assert list(rows) == [*CLAIMS, *RATIOS]
    c1 = rows["C1"]
    assert (c1["universes"], c1["to_holds"], c1["from_holds"]) == (3, 1, 1)
    assert (c1["value"], c1["low"], c1["high"]) == share(1, 3)
    assert rows["C2"]["value"] == 1.0
    change = np.log([2.0, 2.2, 1.0])
    half = stats.t.ppf(0.975, 2) * change.std(ddof=1) / np.sqrt(3)
    gain = rows["abundant_gain"]
    assert np.log(gain["value"]) == pytest.approx(change.mean())
    assert np.log([gain["low"], gain["high"]]) == pytest.approx(
        [change.mean() - half, change.mean() + half]
    )


def test_what_does_not_change_has_an_interval_of_no_width_and_one_universe_none():
    both = universes([0, 1], ["holds"] * 2, [2.0, 3.0])
    row = time_limit_effects(both, both).to_pylist()[-1]
    assert (row["value"], row["low"], row["high"]) == (1.0, 1.0, 1.0)
    one = universes([0], ["holds"], [2.0])
    row = time_limit_effects(one, universes([0], ["holds"], [4.0])).to_pylist()[-1]
    assert row["value"] == pytest.approx(2.0)
    assert np.isnan(row["low"])

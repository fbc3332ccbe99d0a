"""What the cap does: the same universes with their lives cut at an early and at a late step."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
from scipy import stats

from animat.statistics.claims import CLAIMS, RATIOS
from animat.statistics.estimates import LEVEL, share
from animat.statistics.lives import column


def time_limit_effects(short: pa.Table, long: pa.Table) -> pa.Table:
    """A row for every claim and ratio of lifespans, over the universes that both tables have.

    Columns: `outcome`, `scale`, `universes`, `value`, `low`, `high`, and `to_holds`, `from_holds`.
    Of a claim `value` is the share of universes whose verdict is the same (Wilson's interval), and
    the last two count those that come to hold with the late cap and those that cease to. Of a
    ratio it is the factor by which the late cap changes it, in the geometric mean (t interval).
    """
    both = np.intersect1d(column(short, "universe"), column(long, "universe"))
    early, late = (
        table.filter(pa.array(np.isin(column(table, "universe"), both))).sort_by("universe")
        for table in (short, long)
    )
    rows = []
    for claim in CLAIMS:
        before, after = (np.array(table.column(claim).to_pylist()) for table in (early, late))
        rows.append(
            {
                "outcome": claim,
                "scale": "share",
                "universes": len(both),
                **_named(share(int((before == after).sum()), len(both))),
                "to_holds": int(((before != "holds") & (after == "holds")).sum()),
                "from_holds": int(((before == "holds") & (after != "holds")).sum()),
            }
        )
    for name in RATIOS:
        change = np.log(column(late, name)) - np.log(column(early, name))
        rows.append(
            {
                "outcome": name,
                "scale": "factor",
                "universes": len(both),
                **_named(np.exp(_mean(change))),
                "to_holds": None,
                "from_holds": None,
            }
        )
    return pa.Table.from_pylist(rows)


def _mean(values: np.ndarray) -> np.ndarray:
    """Mean and its t interval, unknown of fewer than two values."""
    if len(values) < 2:
        return np.full(3, values.mean() if len(values) else np.nan) * [1.0, np.nan, np.nan]
    if np.ptp(values) == 0.0:
        return np.full(3, values[0])
    mean = values.mean()
    return np.array([mean, *stats.t.interval(LEVEL, len(values) - 1, mean, stats.sem(values))])


def _named(estimate) -> dict[str, float]:
    return dict(zip(("value", "low", "high"), map(float, estimate), strict=True))

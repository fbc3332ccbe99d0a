"""How often each claim holds over all universes."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from animat.statistics.claims import CLAIMS
from animat.statistics.estimates import share
from animat.statistics.lives import column
from animat.statistics.universes import verdicts_by_value

VERDICTS = ("holds", "undecided", "fails")


def verdict_shares(universes: pa.Table) -> pa.Table:
    """For each claim and verdict the share of universes with Wilson's interval.

    Columns: `claim`, `verdict`, `universes`, `share`, `low`, `high`, and `share_by_value`: the
    share if every universe were judged by its estimates alone, as if they had no error. Many
    lives would turn the shares into these, if the estimates are not biased.
    """
    by_value = verdicts_by_value(universes)
    rows = []
    for claim in CLAIMS:
        judged = column(universes, claim)
        for verdict in VERDICTS:
            count = int(np.sum(judged == verdict))
            value, low, high = share(count, len(judged))
            rows.append(
                {
                    "claim": claim,
                    "verdict": verdict,
                    "universes": count,
                    "share": value,
                    "low": low,
                    "high": high,
                    "share_by_value": by_value[claim].count(verdict) / len(judged),
                }
            )
    return pa.Table.from_pylist(rows)

"""Claims and gains of some of the universes of a multiverse, by the values of a reading.

    python tools/within.py results/multiverse --by physiology --only "failure effect=0.2"

prints for every value in how many universes each claim holds and fails, the median of each gain,
which tenths lie outside, and how many times as large gains and lifespans are as with the first
value; all with 95 % intervals.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.claims import CLAIMS
from animat.statistics.estimates import LEVEL, Estimate, share
from animat.statistics.lives import column
from animat.statistics.marginal_effects import difference

GAINS = ("abundant_gain", "scarce_gain", "worlds_blind")
LIFESPANS = ("mean_abundant_BLIND", "mean_abundant_AF", "mean_scarce_BLIND", "mean_scarce_AF")


def main() -> None:
    """Print what the options ask for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", type=Path, help="what animat multiverse wrote")
    parser.add_argument("--by", required=True, help="a reading")
    parser.add_argument("--only", nargs="*", default=[], metavar="READING=VALUE")
    asked = parser.parse_args()
    universes = pq.read_table(asked.directory / "universes.parquet")
    kept = np.ones(universes.num_rows, bool)
    for condition in asked.only:
        name, _, value = condition.partition("=")
        kept &= column(universes, name).astype(str) == value
    universes = universes.filter(kept)
    had = column(universes, asked.by).astype(str)
    values = sorted(set(had.tolist()))
    for value in values:
        here, first = had == value, had == values[0]
        print(f"{asked.by} {value}: {here.sum():,} universes")
        for claim in CLAIMS:
            verdicts = column(universes, claim)[here]
            told = (
                f"{word} {_percent(share(int((verdicts == word).sum()), len(verdicts)))}"
                for word in ("holds", "fails")
            )
            print(f"  {claim} {', '.join(told)}")
        for name in (*GAINS, *LIFESPANS):
            logs = np.log(column(universes, name))
            factor = difference(logs[here], logs[first], "factor")
            told = "" if value == values[0] else f"; {_told(factor)} times that of {values[0]}"
            print(f"  {name}: {_spread(logs[here])}{told}")


def _spread(logs: NDArray[np.float64]) -> str:
    drawn = stats.bootstrap((logs,), np.median, confidence_level=LEVEL, rng=0, method="percentile")
    ends = drawn.confidence_interval
    median = Estimate(*np.exp([np.median(logs), ends.low, ends.high]).tolist())
    low, high = np.exp(np.quantile(logs, [0.1, 0.9]))
    return f"median {_told(median)}, a tenth below {_number(low)}, a tenth above {_number(high)}"


def _percent(one: Estimate) -> str:
    return f"{100 * one.value:.1f} % ({100 * one.low:.1f} to {100 * one.high:.1f})"


def _told(one: Estimate) -> str:
    return f"{_number(one.value)} ({_number(one.low)} to {_number(one.high)})"


def _number(value: float) -> str:
    return f"{value:,.0f}" if value >= 100.0 else f"{value:.2f}"


if __name__ == "__main__":
    main()

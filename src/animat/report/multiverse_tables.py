"""The tables of a multiverse that are shown on its page and in the terminal."""

from __future__ import annotations

from animat.experiments.multiverse import Multiverse
from animat.report.page import NOT_KNOWN, Badge, TableBlock, interval
from animat.statistics.sufficient_sets import NEARLY_ALL, Condition

WORDS = {
    "C1": "AF outlives BLIND, abundant world",
    "C2": "AF outlives BLIND, scarce world",
    "C3": "longer lives in the abundant world",
    "C4": "gain of nearly 100 %, abundant",
    "C5": "gain of nearly 50 %, scarce",
    "C6": "the abundant gain is the larger one",
    "C7": "the networks match Table 1",
}


def shares_table(found: Multiverse) -> TableBlock:
    """How often each claim holds, is undecided, and fails."""
    rows = {(row["claim"], row["verdict"]): row for row in found.shares.to_pylist()}
    told = []
    for claim, words in WORDS.items():
        each = [rows[claim, verdict] for verdict in ("holds", "undecided", "fails")]
        cells = [interval((row["share"], row["low"], row["high"]), ".1%") for row in each]
        told.append((claim, words, *cells, f"{each[0]['share_by_value']:.1%}"))
    return TableBlock(("", "Claim", "Holds", "Undecided", "Fails", "Holds by its value"), told)


def sets_table(found: Multiverse) -> TableBlock:
    """The smallest sufficient set for each claim, and what fresh universes say of it."""
    rows = []
    for claim, one in found.found.items():
        fresh = found.confirmed.get(claim)
        rows.append(
            (
                claim,
                "none"
                if one is None
                else "; ".join(map(_condition, one.conditions)) or "nothing need be fixed",
                f"{interval(one.share, '.1%')} of {one.universes:,}" if one else NOT_KNOWN,
                f"{interval(fresh.share, '.1%')} of {fresh.universes:,}" if fresh else NOT_KNOWN,
                Badge(fresh.verdict) if fresh else NOT_KNOWN,
            )
        )
    return TableBlock(
        ("Claim", "Set", "Holds in", "In fresh universes", f"{NEARLY_ALL:.0%} or more"), rows
    )


def _condition(one: Condition) -> str:
    return f"{one.reading}: {' or '.join(one.values)}"

"""The tables of the page of a multiverse, in words."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from animat.experiments.multiverse import Multiverse
from animat.report.page import Badge, TableBlock, interval
from animat.statistics.claims import CELLS, EFFECTS
from animat.statistics.estimates import Estimate, mean
from animat.statistics.lives import column
from animat.statistics.marginal_effects import largest_imbalance
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

FORMS = {"points": "+.0%", "factor": ".2f", "difference": "+.2f"}
"""How numbers of each scale of an outcome are written."""


def shares_table(found: Multiverse) -> TableBlock:
    """How often each claim holds, is undecided, and fails."""
    rows = {(row["claim"], row["verdict"]): row for row in found.shares.to_pylist()}
    told = []
    for claim, words in WORDS.items():
        each = [rows[claim, verdict] for verdict in ("holds", "undecided", "fails")]
        cells = [interval(Estimate(row["share"], row["low"], row["high"]), ".1%") for row in each]
        told.append((claim, words, *cells, f"{each[0]['share_by_value']:.1%}"))
    return TableBlock(
        ("", "Claim", "Holds", "Undecided", "Fails", "Holds by its value"),
        told,
        "Share of universes with its 95 % interval (Wilson). By its value: if each universe were"
        " judged by its estimate alone, as if that had no error.",
    )


def interactions_tables(found: Multiverse) -> list[TableBlock]:
    """Which readings depend on each other, how well claims are foretold, and by which rules."""
    rows = [
        (
            row["outcome"] if row["scale"] == "points" else EFFECTS[row["outcome"]],
            f"{row['reading']}: {row['value']}, not {row['against']}",
            f"{row['other']}: {row['other_value']}, not {row['other_against']}",
            format(row["effect_against"], FORMS[row["scale"]]),
            format(row["effect_here"], FORMS[row["scale"]]),
            interval(Estimate(row["interaction"], row["low"], row["high"]), FORMS[row["scale"]]),
        )
        for row in found.interactions.to_pylist()
    ]
    tables = [
        TableBlock(
            ("Of", "Effect of", "Depends on", "Without it", "With it", "Interaction"),
            rows,
            "Effects in points of the share that holds, or as factors on a ratio. Intervals are"
            " simultaneous over all pairs of values. Only interactions whose interval excludes"
            " none at all are shown, the ten clearest of each claim and effect.",
        )
    ]
    if found.foretold is None:
        note = "Models need scikit-learn: pip install animat[multiverse]."
        return [*tables, TableBlock(("Claim", "Models"), [], note)]
    tables.append(
        TableBlock(
            ("Claim", "More frequent answer", "Single readings", "With pairs", "Tree"),
            [
                (
                    one.claim,
                    f"{one.always:.1%}",
                    *(interval(s, ".1%") for s in (one.single, one.pairs, one.tree)),
                )
                for one in found.foretold
            ],
            "Share of universes of which a model that has not seen them foretells rightly whether"
            " the claim holds: ten-fold cross-validation. Logistic models of single readings and of"
            " all pairs, and a tree of ten leaves.",
        )
    )
    leaves = [
        (
            one.claim,
            ", ".join(rule.conditions) or "always",
            f"{rule.universes:,}",
            interval(rule.share, ".0%"),
        )
        for one in found.foretold
        for rule in one.rules
    ]
    note = "The leaves of each tree, fitted to all universes."
    tables.append(TableBlock(("Claim", "Where", "Universes", "Holds in"), leaves, note))
    return tables


def smallest_table(found: Multiverse) -> TableBlock:
    """The smallest set for each claim, and what fresh universes say of it."""
    rows = []
    for claim, one in found.found.items():
        if one is None:
            rows.append((claim, "none", "–", "–", "–"))
            continue
        told = found.confirmed.get(claim)
        rows.append(
            (
                claim,
                "; ".join(map(_condition, one.conditions)) or "nothing need be fixed",
                f"{interval(one.share, '.1%')} of {one.universes:,}",
                f"{interval(told.share, '.1%')} of {told.universes:,}" if told else "–",
                Badge(told.verdict) if told else "–",
            )
        )
    return TableBlock(
        ("Claim", "Set", "Holds in", "In fresh universes", f"{NEARLY_ALL:.0%} or more"), rows
    )


def _condition(one: Condition) -> str:
    return f"{one.reading}: {' or '.join(one.values)}"


def cap_table(cap: pa.Table) -> TableBlock:
    """What a late cap changes in the verdicts and in the ratios."""
    rows = []
    for row in cap.to_pylist():
        value = Estimate(row["value"], row["low"], row["high"])
        if row["scale"] == "share":
            change = f"{row['to_holds']} / {row['from_holds']}"
            rows.append((row["outcome"], interval(value, ".1%"), change, ""))
        else:
            rows.append((EFFECTS[row["outcome"]], "", "", interval(value, ".2f")))
    return TableBlock(
        ("Of", "Same verdict", "Comes to hold / ceases to", "Factor on the ratio"), rows
    )


def cells_table(found: Multiverse) -> TableBlock:
    """Lifespans, survival and success of each cell over all universes."""
    rows = []
    for world, agent in CELLS:
        cells = []
        for what, form in (("mean", ",.0f"), ("alive", ".1%"), ("success", ".1%")):
            values = column(found.table, f"{what}_{world}_{agent}")
            cells.append(interval(mean(values[~np.isnan(values)]), form))
        rows.append((f"{agent}, {world}", *cells))
    return TableBlock(
        ("Cell", "Mean lifespan", "Alive at the cap", "Acts that succeed"),
        rows,
        "Means over universes with their 95 % intervals. universes.parquet and deaths.parquet have"
        " every universe.",
    )


def readings_table(found: Multiverse) -> TableBlock:
    """The readings and their values, and how evenly they are shared out."""
    uneven = largest_imbalance(found.table, found.universes.names())
    return TableBlock(
        ("Reading", "Factor of the study", "Values; the first is compared with"),
        [(one.name, one.factor, ", ".join(one.labels)) for one in found.universes.readings],
        f"Every two values that no rule keeps apart meet in {found.fewest_together:,} universes or"
        " more. Between values of one reading, the share of a value of another differs by up to"
        f" {100 * uneven.points:.0f} points ({uneven.reading}, {uneven.other}): so much of what the"
        " one does is in the effect of the other.",
    )


def left_out_table(found: Multiverse) -> TableBlock:
    """How many universes are left out, and why."""
    rows = [(f"{rule.count // len(CELLS):,}", rule.why) for rule in found.left_out]
    rows.append((f"{found.missing:,}", "a life or a robot of it failed"))
    return TableBlock(("Universes left out", "Why"), rows)

"""A reproduction judged: each of the paper's claims with its number, verdict and how it came about.

A reproduction is one universe; its verdicts are those of `animat.statistics.claims`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa

from animat.statistics.claims import (
    ABUNDANT_GAIN,
    CELLS,
    COMPARED,
    FARTHEST,
    ORDER,
    SCARCE_GAIN,
    Learnt,
    Verdict,
    above,
    lifespan_effects,
    over_robots,
    verdicts,
    within,
)
from animat.statistics.estimates import LEVEL, RESAMPLES, Estimate, Estimates
from animat.statistics.lives import column
from animat.statistics.universes import in_order


class Words(NamedTuple):
    """A claim in words, the paper's number, what is judged, and the effect that is."""

    text: str
    paper: str
    judged: str
    effect: str


_MAGNITUDE = "knowing affordances lengthens life by nearly {} in the {} world"
_WITHIN = "ratio of mean lifespans within {0[0]} to {0[1]}"
_ABOVE = "ratio of mean lifespans AF/BLIND above 1"

WORDS = {
    "C1": Words("AF outlives BLIND in the abundant world", "ratio > 1", _ABOVE, "abundant_gain"),
    "C2": Words("AF outlives BLIND in the scarce world", "ratio > 1", _ABOVE, "scarce_gain"),
    "C3": Words(
        "agents live longer in the abundant world than in the scarce one",
        "ratio > 1, both agents",
        "ratio of mean lifespans abundant/scarce above 1 for both agents, shown for the one that"
        " decides",
        "",
    ),
    "C4": Words(
        _MAGNITUDE.format("100%", "abundant"),
        "ratio ≈ 2",
        _WITHIN.format(ABUNDANT_GAIN),
        "abundant_gain",
    ),
    "C5": Words(
        _MAGNITUDE.format("50%", "scarce"),
        "ratio ≈ 1.5",
        _WITHIN.format(SCARCE_GAIN),
        "scarce_gain",
    ),
    "C6": Words(
        "the gain in the abundant world exceeds the gain in the scarce world",
        "2 − 1.5 = 0.5 > 0",
        "difference of the two ratios AF/BLIND above 0",
        "gain_difference",
    ),
    "C7": Words(
        "the networks learn what each object affords",
        "likelihood close to 1 where afforded, else close to 0",
        "largest distance of a mean likelihood from Table 1",
        "",
    ),
}

WORLDS = {"BLIND": "worlds_blind", "AF": "worlds_af"}
"""The effects behind C3, by the agent."""


class Part(NamedTuple):
    """One of several numbers behind a claim."""

    label: str
    ours: float
    low: float
    high: float
    verdict: Verdict


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, our number with its interval, the verdict and how it came about."""

    id: str
    text: str
    paper: str
    ours: float
    low: float
    high: float
    verdict: Verdict
    how: str
    parts: tuple[Part, ...] = ()


def judge(
    lives: pa.Table, likelihoods: pa.Table, *, seed: int = 0, resamples: int = RESAMPLES
) -> list[Claim]:
    """All seven claims, from the lives of the four cells and the likelihoods of Experiment 1.

    Lives of one number share their random numbers; one that is missing in a cell is left out in
    all. `likelihoods` has the columns `seed` (of the robot), `network`, `object`, `likelihood` and
    `afforded` (Table 1's probability). Raises ValueError if a cell or a likelihood is missing.
    """
    kept = _in_all_cells(lives)
    kept = kept.append_column("universe", pa.array(np.zeros(kept.num_rows, np.int64)))
    numbers, order = in_order(kept)
    spans, alive = (
        column(kept, name)[order].reshape(1, len(CELLS), -1) for name in ("lifespan", "censored")
    )
    spans, alive = spans.astype(np.float64), alive.astype(bool)
    found = lifespan_effects(spans, alive, seed=seed, resamples=resamples)
    effects = {name: each.at(0) for name, each in found.items()}
    robots = {"universe": pa.array(np.zeros(likelihoods.num_rows, np.int64))}
    robots |= {name: likelihoods[name] for name in likelihoods.column_names}
    learnt = Learnt(pa.table(robots).rename_columns({"seed": "robot"}), numbers)
    far, said = (
        Estimates(*(part[0] for part in over_robots(values, seed, resamples)))
        for values in (learnt.away, learnt.said)
    )
    distances = [far.at(pair) for pair in range(len(learnt.pairs))]
    judged = verdicts(effects, distances)

    def how(effect: str) -> str:
        cells = list(COMPARED[effect])
        told = "paired bootstrap over lives"
        if not alive[0, cells].any():
            return told
        return (
            f"{told}, means restricted at {spans.max():,.0f} steps"
            f" ({alive[0, cells].sum()} of {alive[0, cells].size} lives went on)"
        )

    def claim(name: str, ours: Estimate, told: str, parts: Sequence[Part] = ()) -> Claim:
        words = WORDS[name]
        return Claim(
            name, words.text, words.paper, *ours, judged[name], words.judged + told, tuple(parts)
        )

    claims = [
        claim(name, effects[words.effect], f"; {how(words.effect)}")
        for name, words in WORDS.items()
        if words.effect
    ]
    parts = [
        Part(agent, *effects[name], above(effects[name], 1.0)) for agent, name in WORLDS.items()
    ]
    least = min(parts, key=lambda part: (ORDER.index(part.verdict), part.low))
    each = ", ".join(f"{part.label} {part.ours:.2f} {part.verdict}" for part in parts)
    told = f" ({least.label}): {each}; {how(WORLDS[least.label])}"
    claims.insert(2, claim("C3", Estimate(*least[1:4]), told, parts))
    parts = [
        Part(f"{network} {thing}", *said.at(pair), within(distances[pair], FARTHEST))
        for pair, (network, thing) in enumerate(learnt.pairs)
    ]
    farthest = max(range(len(parts)), key=lambda k: distances[k].value)
    matching = (learnt.away[0] <= FARTHEST).all(axis=0)
    told = (
        f" ({parts[farthest].label}), at most {FARTHEST}; {matching.sum()} of {matching.size}"
        f" robots are within it everywhere; {LEVEL:.0%} bootstrap interval over robots"
    )
    return [*claims, claim("C7", distances[farthest], told, parts)]


def claims_json(claims: Sequence[Claim]) -> str:
    """The claims as JSON text; a number that is not finite becomes null."""

    def plain(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: plain(entry) for key, entry in value.items()}
        if isinstance(value, list | tuple):
            return [plain(entry) for entry in value]
        return None if isinstance(value, float) and not math.isfinite(value) else value

    records = [
        plain(asdict(claim) | {"parts": [part._asdict() for part in claim.parts]})
        for claim in claims
    ]
    return json.dumps(records, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _in_all_cells(lives: pa.Table) -> pa.Table:
    """The lives whose number is there in every cell."""
    number = column(lives, "life")
    each, times = np.unique(number, return_counts=True)
    return lives.filter(pa.array(np.isin(number, each[times == len(CELLS)])))

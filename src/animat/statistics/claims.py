"""The paper's claims C1 to C7, and whether they hold here.

A verdict comes from a confidence interval and from nothing else: *holds* if the whole interval
says so, *fails* if the whole interval says the opposite, *undecided* if it says both.
"""

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Literal, NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.statistics.estimates import (
    LEVEL,
    RESAMPLES,
    Estimate,
    bootstrapped,
    mean,
    ratio_of_means,
)
from animat.statistics.lives import cell, column, restricted, restriction

Verdict = Literal["holds", "fails", "undecided"]

ABUNDANT_GAIN = (1.75, 2.25)
"""C4: "nearly 100%" is a gain nearer to 100 % than to 50 % or 150 %, so 75 % to 125 %."""

SCARCE_GAIN = (1.25, 1.75)
"""C5: "nearly 50%" is a gain nearer to 50 % than to nothing or to 100 %, so 25 % to 75 %."""

FARTHEST = 0.2
"""C7: a network matches Table 1 with a likelihood of at least 0.8 where an act is afforded, and of
at most 0.2 where it is not: this far from the truth at most."""

INTERACT = "interact"

_ORDER: tuple[Verdict, ...] = ("fails", "undecided", "holds")


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


def above(estimate: Estimate, bound: float) -> Verdict:
    """Does the quantity exceed `bound`? Undecided while the interval touches it."""
    if estimate.low > bound:
        return "holds"
    return "fails" if estimate.high < bound else "undecided"


def inside(estimate: Estimate, band: tuple[float, float]) -> Verdict:
    """Does the quantity lie in the closed `band`?"""
    if estimate.low >= band[0] and estimate.high <= band[1]:
        return "holds"
    return "fails" if estimate.high < band[0] or estimate.low > band[1] else "undecided"


def lifespan_verdicts(
    rich: Estimate, poor: Estimate, worlds: Iterable[Estimate], gain: Estimate
) -> dict[str, Verdict]:
    """The verdicts on C1 to C6, by what they are about.

    `rich` and `poor` are the ratios of mean lifespans informed / blind in the abundant and in the
    scarce world, `worlds` the ratios abundant / scarce of each agent, `gain` is `rich` - `poor`.
    """
    return {
        "C1": above(rich, 1.0),
        "C2": above(poor, 1.0),
        "C3": _worst(above(each, 1.0) for each in worlds),
        "C4": inside(rich, ABUNDANT_GAIN),
        "C5": inside(poor, SCARCE_GAIN),
        "C6": above(gain, 0.0),
    }


def learning_verdict(distances: Iterable[Estimate]) -> Verdict:
    """The verdict on C7 from the distance of each mean likelihood from Table 1."""
    return _worst(_within(distance, FARTHEST) for distance in distances)


def distance_from_table_1(likelihoods: pa.Table) -> NDArray[np.float64]:
    """How far each row's `likelihood` is from what its `network` should say of its `object`.

    From Table 1's `afforded` of 0.5 on it should say 1; the network of `INTERACT` always.
    """
    afforded = column(likelihoods, "afforded") >= 0.5
    truth = (afforded | (column(likelihoods, "network") == INTERACT)).astype(np.float64)
    return np.abs(column(likelihoods, "likelihood").astype(np.float64) - truth)


def judge_lifespans(
    lives: pa.Table,
    *,
    abundant: str = "abundant",
    scarce: str = "scarce",
    blind: str = "BLIND",
    informed: str = "AF",
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> list[Claim]:
    """C1 to C6 from a table of lives with the four cells of Experiment 2.

    The names say which worlds and agents the cells are. Raises ValueError if a cell is missing.
    """

    def lives_of(world: str, agent: str) -> pa.Table:
        return cell(lives, world=world, agent=agent)

    rich_blind, rich_informed = lives_of(abundant, blind), lives_of(abundant, informed)
    poor_blind, poor_informed = lives_of(scarce, blind), lives_of(scarce, informed)
    rich, rich_how = _ratio(rich_informed, rich_blind, seed, resamples)
    poor, poor_how = _ratio(poor_informed, poor_blind, seed, resamples)
    gain, gain_how = _difference_of_gains(
        [rich_informed, rich_blind, poor_informed, poor_blind], seed, resamples
    )
    worlds = {
        blind: _ratio(rich_blind, poor_blind, seed, resamples),
        informed: _ratio(rich_informed, poor_informed, seed, resamples),
    }
    verdicts = lifespan_verdicts(rich, poor, (ratio for ratio, _ in worlds.values()), gain)
    return [
        Claim(
            "C1",
            f"{informed} outlives {blind} in the abundant world",
            "ratio > 1",
            *rich,
            verdicts["C1"],
            f"ratio of mean lifespans {informed}/{blind} above 1; {rich_how}",
        ),
        Claim(
            "C2",
            f"{informed} outlives {blind} in the scarce world",
            "ratio > 1",
            *poor,
            verdicts["C2"],
            f"ratio of mean lifespans {informed}/{blind} above 1; {poor_how}",
        ),
        _worlds(worlds, verdicts["C3"]),
        _magnitude("C4", "abundant", "nearly 100%", rich, ABUNDANT_GAIN, verdicts, rich_how),
        _magnitude("C5", "scarce", "nearly 50%", poor, SCARCE_GAIN, verdicts, poor_how),
        Claim(
            "C6",
            "the gain in the abundant world exceeds the gain in the scarce world",
            "2 − 1.5 = 0.5 > 0",
            *gain,
            verdicts["C6"],
            f"difference of the two ratios {informed}/{blind} above 0; {gain_how}",
        ),
    ]


def judge_learning(likelihoods: pa.Table, *, seed: int = 0, resamples: int = RESAMPLES) -> Claim:
    """C7 from the likelihoods at the end of Experiment 1.

    `likelihoods` has the columns `seed`, `network` (name of its behaviour), `object` (type),
    `likelihood` and `afforded` (Table 1's probability; from 0.5 on the object affords the act).
    Each network's mean likelihood for each object type is judged; the claim goes by the worst.
    Raises ValueError if a seed lacks one, or the table is empty.
    """
    seeds = column(likelihoods, "seed")
    network = column(likelihoods, "network")
    kind = column(likelihoods, "object")
    likelihood = column(likelihoods, "likelihood").astype(np.float64)
    pairs = list(dict.fromkeys(zip(network.tolist(), kind.tolist(), strict=True)))
    each, rows = np.unique(seeds, return_counts=True)
    if not each.size:
        raise ValueError("the table of likelihoods is empty")
    triples = set(zip(seeds.tolist(), network.tolist(), kind.tolist(), strict=True))
    if np.any(rows != len(pairs)) or len(triples) != len(seeds):
        raise ValueError("every seed needs one likelihood for each network and object type")
    away = distance_from_table_1(likelihoods)
    parts, distances = [], []
    for name, thing in pairs:
        chosen = (network == name) & (kind == thing)
        distance = mean(away[chosen], seed=seed, resamples=resamples)
        said = mean(likelihood[chosen], seed=seed, resamples=resamples)
        parts.append(Part(f"{name} {thing}", *said, _within(distance, FARTHEST)))
        distances.append(distance)
    worst = max(range(len(pairs)), key=lambda n: distances[n].value)
    farthest = distances[worst]
    learnt = sum(bool((away[seeds == one] <= FARTHEST).all()) for one in each)
    return Claim(
        "C7",
        "the networks learn what each object affords",
        "likelihood close to 1 where afforded, else close to 0",
        farthest.value,
        farthest.low,
        farthest.high,
        learning_verdict(distances),
        f"largest distance of a mean likelihood from Table 1 ({parts[worst].label}), at most "
        f"{FARTHEST}; {learnt} of {each.size} robots are within it everywhere; {LEVEL:.0%} "
        "bootstrap interval over robots",
        tuple(parts),
    )


def judge(lives: pa.Table, likelihoods: pa.Table, **settings) -> list[Claim]:
    """All seven claims; `settings` as in `judge_lifespans`."""
    return [*judge_lifespans(lives, **settings), judge_learning(likelihoods)]


def claims_json(claims: Sequence[Claim]) -> str:
    """The claims as JSON text; a number that is not finite becomes null."""

    def plain(value):
        if isinstance(value, dict):
            return {key: plain(entry) for key, entry in value.items()}
        if isinstance(value, list | tuple):
            return [plain(entry) for entry in value]
        return None if isinstance(value, float) and not math.isfinite(value) else value

    records = []
    for claim in claims:
        record = asdict(claim)
        record["parts"] = [part._asdict() for part in claim.parts]
        records.append(plain(record))
    return json.dumps(records, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _ratio(
    above_line: pa.Table, below_line: pa.Table, seed: int, resamples: int
) -> tuple[Estimate, str]:
    (top, bottom), paired = restricted([above_line, below_line])
    estimate = ratio_of_means(top, bottom, paired=paired, seed=seed, resamples=resamples)
    return estimate, _how([above_line, below_line], paired)


def _difference_of_gains(tables: list[pa.Table], seed: int, resamples: int) -> tuple[Estimate, str]:
    spans, paired = restricted(tables)

    def difference(a, b, c, d, axis=-1):
        a, b, c, d = (np.mean(sample, axis=axis) for sample in (a, b, c, d))
        return a / b - c / d

    estimate = bootstrapped(spans, difference, paired=paired, seed=seed, resamples=resamples)
    return estimate, _how(tables, paired)


def _how(tables: list[pa.Table], paired: bool) -> str:
    words = f"{'paired' if paired else 'unpaired'} bootstrap over lives"
    cap = restriction(tables)
    if math.isfinite(cap):
        alive = sum(int(column(table, "censored").sum()) for table in tables)
        total = sum(table.num_rows for table in tables)
        words += f", means restricted at {cap:,.0f} steps ({alive} of {total} lives went on)"
    return words


def _worlds(agents: dict[str, tuple[Estimate, str]], verdict: Verdict) -> Claim:
    parts = [Part(agent, *ratio, above(ratio, 1.0)) for agent, (ratio, _) in agents.items()]
    worst = min(parts, key=lambda part: (_ORDER.index(part.verdict), part.low))
    each = ", ".join(f"{part.label} {part.ours:.2f} {part.verdict}" for part in parts)
    return Claim(
        "C3",
        "agents live longer in the abundant world than in the scarce one",
        "ratio > 1, both agents",
        worst.ours,
        worst.low,
        worst.high,
        verdict,
        "ratio of mean lifespans abundant/scarce above 1 for both agents, shown for the one that "
        f"decides ({worst.label}): {each}; {agents[worst.label][1]}",
        tuple(parts),
    )


def _magnitude(
    name: str,
    world: str,
    words: str,
    estimate: Estimate,
    band: tuple[float, float],
    verdicts: dict[str, Verdict],
    how: str,
) -> Claim:
    return Claim(
        name,
        f"knowing affordances lengthens life by {words} in the {world} world",
        f"ratio ≈ {sum(band) / 2:g}",
        *estimate,
        verdicts[name],
        f"ratio of mean lifespans within {band[0]} to {band[1]}; {how}",
    )


def _within(estimate: Estimate, bound: float) -> Verdict:
    """Is the quantity at most `bound`?"""
    if estimate.high <= bound:
        return "holds"
    return "fails" if estimate.low > bound else "undecided"


def _worst(verdicts: Iterable[Verdict]) -> Verdict:
    return min(verdicts, key=_ORDER.index)

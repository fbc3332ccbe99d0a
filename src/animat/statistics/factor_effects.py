"""What a factor of the design does, over all the others: its levels, compared with the first.

Levels are compared within the combinations of the other factors wherever these occur with both of
them, so that nothing else differs. Where a design gives each case a combination of its own, the
cases are compared instead, as a sample.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.effects import PairedEffects, cliffs_delta, paired_effects
from animat.statistics.estimates import RESAMPLES, Estimate
from animat.statistics.factors import Factor
from animat.statistics.lives import lifespans
from animat.statistics.resampling import SETS_AT_LEAST, codes_of, quotient_over, sets_of
from animat.statistics.sample import Level, Sample, case_means, level, other_combinations
from animat.statistics.significance import Significance, stratified_logrank

COMBINATIONS_SHOWN = 6
"""Levels are also compared within each combination of the other factors, if these are few and have
many lives each."""


class Comparison(NamedTuple):
    """A level against the first one.

    `where` is the combination of the other factors it is made in, empty if over all of them;
    `lives` is how many lives of both levels it rests on; `ratio` is of restricted mean lifespans.
    `paired` is None where levels have no lives that share their random numbers in the same
    combination.
    """

    level: str
    reference: str
    where: str
    lives: int
    ratio: Estimate
    delta: Estimate
    paired: PairedEffects | None
    test: Significance


class FactorEffect(NamedTuple):
    """What a factor does.

    `matched`: its levels occur in the same combinations of the other factors; if not, and there
    are too few cases to be a sample, it is `confounded`. `resampled` says what the intervals draw.
    """

    factor: Factor
    levels: tuple[Level, ...]
    comparisons: tuple[Comparison, ...]
    test: Significance
    matched: bool
    confounded: bool
    resampled: str


def factor_effect(
    lives: Sample,
    name: str,
    measures: Sequence[str] = (),
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> FactorEffect:
    """What the factor `name` does, over all others; `measures` are columns to give means of."""
    chosen = lives.factor(name)
    within = other_combinations(lives, name)
    present = np.unique(chosen.codes)
    pairs = [_partners(chosen, within, level, present[0]) for level in present[1:]]
    matched = chosen.values is None and all(pair is not None for pair in pairs)
    sets = sets_of(lives.number, lives.case, within if matched else None)
    cases = len(np.unique(lives.case))
    levels = [
        level(lives, chosen.codes == code, (chosen.levels[code],), sets, measures,
              seed=seed, resamples=resamples)
        for code in present
    ]  # fmt: skip
    comparisons = []
    stratum = within if matched else None
    for code, pair in zip(present[1:], pairs, strict=True):
        compared = (code, present[0])
        rows = pair if matched and pair is not None else np.isin(chosen.codes, compared)
        places = {"": rows}
        if matched:
            places |= _few_combinations(lives, name, within, rows)
        comparisons += [
            _compare(lives, chosen, some, compared, where, stratum, seed, resamples)
            for where, some in places.items()
        ]
    return FactorEffect(
        chosen,
        tuple(levels),
        tuple(comparisons),
        _test(lives, chosen, stratum),
        matched,
        chosen.values is None and not matched and cases < SETS_AT_LEAST,
        sets.what,
    )


def _partners(
    chosen: Factor, within: NDArray[np.int64], level: int, reference: int
) -> NDArray[np.bool_] | None:
    """The lives of two levels in combinations that occur with both; None if they are rare."""
    one, other = (np.unique(within[chosen.codes == code]) for code in (level, reference))
    both = np.intersect1d(one, other)
    if 2 * len(both) < min(len(one), len(other)):
        return None
    return np.isin(chosen.codes, [level, reference]) & np.isin(within, both)


def _compare(
    lives: Sample,
    chosen: Factor,
    rows: NDArray[np.bool_],
    compared: tuple[int, int],
    where: str,
    within: NDArray[np.int64] | None,
    seed: int,
    resamples: int,
) -> Comparison:
    case, number = lives.case[rows], lives.number[rows]
    sets = sets_of(number, case, None if within is None else within[rows])
    one = chosen.codes[rows] == compared[0]
    steps = lives.steps[rows]
    ours, theirs = (steps[one], sets.take(one)), (steps[~one], sets.take(~one))
    how = {"seed": seed, "resamples": resamples}
    pairs = None
    if within is not None and lives.paired:
        pairs = paired_effects(steps, one, codes_of(within[rows], number), sets, **how)
    return Comparison(
        chosen.levels[compared[0]],
        chosen.levels[compared[1]],
        where,
        int(rows.sum()),
        quotient_over(*ours, *theirs, **how),
        cliffs_delta(*ours, *theirs),
        pairs,
        _test_of(lives, chosen, rows, within),
    )


def _test(lives: Sample, chosen: Factor, within: NDArray[np.int64] | None) -> Significance:
    """Does the factor matter at all?"""
    if chosen.values is None:
        return _test_of(lives, chosen, np.ones(len(lives.steps), dtype=bool), within)
    first, means = case_means(lives, chosen)
    values = chosen.values[first]
    there = ~np.isnan(values)
    if there.sum() < 3 or np.ptp(means[there]) == 0.0 or np.ptp(values[there]) == 0.0:
        return Significance("Spearman", float("nan"), 0, float("nan"))
    result: Any = stats.spearmanr(values[there], means[there])
    return Significance("Spearman", float(result.statistic), 0, float(result.pvalue))


def _test_of(
    lives: Sample, chosen: Factor, rows: NDArray[np.bool_], within: NDArray[np.int64] | None
) -> Significance:
    """Do the levels among the chosen lives differ? Within combinations, or else over cases."""
    if within is None and len(np.unique(lives.case[rows])) >= SETS_AT_LEAST:
        return _over_cases(lives, chosen, rows)
    stratum = np.zeros(len(lives.steps), dtype=np.int64) if within is None else within
    # A life that several combinations share counts once among them.
    lived = codes_of(chosen.codes, stratum, lives.case, lives.number)
    once = np.intersect1d(np.flatnonzero(rows), np.unique(lived, return_index=True)[1])
    spans = lifespans(lives.table)
    return stratified_logrank(
        spans.steps[once], ~spans.censored[once], chosen.codes[once], stratum[once]
    )


def _over_cases(lives: Sample, chosen: Factor, rows: NDArray[np.bool_]) -> Significance:
    first, means = case_means(lives, chosen)
    here = rows[first]
    groups = [means[here & (chosen.codes[first] == code)] for code in np.unique(chosen.codes)]
    groups = [group for group in groups if len(group)]
    if len(groups) < 2 or np.ptp(means[here]) == 0.0:
        return Significance("Kruskal-Wallis", 0.0, 0, 1.0)
    result: Any = stats.kruskal(*groups)
    return Significance(
        "Kruskal-Wallis", float(result.statistic), len(groups) - 1, float(result.pvalue)
    )


def _few_combinations(
    lives: Sample, name: str, within: NDArray[np.int64], rows: NDArray[np.bool_]
) -> dict[str, NDArray[np.bool_]]:
    """Those of `rows` in each combination of the other factors, if these are few and large."""
    used, count = np.unique(within[rows], return_counts=True)
    if not 2 <= len(used) <= COMBINATIONS_SHOWN or count.min() < 2 * SETS_AT_LEAST:
        return {}
    places = {}
    for each in used:
        some = rows & (within == each)
        life = int(np.argmax(some))
        words = (f"{other.name} = {other.label(life)}" for other in lives.others(name))
        places[", ".join(words)] = some
    return places

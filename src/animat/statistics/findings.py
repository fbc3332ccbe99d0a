"""All that is found in the lives of a study: over all, case by case, and factor by factor."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.statistics.estimates import Estimate
from animat.statistics.factor_effects import FactorEffect, factor_effect
from animat.statistics.resampling import Sets, ratio_over, sets_of
from animat.statistics.sample import Level, Sample, level, sample
from animat.statistics.two_factors import Interaction, interactions

RESAMPLES = 1_999
"""Bootstrap resamples of each interval: its ends move by some 3 % of its width by chance."""

CASES_AT_MOST = 24
"""More cases than this are told by their factors, not one by one."""


class Findings(NamedTuple):
    """What is found.

    `cases` is empty where there are too many, or only one factor tells them apart; `varying` are
    the factors that do. `by_behaviour`
    is the share of acts that succeed. `interactions` are those of the pairs of told factors that
    are crossed, none where nobody died. The p values are by Holm's correction, each over all tests
    of its kind: `factors_p` [effects], `levels_p` [all comparisons, effect after effect],
    `interactions_p` [interactions] and `contrasts_p` [all contrasts, interaction after
    interaction]; the latter two of differences and of ratios, all corrected together.
    """

    lives: Sample
    overall: Level
    by_behaviour: Mapping[str, tuple[int, Estimate]]
    varying: tuple[str, ...]
    cases: tuple[Level, ...]
    effects: tuple[FactorEffect, ...]
    factors_p: tuple[float, ...]
    levels_p: tuple[float, ...]
    interactions: tuple[Interaction, ...]
    interactions_p: tuple[tuple[float, float], ...]
    contrasts_p: tuple[tuple[float, float], ...]
    resampled: str

    @property
    def deaths(self) -> int:
        """How many lives ended."""
        return self.overall.summary.lives - self.overall.summary.alive


def find(
    table: pa.Table,
    factors: Sequence[str],
    *,
    by: Sequence[str] | None = None,
    measures: Sequence[str] = (),
    seed: int = 0,
    resamples: int = RESAMPLES,
) -> Findings:
    """What the lives of `table` say of the `factors` of their design.

    `by` names the factors that are told of, all that vary if it is None; `measures` are further
    columns to give means of. Raises ValueError if there is no life or no such column.
    """
    lives = sample(table, factors)
    varying = [each.name for each in lives.factors if len(np.unique(each.codes)) > 1]
    told = [name for name in (factors if by is None else by) if name in varying]
    how = {"seed": seed, "resamples": resamples}
    effects = tuple(factor_effect(lives, name, measures, **how) for name in told)
    everyone = np.ones(table.num_rows, dtype=bool)
    sampled = any(not each.matched and not each.confounded for each in effects)
    sets = sets_of(lives.number, lives.case, None if sampled else lives.case)
    comparisons = [one for each in effects for one in each.comparisons]
    overall = level(lives, everyone, ("all",), sets, measures, **how)
    died = overall.summary.alive < overall.summary.lives
    both = interactions(lives, told, **how) if died else ()
    contrasts = [one for each in both for one in each.contrasts]
    return Findings(
        lives,
        overall,
        _by_behaviour(table, sets, seed, resamples),
        tuple(varying),
        _cases(lives, varying, measures, seed, resamples),
        effects,
        tuple(holm([each.test.p for each in effects]).tolist()),
        tuple(holm([one.test.p for one in comparisons]).tolist()),
        both,
        _both_scales([(each.differences.p, each.ratios.p) for each in both]),
        _both_scales([(one.difference_p, one.ratio_p) for one in contrasts]),
        sets.what,
    )


def _both_scales(p: Sequence[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """The p values of differences and of ratios [n, 2], corrected together."""
    corrected = holm([each for pair in p for each in pair]).tolist()
    return tuple(zip(corrected[::2], corrected[1::2], strict=True))


def _by_behaviour(
    table: pa.Table, sets: Sets, seed: int, resamples: int
) -> dict[str, tuple[int, Estimate]]:
    """Of each behaviour the number of acts, and the share of them that succeed."""
    found = {}
    for name in table.column_names:
        behaviour = name.removeprefix("acts_")
        if behaviour == name or f"successes_{behaviour}" not in table.column_names:
            continue
        successes, acts = (
            np.asarray(table.column(f"{what}_{behaviour}").to_numpy(), dtype=np.float64)
            for what in ("successes", "acts")
        )
        share = ratio_over(successes, acts, sets, seed=seed, resamples=resamples)
        found[behaviour] = (int(np.nansum(acts)), share)
    return found


def _cases(
    lives: Sample, varying: Sequence[str], measures: Sequence[str], seed: int, resamples: int
) -> tuple[Level, ...]:
    """Each case alone, in the order of the table."""
    named = [each for each in lives.factors if each.name in varying]
    keys = np.stack([each.exact for each in named]) if named else np.zeros((1, len(lives.steps)))
    _, first, codes = np.unique(keys, axis=1, return_index=True, return_inverse=True)
    if len(named) < 2 or len(first) > CASES_AT_MOST:
        return ()
    sets = sets_of(lives.number, lives.case, lives.case)
    return tuple(
        level(
            lives,
            codes.reshape(-1) == code,
            tuple(each.label(int(first[code])) for each in named),
            sets,
            measures,
            seed=seed,
            resamples=resamples,
        )
        for code in np.argsort(first)
    )


def holm(p: Sequence[float]) -> NDArray[np.float64]:
    """Holm's (1979) correction of the p values of n tests: [n].

    Whoever calls those below a level alike errs in any of the n tests no more often than that.
    The smallest p counts n times, the next n - 1 times, and none less than one before it. It holds
    however the tests depend on each other. NaN, a test that could not be made, stays NaN and does
    not count.
    """
    given = np.asarray(p, dtype=np.float64)
    corrected = np.full(given.shape, np.nan)
    made = np.flatnonzero(~np.isnan(given))
    order = made[np.argsort(given[made], kind="stable")]
    times = np.arange(len(order), 0, -1)
    corrected[order] = np.minimum(1.0, np.maximum.accumulate(times * given[order]))
    return corrected

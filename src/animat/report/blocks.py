"""Tables and pictures of levels and their comparisons, as the page shows them."""

import math
from collections.abc import Mapping, Sequence
from typing import TypeVar

import numpy as np

from animat.figures.causes import causes_figure
from animat.figures.factor_effects import factor_effects_figure, trend_figure
from animat.figures.style import spread_out
from animat.figures.survival import level_curves_figure
from animat.report.page import NOT_KNOWN, Picture, TableBlock, interval, p_value, picture
from animat.statistics.estimates import Estimate, share
from animat.statistics.factor_effects import Comparison, FactorEffect
from animat.statistics.sample import Level, Sample, case_means

T = TypeVar("T")

PAIRED = (
    "Pairs", "Ratio of mean lifespans", "Difference (steps)", "Outlives in", "Ties in",
    "Rank-biserial",
)  # fmt: skip
PAIRED_NOTE = (
    "A pair is two lives with the same seed and index, which share their starting pose and random"
    " numbers. Difference: mean within pairs. Outlives in: share of pairs in which the life at the"
    " level named first is the longer; pairs that both go on at the cap are ties. Rank-biserial:"
    " matched-pairs rank-biserial correlation, from -1 to 1, ties counting for neither. p does not"
    " use the pairs, so it can miss a difference that the intervals show. "
)

ROWS_AT_MOST = 40
"""Of more levels or comparisons than this, the first and the last are shown."""

BARS_AT_MOST = 24
CURVES_AT_MOST = 8
COLUMNS_AT_MOST = 6


def lifespans_table(names: Sequence[str], levels: Sequence[Level]) -> TableBlock:
    """Lifespans, acts and stability, a row for each level; `names` head the parts of its name."""
    return TableBlock(
        (*names, "Lives", "Alive at the cap", "Mean lifespan (steps)", "Median lifespan (steps)",
         "Acts that succeed", "Mean drive"),
        [
            (
                *one.summary.cell,
                f"{one.summary.lives:,}",
                f"{one.summary.alive:,}",
                interval(one.summary.mean, ",.0f"),
                interval(one.summary.median, ",.0f"),
                interval(one.summary.success_rate, ".1%"),
                interval(one.summary.stability, ".3f"),
            )
            for one in first_and_last(levels, ROWS_AT_MOST)
        ],
        _left_out(levels),
    )  # fmt: skip


def measures_table(levels: Sequence[Level]) -> TableBlock | None:
    """The likelihoods, a row for each and a column for each level; None if there are none."""
    shown = first_and_last(levels, COLUMNS_AT_MOST)
    rows = [
        (
            name.removeprefix("likelihood_").replace("_", " "),
            *(interval(one.measures[name], ".2f") for one in shown),
        )
        for name in levels[0].measures
    ]
    if not rows:
        return None
    return TableBlock(
        ("Network and object", *(one.label for one in shown)),
        rows,
        _left_out(levels, COLUMNS_AT_MOST),
        title="Mean likelihood at the end of life",
    )


def endings_table(names: Sequence[str], levels: Sequence[Level]) -> TableBlock:
    """How the lives ended, the frequent ways first.

    Few levels have a column each, many a row each, and then rare ways are put together.
    """
    total: dict[str, int] = {}
    for one in levels:
        for death in one.summary.deaths:
            total[death.label] = total.get(death.label, 0) + death.count
    ways = sorted(total, key=lambda way: -total[way])
    title = "How the lives ended"
    if len(levels) <= COLUMNS_AT_MOST:
        rows = [(way, *(_share(one, [way]) for one in levels)) for way in ways]
        return TableBlock(("", *(one.label for one in levels)), rows, title=title)
    columns = {way: [way] for way in ways[:COLUMNS_AT_MOST]}
    if len(ways) > COLUMNS_AT_MOST:
        columns["otherwise"] = ways[COLUMNS_AT_MOST:]
    rows = [
        (*one.summary.cell, *(_share(one, some) for some in columns.values()))
        for one in first_and_last(levels, ROWS_AT_MOST)
    ]
    return TableBlock((*names, *columns), rows, _left_out(levels), title=title)


def _share(one: Level, ways: Sequence[str]) -> str:
    """The share of a level's lives that ended in one of some ways."""
    count = sum(death.count for death in one.summary.deaths if death.label in ways)
    return interval(share(count, one.summary.lives), ".1%") if count else "0"


def comparisons_table(effect: FactorEffect, corrected: Sequence[float], tests: int) -> TableBlock:
    """The levels of a factor against the first; `corrected` are the p values for all `tests`.

    Where lives are paired, so are the effect sizes.
    """
    paired = any(one.paired for one in effect.comparisons)
    sizes = PAIRED if paired else ("Lives", "Ratio of mean lifespans", "Cliff's delta")
    rows = [
        (
            f"{one.level} against {one.reference}",
            one.where or "over all",
            *(_paired_sizes(one) if paired else _sizes(one)),
            p_value(one.test.p),
            p_value(p),
        )
        for one, p in zip(effect.comparisons, corrected, strict=True)
    ]
    return TableBlock(
        ("Levels", "Where", *sizes, "p", "p, Holm"),
        first_and_last(rows, ROWS_AT_MOST),
        f"p: {effect.comparisons[0].test.name}. p, Holm: corrected for the {tests} comparisons of"
        f" levels on this page. {PAIRED_NOTE if paired else ''}{_left_out(rows)}".strip(),
        title=f"Against {effect.levels[0].label}",
    )


def _sizes(one: Comparison) -> tuple[str, ...]:
    return f"{one.lives:,}", interval(one.ratio, ".2f"), interval(one.delta, ".2f")


def _paired_sizes(one: Comparison) -> tuple[str, ...]:
    ratio = interval(one.ratio, ".2f")
    if one.paired is None:
        return "0", ratio, *[NOT_KNOWN] * 4
    return (
        f"{one.paired.pairs:,}",
        ratio,
        interval(one.paired.difference, ",.0f"),
        interval(one.paired.outlives, ".1%"),
        f"{one.paired.ties:.1%}",
        interval(one.paired.rank_biserial, ".2f"),
    )


def curves_picture(levels: Sequence[Level], *, ordered: bool = False) -> Picture:
    """Survival curves; `ordered` levels are numbers."""
    ends = [one.curve.times[-1] for one in levels]
    medians = [one.curve.median().value for one in levels]
    fig = level_curves_figure(
        {one.label: one.curve for one in levels},
        ordered=ordered,
        log=spread_out([*ends, *filter(math.isfinite, medians)]),
    )
    return picture(
        fig,
        "Survival curves (Kaplan-Meier) with 95 % bands. Lives that reach the cap are censored"
        " there.",
        "Share of lives still going on over steps",
    )


def endings_picture(levels: Sequence[Level]) -> Picture:
    """How the lives of each level ended."""
    fig = causes_figure({one.label: one.summary.deaths for one in levels})
    return picture(fig, "How the lives ended.", "Stacked bars of causes of death")


def factor_effects_picture(effects: Sequence[FactorEffect], overall: Estimate) -> Picture:
    """The mean lifespan at each level of each factor."""
    factors: Mapping[str, Mapping[str, Estimate]] = {
        effect.factor.name: {
            one.label: one.summary.mean for one in first_and_last(effect.levels, BARS_AT_MOST)
        }
        for effect in effects
    }
    return picture(
        factor_effects_figure(factors, overall.value),
        "Mean lifespan at each level of each factor, over all others, with its 95 % interval.",
        "Dots with intervals for each level of each factor",
    )


def trend_picture(effect: FactorEffect, lives: Sample) -> Picture:
    """The mean lifespans of cases over a factor that has a range."""
    name, values = effect.factor.name, effect.factor.values
    assert values is not None
    first, means = case_means(lives, effect.factor)
    there = ~np.isnan(values[first])
    quarters = [
        (float(np.median(values[effect.factor.codes == code])), one.summary.mean)
        for code, one in enumerate(effect.levels)
        if not np.isnan(values[effect.factor.codes == code]).any()
    ]
    fig = trend_figure(name, values[first][there], means[there], quarters)
    return picture(
        fig,
        f"Mean lifespan of every case over {name}, and the mean of each quarter of its range at"
        " the middle of the quarter's lives.",
        f"Dots of mean lifespan against {name}",
    )


def first_and_last(entries: Sequence[T], most: int) -> list[T]:
    """Of more than `most` entries, as many from both ends."""
    half = most // 2
    return list(entries) if len(entries) <= most else [*entries[:half], *entries[-half:]]


def _left_out(entries: Sequence, most: int = ROWS_AT_MOST) -> str:
    if len(entries) <= most:
        return ""
    return f"Shown are the first and the last {most // 2} of {len(entries)}."

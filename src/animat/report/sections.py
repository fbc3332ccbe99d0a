"""What is found in the lives of a study, as parts of the page."""

import math
from collections.abc import Sequence

from animat.report.blocks import (
    BARS_AT_MOST,
    CURVES_AT_MOST,
    comparisons_table,
    curves_picture,
    endings_picture,
    endings_table,
    factor_effects_picture,
    lifespans_table,
    measures_table,
    trend_picture,
)
from animat.report.interaction_sections import interaction_sections, interactions_in_short
from animat.report.page import Picture, Section, TableBlock, interval, p_value
from animat.statistics.estimates import LEVEL
from animat.statistics.factor_effects import FactorEffect
from animat.statistics.findings import Findings
from animat.statistics.numerals import shortened
from animat.statistics.sample import Level

NOBODY_DIED = (
    "No life ended before its cap, so lifespans tell nothing apart here, and are not compared."
)

CONFOUNDED = (
    "The levels of this factor were simulated with different values of the other factors, in too"
    " few cases to be a sample. What differs between them need not be due to this factor."
)


def in_short(found: Findings) -> list[str]:
    """A sentence on all lives, and one on each factor, those that differ most first."""
    whole = found.overall.summary
    lifespan = (
        f" Mean lifespan {interval(whole.mean, ',.0f')} steps, median"
        f" {interval(whole.median, ',.0f')}."
    )
    told = [
        f"{found.deaths:,} of {whole.lives:,} lives ended, {whole.alive:,} went on at their cap."
        f"{lifespan if found.deaths else ''} Acts that succeeded"
        f" {interval(whole.success_rate, '.1%')}, mean drive {interval(whole.stability, '.3f')}."
    ]
    if found.deaths:
        pairs = zip(found.effects, found.factors_p, strict=True)
        told += [
            _factor_in_short(effect, p)
            for effect, p in sorted(pairs, key=lambda pair: -longest_to_shortest(pair[0]))
        ]
        told += interactions_in_short(found)
    return told


def result_sections(found: Findings) -> list[Section]:
    """All that is found, in the order of the page."""
    sections = [overall_section(found)]
    if found.cases:
        sections.append(cases_section(found))
    if len(found.effects) > 1:
        sections.append(factors_section(found))
    sections += [factor_section(found, place) for place in range(len(found.effects))]
    return [*sections, *interaction_sections(found)]


def overall_section(found: Findings) -> Section:
    """All lives together: how long they were, how they ended, what was done."""
    acts = [
        (name, f"{count:,}", interval(share, ".1%"))
        for name, (count, share) in found.by_behaviour.items()
        if count
    ]
    tables = _tables(found, ("",), [found.overall])
    if acts:
        tables.append(TableBlock(("Behaviour", "Acts", "Acts that succeed"), acts, title="Acts"))
    return Section(
        "All lives",
        [
            f"Intervals are at {LEVEL:.0%}. {restriction_words(found)} Mean drive is the mean over"
            " a life of the mean of the drives, physiological stability: lower is better. The"
            f" intervals resample {found.resampled}."
        ],
        tables=tables,
        pictures=_pictures(found, [found.overall]) if not found.effects else (),
        notices=() if found.deaths else [NOBODY_DIED],
    )


def cases_section(found: Findings) -> Section:
    """Every case alone."""
    return Section(
        "The cases",
        tables=_tables(found, found.varying, found.cases),
        pictures=_pictures(found, found.cases),
    )


def factors_section(found: Findings) -> Section:
    """The factors beside each other."""
    rows = [
        (
            effect.factor.name,
            str(len(effect.levels)),
            _tested(effect),
            p_value(effect.test.p),
            p_value(corrected),
            f"{longest_to_shortest(effect):.2f}",
        )
        for effect, corrected in zip(found.effects, found.factors_p, strict=True)
    ]
    table = TableBlock(
        ("Factor", "Levels", "Test of lifespans", "p", "p, Holm", "Longest to shortest"),
        rows,
        f"p, Holm: corrected for the {len(rows)} tests of this table. Longest to shortest: ratio of"
        " the largest mean lifespan of a level to the smallest.",
    )
    return Section(
        "The factors",
        ["What each factor does over all the others. A factor with a range is cut into quarters."],
        tables=[table] if found.deaths else (),
        pictures=[factor_effects_picture(found.effects, found.overall.summary.mean)]
        if found.deaths
        else (),
    )


def factor_section(found: Findings, place: int) -> Section:
    """One factor: its levels, how they compare with the first, how their lives ended."""
    effect = found.effects[place]
    before = sum(len(each.comparisons) for each in found.effects[:place])
    corrected = found.levels_p[before : before + len(effect.comparisons)]
    tables = _tables(found, ("Level",), effect.levels)
    if found.deaths:
        tables.insert(1, comparisons_table(effect, corrected, len(found.levels_p)))
    how = _how_compared(effect, alone=len(found.varying) == 1)
    pictures = _pictures(found, effect.levels, ordered=effect.factor.ordered)
    if found.deaths and effect.factor.values is not None:
        pictures.insert(0, trend_picture(effect, found.lives))
    return Section(
        effect.factor.name,
        [f"{how} The intervals resample {effect.resampled}."],
        tables=tables,
        pictures=pictures,
        notices=[CONFOUNDED] if effect.confounded else (),
    )


def restriction_words(found: Findings) -> str:
    """Up to where lifespans count."""
    cap = found.lives.cap
    if math.isinf(cap):
        return "Every life ended, so lifespans are known in full."
    return (
        f"Lifespans count up to {cap:,.0f} steps, as long as every life was watched: a life that"
        " went on counts as ending there."
    )


def longest_to_shortest(effect: FactorEffect) -> float:
    """The largest mean lifespan of a level over the smallest; lifespans are at least 1 step."""
    means = [one.summary.mean.value for one in effect.levels]
    return max(means) / max(min(means), 1.0)


def _factor_in_short(effect: FactorEffect, corrected: float) -> str:
    longest = max(effect.levels, key=lambda one: one.summary.mean.value)
    shortest = min(effect.levels, key=lambda one: one.summary.mean.value)
    low, high = shortest.summary.mean.value, longest.summary.mean.value
    said = shortened(one.label for one in effect.levels)
    ends = (
        f"mean lifespans from {low:,.0f} ({said[shortest.label]}) to {high:,.0f} steps"
        f" ({said[longest.label]})"
        if low < high
        else f"mean lifespan {low:,.0f} steps at every level"
    )
    shown = "" if corrected <= 1 - LEVEL else "no difference shown; "
    p = p_value(corrected)
    said = p if p.startswith("<") else f"= {p}"
    besides = ", confounded with other factors" if effect.confounded else ""
    test = f"{effect.test.name} p {said} after correction{besides}"
    return f"{effect.factor.name}: {shown}{ends}, {test}."


def _how_compared(effect: FactorEffect, *, alone: bool) -> str:
    if alone:
        return "It is the only factor of this study."
    if effect.confounded:
        return "Levels are compared as they are."
    if effect.matched:
        return (
            "Levels are compared within the combinations of the other factors that both have, so"
            " that no other factor differs between them."
        )
    return (
        "The cases differ in other factors as well, so they are compared as a sample, by their"
        " mean lifespans."
    )


def _tested(effect: FactorEffect) -> str:
    test = effect.test
    if test.name == "Spearman":
        return f"{test.name}, rho = {test.statistic:.2f}"
    if test.freedom == 0:
        return f"{test.name}, nothing to compare"
    return f"{test.name}, chi² = {test.statistic:,.1f}, {test.freedom} d.f."


def _tables(found: Findings, names: Sequence[str], levels: Sequence[Level]) -> list[TableBlock]:
    tables = [lifespans_table(names, levels)]
    if found.deaths:
        tables.append(endings_table(names, levels))
    networks = measures_table(levels)
    return [*tables, networks] if networks else tables


def _pictures(found: Findings, levels: Sequence[Level], *, ordered: bool = False) -> list[Picture]:
    if not found.deaths:
        return []
    pictures = []
    if len(levels) <= CURVES_AT_MOST:
        pictures.append(curves_picture(levels, ordered=ordered))
    if len(levels) <= BARS_AT_MOST:
        pictures.append(endings_picture(levels))
    return pictures

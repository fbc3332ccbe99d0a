"""The interactions of two factors, as parts of the page."""

from collections.abc import Sequence

import numpy as np

from animat.figures.interaction import InteractionLine, interaction_figure
from animat.figures.style import spread_out
from animat.report.blocks import CURVES_AT_MOST, ROWS_AT_MOST, first_and_last
from animat.report.page import NOT_KNOWN, Picture, Section, TableBlock, interval, p_value, picture
from animat.statistics.estimates import LEVEL
from animat.statistics.findings import Findings
from animat.statistics.significance import Significance
from animat.statistics.two_factors import Axis, Interaction

SHOWN_AT_MOST = 6
"""Of more interactions those with the smallest p values have a part of their own."""

COLUMNS_AT_MOST = 6

TWO_SCALES = (
    "An interaction: the effect of one factor depends on the level of the other. Differences of"
    " mean lifespans may differ where their ratios do not, and the other way round, so both are"
    " tested."
)

TOO_FEW = " A dash: with as many contrasts as sets of lives, or more, there is no joint test."


def interactions_in_short(found: Findings) -> list[str]:
    """A sentence on all interactions, if any was tested."""
    tested = [
        (p, each, scale)
        for each, both in zip(found.interactions, found.interactions_p, strict=True)
        for p, scale in zip(both, ("differences", "ratios"), strict=True)
        if not np.isnan(p)
    ]
    if not tested:
        return []
    shown = [each for each in tested if each[0] <= 1 - LEVEL]
    few = sorted(shown, key=lambda each: each[0])[:SHOWN_AT_MOST]
    listed = "; ".join(
        f"{each.name}, on {scale} of lifespans (p {_p_words(p)})" for p, each, scale in few
    )
    after = f"after correction for {_tests(len(tested))}"
    if not shown:
        return [f"Interactions of two factors: none shown, {after}."]
    more = f"; and {len(shown) - len(few)} more" if len(shown) > len(few) else ""
    return [f"Interactions of two factors: {listed}{more}, {after}."]


def interaction_sections(found: Findings) -> list[Section]:
    """All interactions in a table, and then the surest of them, each with its contrasts."""
    if not found.interactions:
        return []
    smallest = [min(_known(both), default=1.0) for both in found.interactions_p]
    chosen = sorted(np.argsort(smallest, kind="stable")[:SHOWN_AT_MOST].tolist())
    return [_overview(found), *(_section(found, place) for place in chosen)]


def _overview(found: Findings) -> Section:
    rows = [
        (
            each.name,
            *_tested(each.differences, differences_p),
            *_tested(each.ratios, ratios_p),
        )
        for each, (differences_p, ratios_p) in zip(
            found.interactions, found.interactions_p, strict=True
        )
    ]
    pairs = len(found.effects) * (len(found.effects) - 1) // 2
    left_out = [
        f"{pairs - len(rows)} of the {pairs} pairs of factors are not tested, as no combination of"
        " the other factors has all their levels crossed."
    ]
    number = sum(len(_known(both)) for both in found.interactions_p)
    return Section(
        "Interactions of two factors",
        [
            TWO_SCALES,
            "Each test is Hotelling's T² on the restricted mean lifespans, for all contrasts of a"
            " pair of factors at once, within the combinations of the other factors.",
            *(left_out if len(rows) < pairs else []),
        ],
        tables=[
            TableBlock(
                ("Factors", "Differences", "p", "p, Holm", "Ratios", "p", "p, Holm"),
                first_and_last(rows, ROWS_AT_MOST),
                f"p, Holm: corrected for the {_tests(number)} of this table."
                f"{TOO_FEW if number < 2 * len(rows) else ''}{_left_out(rows)}",
            )
        ],
    )


def _section(found: Findings, place: int) -> Section:
    one = found.interactions[place]
    before = sum(len(each.contrasts) for each in found.interactions[:place])
    corrected = found.contrasts_p[before : before + len(one.contrasts)]
    rows = [
        (
            f"{' against '.join(each.first)}",
            f"{' against '.join(each.second)}",
            interval(each.difference, ",.0f"),
            p_value(difference_p),
            interval(each.ratio, ".2f"),
            p_value(ratio_p),
        )
        for each, (difference_p, ratio_p) in zip(one.contrasts, corrected, strict=True)
    ]
    number = sum(len(_known(both)) for both in found.contrasts_p)
    contrasts = TableBlock(
        (one.first.name, one.second.name, "Difference of differences (steps)", "p, Holm",
         "Ratio of ratios", "p, Holm"),
        first_and_last(rows, ROWS_AT_MOST),
        f"First row: the effect of {rows[0][0]} ({one.first.name}) at {one.contrasts[0].second[0]},"
        f" less or over that at {one.contrasts[0].second[1]} ({one.second.name}). No interaction"
        f" is 0 and 1. Intervals are Student's, of ratios on the scale of logarithms, each for"
        f" itself. p, Holm: corrected for the {_tests(number)} of such contrasts on this page."
        f"{_left_out(rows)}",
        title="Contrasts",
    )  # fmt: skip
    return Section(
        f"{one.first.name} by {one.second.name}",
        [f"{_within(one)} The intervals rest on {one.resampled}."],
        tables=[_means_table(one), contrasts],
        pictures=[_picture(one)],
    )


def _means_table(one: Interaction) -> TableBlock:
    rows = first_and_last(range(len(one.first.levels)), ROWS_AT_MOST)
    columns = first_and_last(range(len(one.second.levels)), COLUMNS_AT_MOST)
    cut = len(columns) < len(one.second.levels) or len(rows) < len(one.first.levels)
    return TableBlock(
        (one.first.name, *(one.second.levels[column] for column in columns)),
        [
            (
                one.first.levels[row],
                *(
                    interval(one.means[row, column], ",.0f")
                    if (row, column) in one.means
                    else NOT_KNOWN
                    for column in columns
                ),
            )
            for row in rows
        ],
        "Shown are the first and the last levels." if cut else "",
        title=f"Mean lifespan (steps) by {one.first.name} and {one.second.name}",
    )


def _picture(one: Interaction) -> Picture:
    """Numbers along the axis, and of two alike the factor with more levels."""

    def along(axis: Axis) -> tuple[bool, int]:
        return axis.places is not None, len(axis.levels)

    swap = along(one.first) > along(one.second)
    axis, lines = (one.first, one.second) if swap else (one.second, one.first)
    drawn = first_and_last(range(len(lines.levels)), CURVES_AT_MOST)
    means = {(b, a) if swap else (a, b): mean for (a, b), mean in one.means.items()}
    figure = interaction_figure(
        axis.name,
        axis.levels,
        axis.places,
        [
            InteractionLine(
                lines.levels[line],
                {at: mean for (which, at), mean in means.items() if which == line},
            )
            for line in drawn
        ],
        lines.name,
        ordered=lines.places is not None,
    )
    log = spread_out([m for mean in one.means.values() for m in mean if np.isfinite(m)])
    parallel = "ratios, as the axis of steps is logarithmic" if log else "differences"
    few = (
        f" Lines are the first and the last {len(drawn) // 2} levels."
        if len(drawn) < len(lines.levels)
        else ""
    )
    return picture(
        figure,
        f"Mean lifespan with its {LEVEL:.0%} interval at each level of {axis.name}, a line for each"
        f" level of {lines.name}. Parallel lines are no interaction of {parallel}.{few}",
        f"Lines of mean lifespan over {axis.name}, one for each level of {lines.name}",
    )


def _within(one: Interaction) -> str:
    if one.blocks + one.incomplete == 1:
        return "Nothing but these two factors differs between the lives compared."
    left = f"; {one.incomplete} more have not, and are left out" if one.incomplete else ""
    return (
        f"Compared within {one.blocks} combinations of the other factors that have all of these"
        f" cells, all of equal weight{left}."
    )


def _tested(test: Significance, corrected: float) -> tuple[str, str, str]:
    if np.isnan(test.p):
        return NOT_KNOWN, NOT_KNOWN, NOT_KNOWN
    return f"T² = {test.statistic:,.1f}, {test.freedom} d.f.", p_value(test.p), p_value(corrected)


def _tests(count: int) -> str:
    return f"{count} test" if count == 1 else f"{count:,} tests"


def _known(p: Sequence[float]) -> list[float]:
    return [each for each in p if not np.isnan(each)]


def _p_words(p: float) -> str:
    text = p_value(p)
    return text if text.startswith("<") else f"= {text}"


def _left_out(entries: Sequence) -> str:
    if len(entries) <= ROWS_AT_MOST:
        return ""
    return f" Shown are the first and the last {ROWS_AT_MOST // 2} of {len(entries)}."

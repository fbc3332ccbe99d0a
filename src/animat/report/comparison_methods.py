"""How the lives were compared, in words for the methods of a paper."""

import numpy as np

from animat.report.sections import restriction_words
from animat.statistics.estimates import LEVEL
from animat.statistics.findings import RESAMPLES, Findings
from animat.statistics.resampling import BOOTSTRAPPED_AT_MOST, CASES, COMBINATIONS, LIVES

WORDS = {
    "log-rank": "the log-rank test",
    "stratified log-rank": (
        "the log-rank test, stratified by the combinations of the other factors"
    ),
    "Kruskal-Wallis": "the Kruskal-Wallis test on the mean lifespans of cases",
    "Spearman": "Spearman's rank correlation of a factor with the mean lifespans of cases",
}
"""The tests that may have been made, by their names."""

PAIRED = (
    "where lives are paired by their seed and index, the mean difference within pairs, the share of"
    " pairs in which one outlives the other (with Wilson's interval, for the number of independent"
    " pairs that would vary as much), and the matched-pairs rank-biserial correlation (ties, such"
    " as two lives that reach the cap, ranked and counted for neither, as by Pratt)"
)


def statistics_words(found: Findings, scipy: str) -> list[str]:
    """The statistics that the page really has, a paragraph each; `scipy` is its version."""
    drawn = {found.resampled, *(margin.resampled for margin in found.margins)}
    units = "; for some factors, ".join(
        what for what in (LIVES, COMBINATIONS, CASES) if what in drawn
    )
    told = [
        f"Lifespans are described by Kaplan-Meier curves with pointwise log-log bands, and by"
        f" restricted means and medians. {restriction_words(found)} Physiological stability is the"
        " mean over a life of the mean of the drives. The success rate is the share of acts that"
        " succeeded.",
        f"Intervals are at {LEVEL:.0%}. Those of means, medians, rates and ratios are bootstrap"
        f" intervals of {RESAMPLES:,} resamples of {units}: BCa for means and ratios, percentiles"
        f" for medians; of more than {BOOTSTRAPPED_AT_MOST:,} such units, means are drawn from"
        " their joint normal law. Shares of the ways to die have Wilson's interval, which"
        " takes lives as independent.",
    ]
    if found.deaths and found.margins:
        told.append(_comparisons_words(found))
    if found.interactions:
        told.append(_interactions_words(found))
    told.append(f"Statistics were computed with SciPy {scipy}.")
    return told


def _comparisons_words(found: Findings) -> str:
    tests = dict.fromkeys(margin.test.name for margin in found.margins)
    comparisons = [one for margin in found.margins for one in margin.comparisons]
    tests |= dict.fromkeys(one.test.name for one in comparisons if not one.where)
    told = ", and by ".join(WORDS[name] for name in tests)
    if any(one.where for one in comparisons):
        told += ", and within single combinations by the log-rank test"
    paired = [one for one in comparisons if one.paired]
    sizes = [
        "Cliff's delta (the chance that a life of one group outlasts one of the other, less the"
        " chance of the contrary; the rank-biserial correlation) with DeLong's interval"
    ] * (len(paired) < len(comparisons))
    sizes += [PAIRED] * bool(paired)
    return (
        f"Factors and their levels were tested by {told}. Effect sizes are the ratio of restricted"
        f" mean lifespans, and {', and '.join(sizes)}. Hazard ratios are not given, as hazards are"
        " not proportional where curves cross. p values were corrected by Holm's method, for the"
        f" {len(found.factors_p)} tests of factors and for the {len(found.levels_p)} comparisons of"
        " levels each."
    )


def _interactions_words(found: Findings) -> str:
    tests, contrasts = (
        np.count_nonzero(~np.isnan(p)) for p in (found.interactions_p, found.contrasts_p)
    )
    return (
        "The interaction of two factors was tested by Hotelling's T² on the restricted mean"
        " lifespans of their combinations, averaged over the combinations of the other factors that"
        " have all of them, with sets of lives as units: for differences of differences, and for"
        " ratios of ratios on the scale of logarithms (delta method). Contrasts against the first"
        " levels have Student's test and interval. p values were corrected by Holm's method, for"
        f" the {tests} tests of interactions and for the {contrasts} tests of contrasts each."
    )

"""How well readings predict whether a claim holds: models of scikit-learn, cross-validated.

If a model that knows pairs of readings predicts more than one that adds up single readings, then
readings matter to each other. The tree says it in rules. Needs the extra `animat[multiverse]`.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from scipy import stats

from animat.statistics.claims import CLAIMS
from animat.statistics.estimates import LEVEL, Estimate, share
from animat.statistics.readings import MOST_UNIVERSES, Readings, codes, some_of
from animat.statistics.universes import holds

FOLDS = 10

LEAVES = 10
"""Rules that a tree has at most."""


class Rule(NamedTuple):
    """A leaf of a tree: universes that meet all conditions, and how often the claim holds there."""

    conditions: tuple[str, ...]
    universes: int
    share: Estimate


class Prediction(NamedTuple):
    """How often a claim is predicted rightly in universes not learnt from, and the tree's rules.

    `always` is the share of the more frequent answer, what one has without any model.
    """

    claim: str
    always: float
    single: Estimate
    pairs: Estimate
    tree: Estimate
    rules: tuple[Rule, ...]


def available() -> bool:
    """Whether scikit-learn is installed."""
    return find_spec("sklearn") is not None


def predict(universes: pa.Table, readings: Readings) -> list[Prediction]:
    """A logistic model of single readings, one of pairs, and a tree, for every claim.

    Claims that hold, or do not, in fewer universes than there are folds are left out: nothing can
    be learnt of them. Raises ModuleNotFoundError without scikit-learn.
    """
    from sklearn.linear_model import LogisticRegression
    from sklearn.model_selection import StratifiedKFold, cross_val_score
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import PolynomialFeatures
    from sklearn.tree import DecisionTreeClassifier

    universes = some_of(universes, MOST_UNIVERSES)
    had, names = _had(codes(universes, readings), readings)
    fewest = max(FOLDS, len(had) // 100)
    tree = DecisionTreeClassifier(max_leaf_nodes=LEAVES, min_samples_leaf=fewest, random_state=0)
    models = {
        "single": LogisticRegression(solver="liblinear"),
        "pairs": make_pipeline(
            PolynomialFeatures(2, interaction_only=True, include_bias=False),
            LogisticRegression(C=1.0, solver="liblinear"),
        ),
        "tree": tree,
    }
    folds = StratifiedKFold(FOLDS, shuffle=True, random_state=0)
    told = []
    for claim in CLAIMS:
        truth = holds(universes, claim)
        if min(truth.sum(), (~truth).sum()) < FOLDS:
            continue
        scores = {
            name: _over_folds(cross_val_score(model, had, truth, cv=folds))
            for name, model in models.items()
        }
        rules = tuple(_rules(tree.fit(had, truth).tree_, had, truth, names))
        always = max(truth.mean(), 1.0 - truth.mean())
        told.append(Prediction(claim, float(always), **scores, rules=rules))
    return told


def _had(
    code: NDArray[np.int64], readings: Readings
) -> tuple[NDArray[np.float64], list[tuple[str, str]]]:
    """Which values each universe has, 0 or 1: [U, values], and the names of the columns.

    Of a reading with two values one column says all.
    """
    columns, names = [], []
    for place, (reading, values) in enumerate(readings.items()):
        for value in range(1 if len(values) == 2 else 0, len(values)):
            columns.append(code[:, place] == value)
            names.append((reading, values[value]))
    return np.stack(columns, axis=1).astype(np.float64), names


def _over_folds(scores: NDArray[np.float64]) -> Estimate:
    """Mean accuracy with the t interval over folds."""
    mean = float(scores.mean())
    if np.ptp(scores) == 0.0:
        return Estimate(mean, mean, mean)
    low, high = stats.t.interval(LEVEL, len(scores) - 1, mean, stats.sem(scores))
    return Estimate(mean, float(max(low, 0.0)), float(min(high, 1.0)))


def _rules(
    tree: Any, had: NDArray[np.float64], truth: NDArray[np.bool_], names: Sequence[tuple[str, str]]
) -> list[Rule]:
    """The leaves of a fitted tree, the one whose share is highest first."""
    rules = []
    stack: list[tuple[int, NDArray[np.bool_], tuple[str, ...]]] = [
        (0, np.ones(len(had), dtype=bool), ())
    ]
    while stack:
        node, here, conditions = stack.pop()
        feature = tree.feature[node]
        if tree.children_left[node] == tree.children_right[node]:
            rules.append(
                Rule(conditions, int(here.sum()), share(int(truth[here].sum()), int(here.sum())))
            )
            continue
        reading, value = names[feature]
        has = had[:, feature] > 0.5
        sides = ((tree.children_right, has, "="), (tree.children_left, ~has, "≠"))
        for children, side, sign in sides:
            stack.append((children[node], here & side, (*conditions, f"{reading} {sign} {value}")))
    return sorted(rules, key=lambda rule: -rule.share.value)

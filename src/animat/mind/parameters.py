"""What the step reads of a mind: one record of numbers, and the codes of the built-in functions."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from animat.files.settings import nearest
from animat.mind import affordance, behaviours, drives, homeostasis, selection
from animat.mind.mind import Mind
from animat.mind.physiology import Variable
from animat.numerics.compiled import kernel
from animat.numerics.elementary import exponential
from animat.numerics.layout import Field, Layout

SHARED = (
    "likelihood_threshold",
    "encounter_range",
    "contact_range",
    "interaction_steps",
    "approach_steps",
    "leave_steps",
    "consumed",
    "feature_noise",
    "cruise_speed",
    "turn_speed",
)
"""The settings of a mind that the step reads as they are, under the same name."""


REAL, WHOLE = np.float64, np.int64

MIND = Layout(
    "mind",
    (
        Field("law", WHOLE, ("V",)),
        Field("low", REAL, ("V",)),
        Field("high", REAL, ("V",)),
        Field("rate", REAL, ("V",)),
        Field("factor", REAL, ("V",)),
        Field("set_point", REAL, ("V",)),
        Field("sense", REAL, ("V",)),
        Field("start", REAL, ("V",)),
        Field("dies_below", REAL, ("V",)),
        Field("dies_above", REAL, ("V",)),
        Field("drift_floor", REAL, ("V",)),
        Field("drift_ceiling", REAL, ("V",)),
        Field("act_floor", REAL, ("V",)),
        Field("act_ceiling", REAL, ("V",)),
        Field("a", REAL, ("D", "V")),
        Field("b", REAL, ("D", "V")),
        Field("serves", WHOLE, ("B",)),
        Field("needs", WHOLE, ("B",)),
        Field("success", REAL, ("B", "V")),
        Field("failure", REAL, ("B", "V")),
        Field("likelihood_threshold", REAL),
        Field("encounter_range", REAL),
        Field("contact_range", REAL),
        Field("feature_noise", REAL),
        Field("learning_rate", REAL),
        Field("learning_threshold", REAL),
        Field("learning_cycles", WHOLE),
        Field("error", WHOLE),
        Field("selector", WHOLE),
        Field("estimator", WHOLE),
        Field("learner", WHOLE),
        Field("wander", WHOLE),
        Field("judge", WHOLE),
        Field("interaction_steps", WHOLE),
        Field("approach_steps", WHOLE),
        Field("leave_steps", WHOLE),
        Field("cruise_speed", WHOLE),
        Field("turn_speed", WHOLE),
        Field("gated", np.bool_),
        Field("learns", np.bool_),
        Field("mortal", np.bool_),
        Field("consumed", np.bool_),
        Field("biases", np.bool_),
    ),
)
"""A mind's parameters, with V variables, D drives and B behaviours."""

mind_at = MIND.at


def parameters(mind: Mind, affordances: Sequence[str]) -> np.record:
    """Return everything the step reads of a mind, as one record of MIND.

    `affordances` are the names of the columns of the world's affordance table. Raises
    ValueError where a behaviour needs one that the world does not know.
    """
    variables = mind.resolved_variables()
    counts = {"V": len(variables), "D": len(mind.drives), "B": len(mind.behaviours)}
    record = np.zeros(1, MIND.dtype(counts))[0]
    for v, variable in enumerate(variables.values()):
        _fill_variable(record, v, variable, mind)
    shrink(record.rate, record.factor)
    names = list(variables)
    for d, drive in enumerate(mind.drives.values()):
        for matrix, coefficients in ((record.a, drive.a), (record.b, drive.b)):
            for watched, coefficient in coefficients.items():
                matrix[d, names.index(watched)] = coefficient
    for b, behaviour in enumerate(mind.behaviours.values()):
        record.serves[b] = list(mind.drives).index(behaviour.serves)
        if behaviour.needs not in affordances:
            raise ValueError(
                f'behaviours.{list(mind.behaviours)[b]}.needs = "{behaviour.needs}": no object'
                f" of this world affords it{nearest(behaviour.needs, affordances)}"
            )
        record.needs[b] = list(affordances).index(behaviour.needs)
        for given, row, sign, size in (
            (behaviour.success, record.success[b], 1.0, mind.success_effect),
            (behaviour.failure, record.failure[b], -1.0, mind.failure_effect),
        ):
            effects = given
            if effects is None:
                effects = dict.fromkeys(mind.drives[behaviour.serves].a, sign * size)
            for moved, relief in effects.items():
                v = names.index(moved)
                row[v] = relief * record.sense[v]
    record.error = (
        drives.CUSTOM_DRIVES if mind.drive_function is not None else drives.ERRORS[mind.error]
    )
    selector = mind.nature.selector if mind.selector is None else mind.selector
    record.selector = selection.SELECTORS.get(selector, selection.CUSTOM_SELECTOR)
    record.estimator = affordance.ESTIMATORS.get(
        mind.learning.estimator, affordance.CUSTOM_ESTIMATOR
    )
    record.learner = affordance.LEARNERS.get(mind.learning.learner, affordance.CUSTOM_LEARNER)
    record.wander = behaviours.WANDERERS.get(mind.wander, behaviours.CUSTOM_WANDER)
    record.gated = mind.gate == "positive"
    record.judge = mind.nature.judge
    record.learns = mind.nature.learns
    record.mortal = mind.mortal
    for name in SHARED:
        record[name] = getattr(mind, name)
    record.learning_rate = mind.learning.rate
    record.learning_cycles = mind.learning.cycles
    record.learning_threshold = mind.learning.threshold
    record.biases = mind.learning.biases
    return record


@kernel
def shrink(rates, factors):
    """Fill in exp(-rate), what a distance shrinks to in a step, for rates [V] per step."""
    for v in range(len(rates)):
        factors[v] = exponential(-rates[v])


def _fill_variable(record: np.record, v: int, variable: Variable, mind: Mind) -> None:
    deficit = variable.is_deficit
    law = homeostasis.LAWS.get(variable.law, homeostasis.CUSTOM_LAW)
    if law == homeostasis.LINEAR_FALL and not deficit:
        law = homeostasis.LINEAR_RISE
    record.law[v] = law
    for name in ("low", "high", "rate", "set_point", "start"):
        record[name][v] = getattr(variable, name)
    record.sense[v] = 1.0 if deficit else -1.0
    record.dies_below[v] = record.drift_floor[v] = -math.inf
    record.dies_above[v] = record.drift_ceiling[v] = math.inf
    record.act_floor[v] = -math.inf
    record.act_ceiling[v] = math.inf
    if not (mind.mortal and variable.lethal):
        record.drift_floor[v] = record.act_floor[v] = variable.low
        record.drift_ceiling[v] = record.act_ceiling[v] = variable.high
        return
    record.dies_below[v] = variable.dies_below
    record.dies_above[v] = variable.dies_above
    holds_low = (mind.failed_act if deficit else mind.overflow) == "clamp"
    holds_high = (mind.overflow if deficit else mind.failed_act) == "clamp"
    if holds_low:
        record.act_floor[v] = variable.dies_below
    if holds_high:
        record.act_ceiling[v] = variable.dies_above

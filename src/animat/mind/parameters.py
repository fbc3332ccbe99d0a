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


def mind_dtype(variables: int, drives: int, behaviours: int) -> np.dtype:
    """Return the layout of a mind's parameters with V variables, D drives and B behaviours."""
    per_variable = (variables,)
    real, whole = np.float64, np.int64
    return np.dtype(
        (
            np.record,
            [
                ("law", whole, per_variable),
                ("low", real, per_variable),
                ("high", real, per_variable),
                ("rate", real, per_variable),
                ("factor", real, per_variable),
                ("set_point", real, per_variable),
                ("sense", real, per_variable),
                ("start", real, per_variable),
                ("dies_below", real, per_variable),
                ("dies_above", real, per_variable),
                ("drift_floor", real, per_variable),
                ("drift_ceiling", real, per_variable),
                ("act_floor", real, per_variable),
                ("act_ceiling", real, per_variable),
                ("a", real, (drives, variables)),
                ("b", real, (drives, variables)),
                ("serves", whole, (behaviours,)),
                ("needs", whole, (behaviours,)),
                ("success", real, (behaviours, variables)),
                ("failure", real, (behaviours, variables)),
                ("likelihood_threshold", real),
                ("encounter_range", real),
                ("contact_range", real),
                ("feature_noise", real),
                ("learning_rate", real),
                ("learning_threshold", real),
                ("learning_cycles", whole),
                ("error", whole),
                ("selector", whole),
                ("estimator", whole),
                ("learner", whole),
                ("wander", whole),
                ("judge", whole),
                ("interaction_steps", whole),
                ("approach_steps", whole),
                ("leave_steps", whole),
                ("cruise_speed", whole),
                ("turn_speed", whole),
                ("gated", np.bool_),
                ("learns", np.bool_),
                ("mortal", np.bool_),
                ("consumed", np.bool_),
                ("biases", np.bool_),
            ],
        ),
        align=True,
    )


def parameters(mind: Mind, affordances: Sequence[str]) -> np.record:
    """Return everything the step reads of a mind, as one record of `mind_dtype`.

    `affordances` are the names of the columns of the world's affordance table. Raises
    ValueError where a behaviour needs one that the world does not know.
    """
    variables = mind.resolved_variables()
    dtype = mind_dtype(len(variables), len(mind.drives), len(mind.behaviours))
    record = np.zeros(1, dtype)[0]
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

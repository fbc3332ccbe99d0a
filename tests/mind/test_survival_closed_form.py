"""Life and death against mathematics: encounters replaced by a process whose survival is known.

A step is that of a life: the variable drifts, death is looked for, and what is met then takes
effect, after which death is looked for again.
"""

import math

import numpy as np
import pytest
from scipy.special import gammaln, logsumexp

from animat.mind.functions import unused_law
from animat.mind.homeostasis import FAILURE, METABOLISM, first_outside, metabolise, settle
from animat.mind.mind import Mind
from animat.mind.parameters import parameters
from animat.numerics.compiled import compiled
from animat.numerics.streams import OUTCOMES, uniforms

AFFORDANCES = ("grasp", "shelter", "interact")
LIVES = 200_000
SIGMAS = 4.5
LEVELS = 64  # a drift is 1/64 of the zone, so that every value is exact


def mind_of(**settings):
    """A mind that can die of nutrition only, which falls or rises by 1/64 a step."""
    variables = settings.pop("variables", {})
    spared = {"lethal": False}
    nutrition = {"rate": 1 / LEVELS, **variables}
    return parameters(
        Mind(
            physiology="linear",
            variables={"nutrition": nutrition, "stamina": spared, "restlessness": spared},
            **settings,
        ),
        AFFORDANCES,
    )


@compiled
def live(mind, seed, life, met, succeeds, values, values_after):
    """Live until death: return the steps lived and the cause."""
    for v in range(len(values)):
        values[v] = mind.start[v]
    step = 0
    while True:
        metabolise(values, mind, unused_law)
        step += 1
        if first_outside(values, mind) == 0:
            return step, METABOLISM
        meeting, success, _, _ = uniforms(seed, life, OUTCOMES, step)
        if meeting < met:
            effects = mind.success[0] if success < succeeds else mind.failure[0]
            for v in range(len(values)):
                values_after[v] = values[v] + effects[v]
            settle(values, values_after, mind)
            if first_outside(values, mind) == 0:
                return step, FAILURE


@compiled
def live_many(mind, seed, met, succeeds, lifespans, causes, values, values_after):
    for life in range(len(lifespans)):
        lifespans[life], causes[life] = live(
            mind, seed, np.uint64(life), met, succeeds, values, values_after
        )


def lives_of(mind, met, succeeds, seed):
    lifespans, causes = np.zeros(LIVES, np.int64), np.zeros(LIVES, np.int64)
    room = np.zeros(3), np.zeros(3)
    live_many(mind, np.uint64(seed), met, succeeds, lifespans, causes, *room)
    return lifespans, causes


def agree(share, probability):
    """Whether a share of the lives is what its probability makes likely."""
    deviation = np.sqrt(np.clip(probability * (1 - probability), 0, None) / LIVES)
    return (np.abs(share - probability) <= SIGMAS * deviation + 1e-12).all()


def run_free(n, r, p):
    """De Moivre: the probability that n trials hold no r failures in a row; success has p."""
    q = 1 - p

    def beta(m):
        terms = np.arange(m // (r + 1) + 1)
        sizes = gammaln(m - terms * r + 1) - gammaln(terms + 1) - gammaln(m - terms * (r + 1) + 1)
        return logsumexp(
            sizes + terms * (math.log(p) + r * math.log(q)), b=np.where(terms % 2, -1.0, 1.0)
        )

    if n < r:
        return 1.0
    return math.exp(beta(n)) - q**r * math.exp(beta(n - r))


@pytest.mark.parametrize(
    ("law", "start"), [({}, 1.0), ({"law": "linear", "kind": "excess", "set_point": 0.1}, 0.0)]
)
def test_survival_under_poisson_encounters_that_satisfy_fully(law, start):
    """From full, 64 drifts reach the bound and the 65th crosses it.

    So a life ends one step after the first 64 steps in a row that meet nothing: the waiting time
    for a run of failures (Feller 1968, "An Introduction to Probability Theory", XIII.7).
    """
    intensity = 0.05
    q = math.exp(-intensity)  # of no arrival in a step
    p = 1 - q
    mind = mind_of(success_effect=1.0, variables={**law, "start": start})
    lifespans, causes = lives_of(mind, p, 1.0, seed=11)
    assert (causes == METABOLISM).all()

    run = p * q**LEVELS
    mean = (1 - q**LEVELS) / run + 1
    deviation = math.sqrt(1 / run**2 - (2 * LEVELS + 1) / run - q / p**2)
    assert abs(lifespans.mean() - mean) < SIGMAS * deviation / math.sqrt(LIVES)
    assert lifespans.std() == pytest.approx(deviation, rel=0.02)

    assert lifespans.min() == LEVELS + 1
    times = np.array([65, 66, 80, 100, 129, 130, 200, 300, 500, 800, 1200, 2000])
    survival = np.array([run_free(int(t) - 1, LEVELS, p) for t in times])
    assert agree((lifespans[:, None] > times).mean(axis=0), survival)


def chain(met, succeeds, gain, loss, failed_act, lowest):
    """The chain of levels and of touching the bound: a step's transitions, and deaths by cause.

    `lowest` is the lowest live level. Touching the bound is as good as dead: the next drift kills.
    """
    touching = LEVELS + 1
    size = LEVELS + 2
    onward, by_drift, by_failure = np.zeros((size, size)), np.zeros(size), np.zeros(size)
    by_drift[touching] = 1.0
    by_drift[lowest] = 1.0
    for level in range(lowest + 1, LEVELS + 1):
        drifted = level - 1
        onward[level, drifted] += 1 - met
        onward[level, min(drifted + gain, LEVELS)] += met * succeeds
        if drifted - loss >= lowest:
            onward[level, drifted - loss] += met * (1 - succeeds)
        elif failed_act == "lethal":
            by_failure[level] += met * (1 - succeeds)
        else:
            onward[level, touching] += met * (1 - succeeds)
    return onward, by_drift, by_failure


@pytest.mark.parametrize("failed_act", ["lethal", "clamp"])
@pytest.mark.parametrize("margin", [0, 4])
def test_survival_under_encounters_that_satisfy_in_part(failed_act, margin):
    """Levels are 64ths. Without a margin a life ends below level 0, with one at level 4."""
    met, succeeds, gain, loss = 0.08, 0.7, 12, 20
    mind = mind_of(
        success_effect=gain / LEVELS,
        failure_effect=loss / LEVELS,
        failed_act=failed_act,
        variables={"lethal_margin": margin / LEVELS},
    )
    lifespans, causes = lives_of(mind, met, succeeds, seed=12 + margin)
    lowest = margin + 1 if margin else 0
    onward, by_drift, by_failure = chain(met, succeeds, gain, loss, failed_act, lowest)
    born = np.zeros(len(onward))
    born[LEVELS // 2] = 1.0
    unfinished = (np.eye(len(onward)) - onward).T
    visits = np.linalg.solve(unfinished, born)
    again = np.linalg.solve(unfinished, visits)
    mean, second = visits.sum(), (2 * again - visits).sum()
    deviation = math.sqrt(second - mean**2)
    assert abs(lifespans.mean() - mean) < SIGMAS * deviation / math.sqrt(LIVES)
    assert lifespans.std() == pytest.approx(deviation, rel=0.02)
    assert agree((causes == METABOLISM).mean(), visits @ by_drift)
    assert agree((causes == FAILURE).mean(), visits @ by_failure)
    assert visits @ (by_drift + by_failure) == pytest.approx(1.0)

    times, survival = [5, 10, 20, 28, 32, 33, 34, 40, 60, 100, 200, 400, 800], []
    alive, lived = born, 0
    for time in times:
        while lived < time:
            alive, lived = alive @ onward, lived + 1
        survival.append(alive.sum())
    assert agree((lifespans[:, None] > np.array(times)).mean(axis=0), np.array(survival))

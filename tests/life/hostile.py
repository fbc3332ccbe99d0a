"""Custom functions that go wrong, in a way that a number they are given says.

With other numbers they behave. See test_failure.py, which counts on what is said here.
"""

import math

from animat.mind.behaviours import curved_wander
from animat.mind.drives import signed
from animat.numerics.compiled import compiled


def law(value, low, high, rate, factor):
    """Go wrong, by the rate, after an act has raised the value."""
    if value > 0.55:
        if rate == 2e-4:
            return math.nan
        if rate == 3e-4:
            return -math.inf
        if rate == 4e-4:
            raise ValueError("no way,\n out of here")
    return low + (value - low) * factor


def drives(values, changes, set_points, senses, a, b, out):
    """Go wrong, by b[0, 0], after an act; tell the selector by b[2, 1] what to do."""
    signed(values, changes, set_points, senses, a, b, out)
    if b[0, 0] > 0.0 and values[0] > 0.55:
        if b[0, 0] == 2.0:
            raise ZeroDivisionError("nothing left")
        out[1] = math.nan
    out[2] += 10.0 * b[2, 1]


def selector(drives, likelihoods, serves, u, memory):
    """Go wrong, by the last drive, now and then; choose nothing now and then."""
    wrong = int(drives[2] / 10.0 + 0.4)
    if u < 0.3:
        if wrong == 1:
            return 99
        if wrong == 2:
            return -2
        if wrong == 3:
            raise KeyError
    if u > 0.9:
        return -1
    best = 0
    for behaviour in range(1, len(serves)):
        if drives[serves[behaviour]] > drives[serves[best]]:
            best = behaviour
    return best


def estimator(features, weights, hidden):
    """Go wrong by the first weight."""
    hidden[0] = features[0]
    if weights[0] == 3.0:
        return math.nan
    if weights[0] == 4.0:
        raise ValueError("who knows")
    return 0.5 + 0.1 * hidden[0]


def learner(features, weights, hidden, target, rate, cycles, biases):
    """Go wrong by the rate."""
    if rate == 2.0:
        raise StopIteration
    hidden[0] = 1.0
    weights[1] = math.inf if rate == 1.0 else rate * target


def wander(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    """Go wrong, by the speed, now and then."""
    if u_a < 0.0005:
        if speed == 6:
            return 1000.0, 3.0
        if speed == 7:
            return 3.0, -11.0
        if speed == 8:
            return math.nan, 3.0
        if speed == 9:
            return 3.0, math.inf
        if speed == 10:
            raise MemoryError("stop")
    return curved_wander(readings, aheads, sides, memory, u_a, u_b, 5, turn)


@compiled
def overwrite(numbers):
    """Write to an array that somebody else was given."""
    numbers[0] = 0.5


def writes_drives(values, changes, set_points, senses, a, b, out):
    """Write where all lives read, by a helper."""
    overwrite(set_points)
    signed(values, changes, set_points, senses, a, b, out)


def writes_selector(drives, likelihoods, serves, u, memory):
    """Write to a view."""
    rest = likelihoods[1:]
    rest[0] = 0.0
    return 0


def writes_estimator(features, weights, hidden):
    """Write what only a learner may."""
    weights[:] = 0.0
    return 0.5


def writes_learner(features, weights, hidden, target, rate, cycles, biases):
    """Write to the object."""
    features.fill(1.0)


def writes_wander(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    """Write to one of two arrays."""
    either = memory if u_a < 0.5 else aheads
    either[0] = 1.0
    return speed, speed

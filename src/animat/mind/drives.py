"""Drives: urges to act, raised by the errors of the homeostatic variables.

Equation 3 in matrix form: M = A e + B dV/dt, with the error e = set point - value for a variable
of the deficit kind and value - set point for one of the excess kind, so that a drive is positive
when there is something to put right. dV/dt is the change since the last step, per step.

A drive function has the signature `drives(values, changes, set_points, senses, a, b, out)`:
`values`, `changes`, `set_points`, `senses` are [V], `a` and `b` are [D, V], and it fills `out` [D].
`senses` holds +1 for the deficit kind and -1 for the excess kind.
"""

from __future__ import annotations

import math

from animat.numerics.compiled import compiled

SIGNED, RECTIFIED, ABSOLUTE, CUSTOM_DRIVES = range(4)

ERRORS = {"signed": SIGNED, "rectified": RECTIFIED, "absolute": ABSOLUTE}
"""The code of each reading of the error, by its name."""


@compiled
def signed(values, changes, set_points, senses, a, b, out):
    """Equation 3: an error past the set point counts negative."""
    for d in range(len(out)):
        drive = 0.0
        for v in range(len(values)):
            error = senses[v] * (set_points[v] - values[v])
            drive += a[d, v] * error + b[d, v] * changes[v]
        out[d] = drive


@compiled
def rectified(values, changes, set_points, senses, a, b, out):
    """Equation 3 with errors past the set point taken as none."""
    for d in range(len(out)):
        drive = 0.0
        for v in range(len(values)):
            error = max(senses[v] * (set_points[v] - values[v]), 0.0)
            drive += a[d, v] * error + b[d, v] * changes[v]
        out[d] = drive


@compiled
def absolute(values, changes, set_points, senses, a, b, out):
    """Equation 3 with the magnitude of the error, as the paper's prose has it."""
    for d in range(len(out)):
        drive = 0.0
        for v in range(len(values)):
            error = abs(set_points[v] - values[v])
            drive += a[d, v] * error + b[d, v] * changes[v]
        out[d] = drive


@compiled
def raise_drives(values, changes, mind, out, custom):
    """Fill `out` [D] with the drives, by the mind's drive function.

    `changes` [V] is what the values have changed by since the last step: dV/dt times one step.
    """
    if mind.error == SIGNED:
        signed(values, changes, mind.set_point, mind.sense, mind.a, mind.b, out)
    elif mind.error == RECTIFIED:
        rectified(values, changes, mind.set_point, mind.sense, mind.a, mind.b, out)
    elif mind.error == ABSOLUTE:
        absolute(values, changes, mind.set_point, mind.sense, mind.a, mind.b, out)
    else:
        custom(values, changes, mind.set_point, mind.sense, mind.a, mind.b, out)


@compiled
def all_finite(values):
    """Tell whether all of some numbers are finite."""
    for value in values:
        if not math.isfinite(value):
            return False
    return True


@compiled
def strongest(drives):
    """Return the index of the strongest drive; of equal ones, the first."""
    winner = 0
    for d in range(1, len(drives)):
        if drives[d] > drives[winner]:
            winner = d
    return winner

"""Sine, cosine, the exponential and the logistic function, with the same bits everywhere.

The functions of a system's mathematical library differ between systems in their last bit, and a
life would not be the same life. These are made of additions, multiplications and divisions alone,
which IEEE 754 rounds in one way only, and of scaling by powers of two.

Each reduces its argument to a small interval around zero, with the reduced argument in two parts
so that nothing of it is lost (Cody and Waite 1980, "Software Manual for the Elementary
Functions"), and sums the Taylor series there; the coefficients are reciprocals of factorials. The
even and the odd terms are summed apart, so that a processor can work on both at once.
"""

import math

import numpy as np

from animat.numerics.compiled import compiled

# A quarter of a turn, in radians, as a float and what that float lacks.
_TWO_BY_PI = 2.0 / math.pi
_QUARTER_TURN = math.pi / 2.0
_QUARTER_TURN_REST = 6.123233995736766e-17

# The same in parts of 33 bits, so that a product with a whole number below 2**20 is exact.
_QUARTER_TURN_1 = 1.5707963267341256
_QUARTER_TURN_2 = 6.077100506303966e-11
_QUARTER_TURN_3 = 2.0222662487111665e-21
_QUARTER_TURN_4 = 8.4784276603689e-32

# The float has 50 bits, so that its products with -4..4, the quarter turns up to here, are exact.
_NEAR = 7.0
_FAR = 1e6

# Adding this to a float below 2**51 leaves no bits after the point: the sum is a whole number.
_ROUNDER = 1.5 * 2.0**52

_LOG2_E = 1.4426950408889634
# ln 2 in a part of 40 bits, exact in a product with a whole number below 2**13, and the rest.
_LN_2 = 0.6931471805592082
_LN_2_REST = 7.371002565167799e-13
_OVERFLOW = 709.782712893384
_UNDERFLOW = -745.1332191019412
_EXPONENT_BIAS = 1023
_FRACTION_BITS = 52


@compiled
def sine_cosine(angle: float) -> tuple[float, float]:
    """Return (sine, cosine) of an angle in radians.

    Each is within one unit in the last place for angles up to a million radians either way, and
    not a number beyond. Fastest within 7 rad, a full turn either way. The sine of -0.0 is 0.0.
    """
    if abs(angle) <= _NEAR:
        turns = (angle * _TWO_BY_PI + _ROUNDER) - _ROUNDER
        rough = angle - turns * _QUARTER_TURN
        correction = turns * _QUARTER_TURN_REST
        r = rough - correction
        rest = (rough - r) - correction
    elif abs(angle) <= _FAR:
        turns, r, rest = _reduced(angle)
    else:
        return math.nan, math.nan

    z = r * r
    z2 = z * z
    # sin r = r + r z (-1/3! + z/5! - ...), cos r = 1 - z/2 + z z (1/4! - z/6! + ...)
    sine_odd = -1.0 / 6.0 + z2 * (
        -1.0 / 5040.0 + z2 * (-1.0 / 39916800.0 + z2 * (-1.0 / 1307674368000.0))
    )
    sine_even = 1.0 / 120.0 + z2 * (
        1.0 / 362880.0 + z2 * (1.0 / 6227020800.0 + z2 * (1.0 / 355687428096000.0))
    )
    cosine_even = 1.0 / 24.0 + z2 * (
        1.0 / 40320.0 + z2 * (1.0 / 479001600.0 + z2 * (1.0 / 20922789888000.0))
    )
    cosine_odd = -1.0 / 720.0 + z2 * (-1.0 / 3628800.0 + z2 * (-1.0 / 87178291200.0))
    # The parts of r and of 1 - z/2 that rounding dropped come back through the derivative.
    half = 0.5 * z
    near_one = 1.0 - half
    dropped = (1.0 - near_one) - half
    sine = r + (rest * near_one + r * z * (sine_odd + z * sine_even))
    cosine = near_one + (dropped + (z2 * (cosine_even + z * cosine_odd) - r * rest))

    quarter = int(turns) & 3
    if quarter & 1:
        sine, cosine = cosine, -sine
    if quarter & 2:
        sine, cosine = -sine, -cosine
    return sine, cosine


@compiled
def exponential(x: float) -> float:
    """Return e to the power `x`, for any float.

    Within one unit in the last place; infinity where it overflows, 0 where it underflows, not a
    number for not a number.
    """
    if math.isnan(x):
        return math.nan
    if x > _OVERFLOW:
        return math.inf
    if x < _UNDERFLOW:
        return 0.0

    doublings = (x * _LOG2_E + _ROUNDER) - _ROUNDER
    rough = x - doublings * _LN_2
    correction = doublings * _LN_2_REST
    r = rough - correction
    rest = (rough - r) - correction

    z = r * r
    # exp r = 1 + r + z (1/2! + r/3! + ...)
    even = 1.0 / 2.0 + z * (
        1.0 / 24.0
        + z * (1.0 / 720.0 + z * (1.0 / 40320.0 + z * (1.0 / 3628800.0 + z * (1.0 / 479001600.0))))
    )
    odd = 1.0 / 6.0 + z * (
        1.0 / 120.0
        + z
        * (1.0 / 5040.0 + z * (1.0 / 362880.0 + z * (1.0 / 39916800.0 + z * (1.0 / 6227020800.0))))
    )
    near = 1.0 + r
    dropped = (1.0 - near) + r
    mantissa = near + (dropped + (rest + z * (even + r * odd)))

    # In two steps: 2**1024 is no float, and a subnormal result is rounded by the second step only.
    exponent = int(doublings)
    first = exponent >> 1
    return mantissa * _power_of_two(first) * _power_of_two(exponent - first)


@compiled
def logistic(x: float) -> float:
    """Return 1 / (1 + exp(-x)) for any float, within 3 units in the last place.

    0 and 1 far out; not a number for not a number.
    """
    if x >= 0.0:
        return 1.0 / (1.0 + exponential(-x))
    small = exponential(x)
    return small / (1.0 + small)


@compiled
def _reduced(angle: float) -> tuple[float, float, float]:
    """Return the nearest whole number of quarter turns and what remains, in two parts.

    No float within a million radians is nearer to a multiple of a quarter turn than 2**-61, and
    what is lost here is below 2**-130.
    """
    turns = (angle * _TWO_BY_PI + _ROUNDER) - _ROUNDER
    rough = angle - turns * _QUARTER_TURN_1
    finer, lost = _difference(rough, turns * _QUARTER_TURN_2)
    finest, lost_again = _difference(finer, turns * _QUARTER_TURN_3)
    tail = (lost + lost_again) - turns * _QUARTER_TURN_4
    r = finest + tail
    return turns, r, (finest - r) + tail


@compiled
def _difference(a: float, b: float) -> tuple[float, float]:
    """Return a - b rounded, and exactly what the rounding dropped (Knuth's TwoSum)."""
    rounded = a - b
    of_b = rounded - a
    return rounded, (a - (rounded - of_b)) - (b + of_b)


@compiled
def _power_of_two(exponent: int) -> float:
    """Return 2**exponent, exactly, for an exponent in -1022..1023."""
    return float(np.int64((exponent + _EXPONENT_BIAS) << _FRACTION_BITS).view(np.float64))

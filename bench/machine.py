"""What this machine can do at best: nanoseconds of an operation when nothing waits, and in a chain.

Compiled as the functions of a step are. Independent operations stand in as many chains as it takes
to keep the processor busy; a compiler that would join them into vectors is told not to, as it is
for a step.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np
from numba import njit

import figures
from animat.numerics.compiled import OPTIONS
from figures import Table

PRODUCT = "64-bit product"
FLOAT = "addition or product of floats"
QUOTIENT = "quotient of floats"
CHAINED_PRODUCT = "64-bit product and xor, of the last"
CHAINED_FLOAT = "addition or product of floats, of the last"

_ONE = np.uint64(1)
_FACTOR = np.uint64(0xD2511F53)


@njit(**OPTIONS)
def products(times, a):
    """Make 8 independent products, so many times; the xors keep them from being joined."""
    b, c, d, e = a + _ONE, a + _ONE + _ONE, a * _FACTOR, a * _FACTOR + _ONE
    f, g, h = b * _FACTOR, c * _FACTOR, d * _FACTOR
    for _ in range(times):
        a, b, c, d = (a * _FACTOR) ^ a, (b * _FACTOR) ^ b, (c * _FACTOR) ^ c, (d * _FACTOR) ^ d
        e, f, g, h = (e * _FACTOR) ^ e, (f * _FACTOR) ^ f, (g * _FACTOR) ^ g, (h * _FACTOR) ^ h
    return a ^ b ^ c ^ d ^ e ^ f ^ g ^ h


@njit(**OPTIONS)
def floats(times, a, factor, term):
    """Make 12 independent products and 12 independent additions, so many times."""
    b, c, d, e, f = a + 1.0, a + 2.0, a + 3.0, a + 4.0, a + 5.0
    g, h, i, j, k, m = a + 6.0, a + 7.0, a + 8.0, a + 9.0, a + 10.0, a + 11.0
    for _ in range(times):
        a, b, c, d = a * factor + term, b * factor + term, c * factor + term, d * factor + term
        e, f, g, h = e * factor + term, f * factor + term, g * factor + term, h * factor + term
        i, j, k, m = i * factor + term, j * factor + term, k * factor + term, m * factor + term
    return a + b + c + d + e + f + g + h + i + j + k + m


@njit(**OPTIONS)
def quotients(times, a, over):
    """Make 6 independent quotients, so many times."""
    b, c, d, e, f = a + 1.0, a + 2.0, a + 3.0, a + 4.0, a + 5.0
    for _ in range(times):
        a, b, c, d, e, f = over / a, over / b, over / c, over / d, over / e, over / f
    return a + b + c + d + e + f


@njit(**OPTIONS)
def chained_products(times, a):
    """Make 8 products and xors, each of the last, so many times."""
    for _ in range(times):
        for _ in range(8):
            a = (a * _FACTOR) ^ a
    return a


@njit(**OPTIONS)
def chained_floats(times, a, factor, term):
    """Make 12 products and 12 additions, each of the last, so many times."""
    for _ in range(times):
        for _ in range(12):
            a = a * factor + term
    return a


MEASURED: dict[str, tuple[Callable[..., object], tuple[object, ...], int]] = {
    PRODUCT: (products, (np.uint64(3),), 8),
    FLOAT: (floats, (1.5, 0.999, 0.001), 24),
    QUOTIENT: (quotients, (1.5, 2.5), 6),
    CHAINED_PRODUCT: (chained_products, (np.uint64(3),), 8),
    CHAINED_FLOAT: (chained_floats, (1.5, 0.999, 0.001), 24),
}
"""By name: what makes the operations, of what, and how many at a time."""


def rates(repeat: int, times: int) -> dict[str, float]:
    """Return the nanoseconds of every operation."""
    measures = {name: partial(nanoseconds, name, times) for name in MEASURED}
    for name in MEASURED:
        nanoseconds(name, 1)  # compiles
    return {name: min(taken) for name, taken in figures.in_turns(measures, repeat).items()}


def nanoseconds(name: str, times: int) -> float:
    """Return the nanoseconds of an operation."""
    function, arguments, number = MEASURED[name]
    start = time.thread_time()
    function(times, *arguments)
    return 1e9 * (time.thread_time() - start) / (times * number)


def table(measured: dict[str, float]) -> Table:
    """Return the rates as a table."""
    rows = [{"operation": name, "ns": value} for name, value in measured.items()]
    return Table("What this machine does at best", rows)

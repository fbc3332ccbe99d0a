"""Random numbers that are a pure function of who asks, for what, and when.

Philox4x32-10 (Salmon, Moraes, Dror and Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3",
SC'11): a keyed bijection of 128-bit counters. There is no state to carry, so a life draws the same
numbers on any thread, in any batch and in any order. A draw is addressed by

* `seed`: the study's, 64 bits, the key of the bijection;
* `life`: the life's index in the study, 64 bits;
* `purpose`: one of the constants below, 0..255, a stream of its own for each use, so that two
  agents with the same seed meet the same motor noise whatever else they draw;
* `index`: the position in the stream, 0..2**56 - 1, usually the step.

Different addresses are different counters or keys, so streams never overlap. One address yields
four words of 32 bits.
"""

import numpy as np

from animat.numerics.compiled import compiled

START = 0
MOTORS = 1
SENSORS = 2
WANDER = 3
WEIGHTS = 4
OUTCOMES = 5
SELECTION = 6
FEATURES = 7
PLACEMENT = 8
LAYOUT = 9

# Numba turns a mixture of signed and unsigned integers into floats, so every constant is unsigned.
_MASK = np.uint64(0xFFFFFFFF)
_32 = np.uint64(32)
_24 = np.uint64(24)
_MULTIPLIER_0 = np.uint64(0xD2511F53)
_MULTIPLIER_1 = np.uint64(0xCD9E8D57)
_WEYL_0 = np.uint64(0x9E3779B9)
_WEYL_1 = np.uint64(0xBB67AE85)
_ROUNDS = 10

_TO_UNIT = 2.0**-32


@compiled
def philox4x32(
    c0: np.uint64, c1: np.uint64, c2: np.uint64, c3: np.uint64, k0: np.uint64, k1: np.uint64
) -> tuple[np.uint64, np.uint64, np.uint64, np.uint64]:
    """Return the four words that Philox4x32-10 makes of counter `c` under key `k`.

    All are `np.uint64` that hold 32 bits each: the products need 64.
    """
    for _ in range(_ROUNDS):
        product_0 = _MULTIPLIER_0 * c0
        product_1 = _MULTIPLIER_1 * c2
        c0 = (product_1 >> _32) ^ c1 ^ k0
        c1 = product_1 & _MASK
        c2 = (product_0 >> _32) ^ c3 ^ k1
        c3 = product_0 & _MASK
        k0 = (k0 + _WEYL_0) & _MASK
        k1 = (k1 + _WEYL_1) & _MASK
    return c0, c1, c2, c3


@compiled
def bits(
    seed: np.uint64, life: np.uint64, purpose: int, index: int
) -> tuple[np.uint64, np.uint64, np.uint64, np.uint64]:
    """Return the four raw words of 32 bits at an address, each held in an `np.uint64`."""
    key = np.uint64(seed)
    individual = np.uint64(life)
    position = np.uint64(index)
    return philox4x32(
        position & _MASK,
        individual & _MASK,
        individual >> _32,
        (np.uint64(purpose) << _24) | (position >> _32),
        key & _MASK,
        key >> _32,
    )


@compiled
def uniforms(
    seed: np.uint64, life: np.uint64, purpose: int, index: int
) -> tuple[float, float, float, float]:
    """Return four uniform numbers in [0, 1) at an address, each a multiple of 2**-32."""
    b0, b1, b2, b3 = bits(seed, life, purpose, index)
    return _unit(b0), _unit(b1), _unit(b2), _unit(b3)


@compiled
def whole(u: float, n: int) -> int:
    """Return a whole number 0..n-1 made of a uniform `u` in [0, 1).

    `n` is 1..2**21, for which the product is exact; probabilities are off 1/n by less than 2**-32.
    """
    return int(u * n)


@compiled
def _unit(word: np.uint64) -> float:
    # Through a signed integer, because processors convert those to floats in one instruction.
    return float(np.int64(word)) * _TO_UNIT

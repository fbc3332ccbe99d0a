"""The digest of a life at a step: equal digests, equal lives."""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import NDArray

from animat.numerics.layout import PADDING

SCRATCH = (
    *("readings", "hidden", "values_after", "drives_after", "changes_after"),
    *("asked", "failure", "given", "met"),
    PADDING,
)
"""The fields of a state that hold nothing that a later step reads; no digest takes them in."""


def digest(state: np.record, present: NDArray[np.uint8]) -> str:
    """Return 32 hexadecimal digits (BLAKE2b) of what a life is after a step.

    They cover every bit of every field of the `state` but those of SCRATCH, under its name and with
    its shape, and which sites hold an object, `present` [S]; neither the order of the fields nor
    the bytes between them nor the byte order of the machine matters. Every not-a-number counts as
    the same: processors differ in its bits. A likelihood that is none yet counts as 0, and a
    selector's memory in which nothing is as none.
    """
    total = hashlib.blake2b(digest_size=16)
    for name in sorted(set(state.dtype.names or ()) - set(SCRATCH)):
        value = state[name]
        if name == "choice_memory" and not value.any():
            continue
        if name == "likelihoods":
            value = np.where(np.isnan(value), 0.0, value)
        _add(total, name, value)
    _add(total, "present", present)
    return total.hexdigest()


def _add(total: hashlib.blake2b, name: str, value: object) -> None:
    """Take in an array or a number, with its name, type and shape."""
    values = np.asarray(value)
    if values.dtype.kind == "f":
        values = np.where(np.isnan(values), np.nan, values)
    plain = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
    total.update(f"{name} {plain.dtype.str} {values.shape}\n".encode() + plain.tobytes())

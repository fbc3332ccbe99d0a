"""Functions that are only inlined: the private parts of Numba that this leans on."""

from __future__ import annotations

import pickle
import re

import numba
import numpy as np
import pytest

from animat.numerics.compiled import OPTIONS
from animat.numerics.inlined import InlinedDispatcher, InlinedLibrary, inlined

needs_a_compiler = pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
pytestmark = needs_a_compiler


def scaled_sum(values, factor):
    total = 0.0
    for value in values:
        total += factor * value
    return total


def failing(value):
    if value < 0.0:
        raise ValueError("below zero")
    return value


@pytest.fixture(scope="module")
def kernel_and_inlined():
    ours = inlined(scaled_sum, **OPTIONS)

    @numba.njit(**OPTIONS)
    def kernel(rows, factor):
        total = 0.0
        for row in rows:
            total += ours(row, factor)
        return total

    return kernel, ours


def test_a_kernel_computes_with_an_inlined_function_what_numba_does(kernel_and_inlined):
    kernel, _ = kernel_and_inlined
    rows = np.random.default_rng(1).normal(size=(5, 7))
    usual = numba.njit(**OPTIONS)(scaled_sum)
    assert kernel(rows, 0.3) == sum(usual(row, 0.3) for row in rows)


def test_no_machine_code_is_made_of_it_and_none_is_called(kernel_and_inlined):
    kernel, ours = kernel_and_inlined
    kernel(np.zeros((1, 1)), 1.0)
    libraries = [each.library for each in ours.overloads.values()]
    assert libraries
    for library in libraries:
        assert isinstance(library, InlinedLibrary)
        assert library.get_pointer_to_function("any") == 0
    (overload,) = kernel.overloads.values()
    text = overload.library.get_llvm_str()
    assert "scaled_sum" in text  # in what LLVM notes of aliases
    assert not re.search(r"(define|declare|call) [^\n]*@[^\n(]*scaled_sum", text)


def test_python_can_call_it_before_and_after_a_kernel_did(kernel_and_inlined):
    kernel, ours = kernel_and_inlined
    values = np.array([1.0, 2.0])
    assert ours(values, 2.0) == 6.0
    assert kernel(values.reshape(1, 2), 2.0) == 6.0
    assert ours(values, 2.0) == 6.0
    assert ours(np.array([3]), 2.0) == 6.0


def test_what_it_raises_leaves_the_kernel():
    ours = inlined(failing, **OPTIONS)

    @numba.njit(**OPTIONS)
    def kernel(value):
        return ours(value)

    assert kernel(1.0) == 1.0
    with pytest.raises(ValueError, match="below zero"):
        kernel(-1.0)


def test_it_is_made_anew_from_what_is_pickled():
    ours = inlined(failing, **OPTIONS)
    again = pickle.loads(pickle.dumps(ours))
    assert isinstance(again, InlinedDispatcher)
    assert again(2.0) == 2.0

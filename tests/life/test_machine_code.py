"""The compiled step holds nothing that another processor, or a GPU, could not do to the bit."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest

from animat.numerics.compiled import OPTIONS

from . import machine_code

pytestmark = pytest.mark.long

HERE = Path(__file__).parent

STEPS = tuple(
    f"animat.life.kernels.{name}"
    for name in ("advance", "advance_recorded", "advance_to_choice", "take_choice", "command")
)


@pytest.fixture(scope="module")
def codes() -> dict[str, list[str]]:
    return machine_code.codes()


def test_every_kernel_is_looked_at(codes):
    """Whoever adds one has it run in machine_code.py."""
    assert [name for name, found in codes.items() if not found] == []
    for name in STEPS:
        assert len(codes[name]) >= 2
        for code in codes[name]:
            assert len(re.findall(r" = f(?:add|mul) ", code)) > 1_000


def test_no_kernel_does_what_another_processor_might_do_otherwise(codes):
    """A world is drawn with square roots, which IEEE 754 rounds in one way; a step needs none."""
    for name, found in codes.items():
        for code in found:
            allowed = set() if name in STEPS else {"calls sqrt", "calls floor"}
            assert set(machine_code.offences(code)) <= allowed, name


@pytest.mark.parametrize("name", STEPS)
def test_a_step_compiles_for_a_gpu(name, codes):
    """Down to the code that NVIDIA's driver takes, with nothing left to link."""
    for code in codes[name]:
        assert machine_code.offences(code) == []  # some would be the end of the compiler
        made = machine_code.for_processor(code, "nvptx64-nvidia-cuda", "sm_70")
        assert made.count("mul.rn.f64") > 500
        assert ".extern" not in made
        assert not re.search(r"\bfma\.|\b(?:add|sub|mul)\.f64", made)


@pytest.mark.parametrize("name", STEPS)
def test_nothing_is_fused_on_an_arm(name, codes):
    """Of which every one could."""
    for code in codes[name]:
        assert machine_code.offences(code) == []
        made = machine_code.for_processor(code, "aarch64-unknown-linux-gnu", "neoverse-n1")
        assert len(re.findall(r"^\s*fmul\b", made, re.MULTILINE)) > 500
        assert not re.search(r"^\s*f(?:n?m(?:add|sub)|ml[as])\b", made, re.MULTILINE)


NUMBERS = np.arange(5.0)


def sine(x):
    return math.sin(x)


def power(x):
    return x**x


def raising(x):
    if x > 3.0:
        raise ValueError
    return x


def picking(x):
    return (x, 2.0, 3.0)[int(x)]


def reading(x):
    return NUMBERS[int(x)]


def allocating(x):
    return np.empty(int(x)).sum()


def listing(x):
    return len([x] * int(x))


def printing(x):
    print(x)  # noqa: T201
    return x


def product_and_sum(x):
    return x * x + 1.0


def harmless(x):
    total = 0.0
    for n in range(10):
        total += min(abs(x), 3.0) / (n + 1) if int(x) & n else math.sqrt(x)
    return total


def compiled(function: Any, **options: Any) -> str:
    dispatcher = numba.njit(**{**OPTIONS, **options})(function)
    dispatcher(2.0)
    (code,) = machine_code.intermediate_codes(dispatcher)
    return code


@pytest.mark.parametrize(
    ("function", "options", "offence"),
    [
        (sine, {}, r"calls (llvm\.)?sin"),
        (power, {}, r"calls (llvm\.)?pow"),
        (raising, {}, r"reads @\.const\.pickle"),
        (picking, {}, r"reads @\.const\.pickle"),
        (reading, {}, r"reads @"),
        (allocating, {"_nrt": True}, r"calls NRT_"),
        (listing, {"_nrt": True}, r"calls NRT_"),
        (printing, {}, r"calls (Py|numba_)"),
        (product_and_sum, {"fastmath": True}, r"may be rearranged: fmul fast"),
        (product_and_sum, {"fastmath": {"contract"}}, r"may be rearranged: fmul contract"),
    ],
    ids=lambda value: getattr(value, "__name__", None),
)
def test_what_no_step_may_do_is_found(function, options, offence):
    found = machine_code.offences(compiled(function, **options))
    assert any(re.match(offence, one) for one in found), found


def test_what_a_step_may_do_is_not_found():
    assert set(machine_code.offences(compiled(harmless))) <= {"calls sqrt"}
    assert machine_code.offences(compiled(product_and_sum)) == []


def test_what_is_fused_or_missing_is_found_in_code_for_other_processors(codes):
    gpu, arm = ("nvptx64-nvidia-cuda", "sm_70"), ("aarch64-unknown-linux-gnu", "neoverse-n1")
    fast = compiled(product_and_sum, fastmath=True)
    assert re.search(r"\bfma\.", machine_code.for_processor(fast, *gpu))
    assert re.search(r"^\s*fmadd\b", machine_code.for_processor(fast, *arm), re.MULTILINE)
    (drawing,) = codes["animat.world.raster._draw_blocks"]
    assert re.search(r"\.extern .* sqrt$", machine_code.for_processor(drawing, *gpu), re.MULTILINE)

"""The count of instructions: exact, and high enough for a build that is a little slower."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numba
import pytest

import animat
from animat.life.kernels import advance
from animat.life.model import Key, Model
from animat.life.scenario import bring_together
from animat.life.state import STATE, state_at
from animat.life.step import step
from animat.mind.functions import BUILT_IN, ROLES, SLOTS
from animat.mind.parameters import MIND, mind_at
from animat.numerics.compiled import OPTIONS
from animat.numerics.linked import linked
from animat.robot.parameters import ROBOT, robot_at
from animat.world.scene import Scene

SCRIPT = Path(__file__).parents[1] / "bench" / "instructions.py"
SLOWER = 30
"""Operations more in every step of the slowed build."""


@pytest.fixture(scope="module")
def instructions() -> Any:
    spec = importlib.util.spec_from_file_location("instructions", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def rounds(n, x):
    total = 0.0
    for i in range(n):
        total = total * x + i
        if total > 1e6:
            total -= 1e6
    return total


def more_rounds(n, x):
    total = 0.0
    for i in range(n):
        total = total * x + i
        total = total / x + x
        if total > 1e6:
            total -= 1e6
    return total


def chosen(n, x):
    if n == 1:
        return x
    elif n == 2:
        return x * x
    elif n == 3:
        return x / 3.0
    elif n == 4:
        return x + 1.0
    return -x


def compiled(function):
    dispatcher = numba.njit(**OPTIONS)(function)
    dispatcher(3, 0.5)
    return dispatcher


def copied(instructions, dispatcher):
    (overload,) = dispatcher.overloads.values()
    described = overload.fndesc
    symbols = SimpleNamespace(
        wrapper=described.llvm_cpython_wrapper_name, environment=described.env_name
    )
    return instructions.counted(overload.library, symbols, dispatcher.py_func)


def cost(copy, *arguments):
    before = copy.count()
    copy.call(*arguments)
    return copy.count() - before


@pytest.mark.parametrize("function", [rounds, more_rounds, chosen])
def test_what_counts_computes_the_same(function, instructions):
    dispatcher = compiled(function)
    copy = copied(instructions, dispatcher)
    for n in (0, 1, 2, 3, 4, 57):
        assert copy.call(n, 0.5) == dispatcher(n, 0.5)


def test_a_loop_costs_as_much_each_time_round(instructions):
    copy = copied(instructions, compiled(rounds))
    first, second, third = (cost(copy, n, 0.5) for n in (1_000, 2_000, 3_000))
    assert third - second == second - first > 5 * 1_000
    assert cost(copy, 2_000, 0.5) == second
    more = copied(instructions, compiled(more_rounds))
    assert cost(more, 2_000, 0.5) - cost(more, 1_000, 0.5) >= second - first + 2 * 1_000


CODE = """
define i64 @kernel(i64 %n, double %x) {
  br label %again

again:                                            ; preds = %again, %0
  %i = phi i64 [ 0, %0 ], [ %next, %again ]
  %a = call double @apart(double %x, i64 %i)
  %b = call double @llvm.fabs.f64(double %a)
  %next = add i64 %i, 1
  %done = icmp sge i64 %next, %n
  br i1 %done, label %"out of it", label %again

"out of it":                                      ; preds = %again
  switch i64 %n, label %more [
    i64 0, label %end
    i64 1, label %end
  ]

more:                                             ; preds = %"out of it"
  %c = call i64 @nothing()
  br label %end

end:                                              ; preds = %more, %"out of it", %"out of it"
  ret i64 %n
}

define i64 @"_ZN7cpython.kernel"(i64 %n) {
  ret i64 %n
}
"""


def test_every_block_is_counted_and_a_call_by_its_arguments(instructions):
    made = instructions.counting(CODE)
    costs = [int(cost) for cost in re.findall(r"add i64 %animat\.\S+\.old, (\d+)", made)]
    assert costs == [1, (1 + 2) + 4, 1, 2, 1]
    assert re.search(r"^again:.*\n  %i = phi .*\n  %animat", made, re.MULTILINE)
    assert "\n    i64 0, label %end\n    i64 1, label %end\n  ]\n" in made
    assert made.endswith("  ret i64 %n\n}\n@animat.instructions = global i64 0\n")


def test_only_what_is_executed_counts(instructions):
    copy = copied(instructions, compiled(chosen))
    assert 0 < cost(copy, 4, 0.5) < 15


def test_both_a_loss_and_a_gain_are_told(instructions):
    known = {"instructions": {"a life": 1_000_000}}
    for now, well in ((1_000_000, True), (1_009_999, True), (1_010_001, False), (989_999, False)):
        lines, within = instructions.compared(known, {"instructions": {"a life": now}})
        assert within == well
        assert f"{now / 1e6 - 1:+.2%}" in lines[0]
    lines, within = instructions.compared(known, {"instructions": {"another": 1_000_000}})
    assert not within


@linked(advance.arguments, (STATE, MIND, ROBOT), SLOTS, ROLES, BUILT_IN)
def slowed(states, present, lives, minds, robots, raster, seed, until, functions):
    """Advance lives as `advance` does, with a few operations more in every step, for nothing."""
    model = Model(mind_at(minds, 0), robot_at(robots, 0), functions)
    for n in range(len(lives)):
        state, scene, key = state_at(states, n), Scene(raster, present[n]), Key(seed, lives[n])
        while state.step < until and not state.dead:
            slow = state.x
            for i in range(SLOWER // 2):
                slow = slow * 0.5 + i
            if slow == 0.123:
                state.x = slow
            step(state, model, scene, key)


def test_a_slowed_build_is_found(instructions):
    setting = bring_together(animat.Mind(death=False), animat.World.abundant())
    counted = []
    for kernel in (advance, slowed):
        kernel.of(setting.counts, setting.functions)
        call, count = instructions.counted(
            *kernel.libraries[setting.counts, setting.functions], kernel.function
        )
        end = instructions.lived(call, setting)
        counted.append((end, count() / instructions.STEPS))
    (end, before), (slow_end, slow) = counted
    assert slow_end == end
    assert (1 + instructions.MARGIN) * before < slow < before + 2 * SLOWER
    known = {"instructions": {"a life": round(before * 1e4)}}
    _, well = instructions.compared(known, {"instructions": {"a life": round(slow * 1e4)}})
    assert not well

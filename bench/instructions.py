"""How many instructions a step takes, counted, not timed: the same number at every run.

    python bench/instructions.py          counts, and compares with instructions.json
    python bench/instructions.py --write  counts, and writes the file anew

Exit code 1 if a life takes more than MARGIN more, or less, than the file says: more is a slow-down,
and less is a gain that would be lost again unnoticed if it were not written down.

What is counted are the instructions of LLVM's optimised code that fixed lives execute: into every
block of it an addition is put, and the code is compiled and lived by. It is made for a `generic`
processor, whatever the machine, so the count depends on the source, on Numba and on LLVM alone.
It sees every operation, branch, access and call more; not what an instruction waits for.

Why not valgrind: to start Python and Numba under callgrind takes two minutes, twice, and what it
counts of two equal starts differs by 4 million instructions. It agrees: 1,450 instructions a step
of `nehalem` code where this says 1,361 (LEARNING, 200,000 steps less 10).
"""

from __future__ import annotations

import argparse
import ctypes
import inspect
import json
import os
import re
import sys
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

FILE = Path(__file__).with_suffix(".json")

STEPS = 20_000
MARGIN = 0.01

GENERIC = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}

COUNTER = "animat.instructions"
DEFINITION = re.compile(r"^define .*?^}", re.MULTILINE | re.DOTALL)
WRAPPER = re.compile(r'^define [^@]*@"?(?:_ZN7cpython|cfunc\.)')
LABEL = re.compile(r'^(?:[-\w.$]+|"[^"]+"):')
INSTRUCTION = re.compile(r"^  (?=[^ \];])")
CALL = re.compile(r"\bcall .*?@(?!llvm\.)[^(]*\((.*)\)")


class Counted(NamedTuple):
    """A kernel that counts: to be called like the kernel; and its count so far."""

    call: Callable[..., Any]
    count: Callable[[], int]


def counting(code: str) -> str:
    """Return a module of LLVM's code that counts what it executes, its wrappers aside."""
    texts = iter(DEFINITION.split(code))
    whole = [next(texts)]
    number = 0
    for definition, text in zip(DEFINITION.findall(code), texts, strict=True):
        lines = []
        for block in [definition] if WRAPPER.match(definition) else _blocks(definition):
            number += 1
            lines.append(block if WRAPPER.match(definition) else _counting(block, number))
        whole += ["\n".join(lines), text]
    counter = f"@{COUNTER} = global i64 0\n"
    return "".join(whole).replace("linkonce_odr ", "") + counter


def _blocks(definition: str) -> Iterator[str]:
    """Yield the basic blocks of a function, the first with its head, the last with its end."""
    block: list[str] = []
    for line in definition.splitlines():
        if LABEL.match(line) and any(INSTRUCTION.match(before) for before in block):
            yield "\n".join(block)
            block = []
        block.append(line)
    yield "\n".join(block)


def _counting(block: str, number: int) -> str:
    """Return a basic block with an addition of its instructions to the counter."""
    lines = block.splitlines()
    instructions = [n for n, line in enumerate(lines) if INSTRUCTION.match(line)]
    counted = [n for n in instructions if " = phi " not in lines[n]]
    cost = sum(1 + _arguments(lines[n]) for n in counted)
    lines[counted[0] : counted[0]] = [
        f"  %{COUNTER}.{number}.old = load i64, ptr @{COUNTER}",
        f"  %{COUNTER}.{number}.new = add i64 %{COUNTER}.{number}.old, {cost}",
        f"  store i64 %{COUNTER}.{number}.new, ptr @{COUNTER}",
    ]
    return "\n".join(lines)


def _arguments(line: str) -> int:
    """Return how many arguments an instruction hands to a function that was not inlined."""
    call = CALL.search(line)
    return call[1].count(",") + 1 if call and call[1] else 0


def counted(library: Any, symbols: Any, function: Callable[..., Any]) -> Counted:
    """Return a counting copy of a kernel: of the library that a function was compiled to.

    `symbols` are those of Python's wrapper and of the environment.
    """
    from llvmlite import binding
    from numba import _dynfunc  # pyright: ignore[reportAttributeAccessIssue]
    from numba.core.environment import Environment

    module = binding.parse_assembly(counting(str(library._get_module_for_linking())))
    module.verify()
    machine = binding.Target.from_default_triple().create_target_machine(opt=1, jit=True)
    engine = binding.create_mcjit_compiler(module, machine)
    engine.finalize_object()
    counter = ctypes.c_int64.from_address(engine.get_global_value_address(COUNTER))
    place = ctypes.c_void_p.from_address(engine.get_global_value_address(symbols.environment))
    environment = Environment(function.__globals__)
    place.value = id(environment)
    address = engine.get_function_address(symbols.wrapper)
    alive = (engine, environment)
    call = _dynfunc.make_function(
        inspect.getmodule(function), function.__name__, "", address, environment, alive
    )
    return Counted(call, lambda: counter.value)


def lived(call: Callable[..., Any], setting: Any) -> str:
    """Live a life of STEPS steps by a kernel, and return its digest."""
    import numpy as np

    from animat.life.digest import digest
    from animat.numerics.layout import raw

    lives = np.zeros(1, np.uint64)
    states, present = setting.begin(1, lives)
    call(raw(states), present, lives, *setting.constants, 1, STEPS)
    return digest(states[0], present[0])


def counts() -> dict[str, int]:
    """Return how many instructions each of some fixed lives takes.

    Each is lived by the kernel itself too, and has to come to the same end.
    """
    import animat
    from animat.life.kernels import advance
    from animat.life.scenario import bring_together

    found = {}
    for world, agent, infrared in (
        (animat.World.abundant(), "LEARNING", "michel1996"),
        (animat.World.abundant(), "BLIND", "linear"),
        (animat.World.scarce(), "ORACLE", "michel1996"),
    ):
        mind = animat.Mind(agent=agent, death=False)
        setting = bring_together(mind, world, animat.Khepera(infrared=infrared))
        end = lived(advance.of(setting.counts, setting.functions), setting)
        library, symbols = advance.libraries[setting.counts, setting.functions]
        call, count = counted(library, symbols, advance.function)
        assert lived(call, setting) == end
        found[f"{world.name}, {agent}, {infrared}"] = count()
    return found


def told() -> dict[str, Any]:
    """Return what stands in the file: counts, and by what they were compiled."""
    return {
        "steps": STEPS,
        "python": ".".join(map(str, sys.version_info[:2])),
        "numba": version("numba"),
        "llvmlite": version("llvmlite"),
        "instructions": counts(),
    }


def compared(before: dict[str, Any], now: dict[str, Any]) -> tuple[list[str], bool]:
    """Return a line for each life, and whether all are within the margin."""
    lines, well = [], True
    for name, count in now["instructions"].items():
        known = before["instructions"].get(name)
        change = count / known - 1.0 if known else float("inf")
        well = well and abs(change) <= MARGIN
        lines.append(f"{name:32} {count / STEPS:8.1f} a step  {change:+8.2%}")
    return lines, well


def main(arguments: list[str] | None = None) -> int:
    """Count, and compare or write; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="write instructions.json anew")
    options = parser.parse_args(arguments)
    os.environ |= GENERIC  # before Numba is imported
    now = told()
    before = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {"instructions": {}}
    lines, well = compared(before, now)
    print("\n".join(lines))
    if options.write:
        FILE.write_text(json.dumps(now, indent=1) + "\n", encoding="utf-8")
        return 0
    if not well:
        others = [k for k in ("python", "numba", "llvmlite") if before.get(k) != now[k]]
        if others:
            print(f"(counted before with another {' and '.join(others)})")
        print(
            f"More than {MARGIN:.0%} off bench/instructions.json. If that is meant,"
            " python bench/instructions.py --write",
            file=sys.stderr,
        )
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())

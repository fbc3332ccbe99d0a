"""What a kernel was compiled to: LLVM's intermediate code after optimisation, and what is wrong
with it.

A step must compile for a processor of any make, and for a GPU: it calls nothing but what every
processor has instructions for, reads nothing but what it is handed, raises nothing, and no
arithmetic of it may be rearranged or fused.
"""

from __future__ import annotations

import importlib
import json
import pkgutil
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from llvmlite import binding
from numba.core.caching import FunctionCache
from numba.core.dispatcher import Dispatcher

import animat
from animat.life import control
from animat.life.life import live
from animat.life.likelihoods import likelihoods
from animat.life.scenario import bring_together
from animat.mind.mind import Mind
from animat.numerics.linked import Linked
from animat.world.world import World

SCRIPT = Path(__file__)
EXAMPLES = SCRIPT.parents[2] / "docs" / "examples"

WRAPPER = re.compile(r"_ZN7cpython|cfunc\.")
"""How the names of the functions begin by which Python calls a kernel; they unpack Python objects,
and are no part of a step."""

EXACT = re.compile(
    r"llvm\.(fabs|sqrt|floor|ceil|trunc|rint|copysign|[su](min|max)|abs|fsh[lr]|ct(lz|tz|pop)|bswap"
    r"|[us](add|sub)\.sat|mem(set|cpy|move)|masked\.(load|store|gather|scatter)"
    r"|vector\.reduce\.(add|mul|and|or|xor|[su]min|[su]max)|lifetime\.\w+|assume)\."
)
"""Intrinsics that give the same bits wherever they are an instruction and wherever they are not:
whole numbers, memory, and what IEEE 754 rounds in one way only."""

LOOSE = re.compile(r"\b(?:fast|contract|reassoc|arcp|afn)\b")
"""Flags that allow another order, a fused operation or another function."""

TABLE = re.compile(r"@switch\.table\.")
"""What LLVM makes of a choice between constants: numbers, read only. The one table there may be."""

STRING = re.compile(r'c?"(?:[^"\\]|\\.)*"')
DEFINITION = re.compile(r"^define .*?^}", re.MULTILINE | re.DOTALL)
NAME = r'@(?:"([^"]+)"|([-\w.$]+))'


def codes() -> dict[str, list[str]]:
    """Return the code of every kernel of the package; of those of a step, with a user's function
    too.

    They are compiled in a process of its own: in this one they may have been, with the functions
    of other tests, which do what they like.
    """
    command = [sys.executable, "-W", "error", str(SCRIPT)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def child() -> None:
    """Print what `codes` returns."""
    world = World.random({"TS": 1, "CL": 1}, seed=3)
    setting = bring_together(Mind(), world)
    states, _ = setting.begin(1, np.arange(2, dtype=np.uint64))
    likelihoods(setting, states)
    # With functions that other tests live by, too, as they are compiled once for all.
    product = Mind(selector=f"{EXAMPLES}/product.py:product")
    deadband = Mind(drive_function=f"{EXAMPLES}/deadband.py:deadband")
    for record, own in ((None, product), ("all", deadband)):
        for mind in (Mind(), own):
            life = live(mind, world, steps=10, record=record)
            life.networks.likelihoods(dict.fromkeys(world.feature_names, 0.0))
    lives = np.arange(1, dtype=np.uint64)
    for mind in (Mind(), product):
        asked = bring_together(mind, world)
        states, present = asked.begin(1, lives)
        here = asked, 1, lives, states, present
        due = control.advance_to_choice(*here, 100)
        control.take_choice(*here, np.zeros(1, np.int64), due)
        control.command(*here, np.zeros((1, 2), np.int64), np.zeros(1, np.int64))
    found = {name: intermediate_codes(kernel) for name, kernel in kernels().items()}
    sys.stdout.write(json.dumps(found))


def kernels() -> dict[str, Any]:
    """Return every kernel of the package by module and name."""
    found = {}
    for module in pkgutil.walk_packages(animat.__path__, "animat."):
        if not module.name.endswith("__main__"):
            for value in vars(importlib.import_module(module.name)).values():
                if isinstance(value, Linked):
                    found[value.name] = value
                elif isinstance(value, Dispatcher) and isinstance(value._cache, FunctionCache):
                    found[f"{value.py_func.__module__}.{value.__name__}"] = value
    return found


def intermediate_codes(kernel: Any) -> list[str]:
    """Return LLVM's optimised code of all that a kernel has been compiled to in this process."""
    if isinstance(kernel, Linked):
        libraries = [library for library, _ in kernel.libraries.values()]
    else:
        libraries = [one.library for one in kernel.overloads.values()]
    return [str(library._get_module_for_linking()) for library in libraries]


def functions(code: str) -> Iterator[tuple[str, str]]:
    """Yield the name and the text of every function of a module but the wrappers."""
    for match in DEFINITION.finditer(code):
        name = _first_name(match[0])
        if not WRAPPER.match(name):
            yield name, match[0]


def _first_name(text: str) -> str:
    match = re.search(NAME, text)
    assert match is not None
    return match[1] or match[2]


def offences(code: str) -> list[str]:
    """Return what a module does outside its wrappers that no step may do, each once."""
    own = {name for name, _ in functions(code)}
    found: dict[str, None] = {}
    for _, text in functions(code):
        for line in text.splitlines()[1:]:
            for offence in _offences_of(line, own):
                found[offence] = None
    return list(found)


def _offences_of(line: str, own: set[str]) -> Iterator[str]:
    instruction = line.partition(" = ")[2] or line.strip()
    words = instruction.split(" ")
    if {"call", "invoke"} & set(words[:2]):
        callee = re.search(rf"{NAME}\(", line)
        if callee is None:
            yield "calls by a pointer"
        else:
            name = callee[1] or callee[2]
            if name not in own and not EXACT.match(name):
                yield f"calls {name}"
            line = line.replace(callee[0], "", 1)
    loose = LOOSE.search(" ".join(words[:8]))
    if loose:
        yield f"may be rearranged: {words[0]} {loose[0]}"
    if words[0] in ("landingpad", "resume"):
        yield "handles exceptions"
    if "inttoptr (" in line:
        yield "reads from an address"
    for match in re.finditer(NAME, line):
        if not TABLE.match(match[0]):
            yield f"reads {match[0]}"


def for_processor(code: str, triple: str, processor: str) -> str:
    """Return the assembly of a module, without its wrappers, for a processor of any make."""
    binding.initialize_all_targets()
    binding.initialize_all_asmprinters()
    target = binding.Target.from_triple(triple)
    machine = target.create_target_machine(cpu=processor, opt=2)
    module = binding.parse_assembly(alone(code))
    module.triple = triple
    module.data_layout = str(machine.target_data)
    module.verify()
    return machine.emit_assembly(module)


def alone(code: str) -> str:
    """Return a module without its wrappers, what only they use, and what it was compiled for."""
    texts = dict(functions(code))
    used = {match[1] or match[2] for text in texts.values() for match in re.finditer(NAME, text)}
    rest = [
        line
        for line in DEFINITION.sub("", code).splitlines()
        if not line.startswith("target ")
        and (not line.startswith(("@", "declare ")) or _first_name(line) in used)
    ]
    whole = "\n".join([*rest, *texts.values()]).replace("linkonce_odr ", "")
    return re.sub(r'"target-(?:cpu|features)"="[^"]*"', "", whole)


if __name__ == "__main__":
    child()

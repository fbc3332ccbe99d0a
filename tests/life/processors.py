"""The golden lives on code made for one processor after another.

    python tests/life/processors.py            on all of these that this machine can run, a table
    python tests/life/processors.py NAME ...   on those named

Each is a process of its own with a cache of its own, so that everything is compiled for it: some
20 s of one core. Exit code 1 if a hash is not that of golden.json.
"""

from __future__ import annotations

import json
import logging
import os
import platform
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

SCRIPT = Path(__file__)
GOLDEN = SCRIPT.with_name("golden.json")

X86 = platform.machine() in ("x86_64", "AMD64")

FUSED = re.compile(r"^\s*v?fn?m(?:add|sub)\w*|^\s*fn?ml[as]\w*", re.MULTILINE)
"""Fused multiply-add among the instructions of x86-64 and of 64-bit ARM."""

VECTOR_ENCODED = re.compile(r"^\s*v(?:add|mul|sub|mov)\w+", re.MULTILINE)
"""Instructions that processors before AVX do not have."""


class Processor(NamedTuple):
    """What code is made for, as Numba is told, and what it needs of the machine."""

    settings: dict[str, str]
    needs: tuple[str, ...] = ()


def _x86(name: str, features: str, *needs: str) -> Processor:
    return Processor({"NUMBA_CPU_NAME": name, "NUMBA_CPU_FEATURES": features}, needs)


PROCESSORS: dict[str, Processor] = {
    "this machine": Processor({}),
    "uncompiled": Processor({"NUMBA_DISABLE_JIT": "1"}),
    "generic": Processor({"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}),
}
"""For what code is made; the rest only where there is an x86-64 to run it."""

if X86:
    PROCESSORS |= {
        "nehalem": _x86("nehalem", "", "sse4.2"),
        "sandybridge": _x86("sandybridge", "", "avx"),
        "haswell": _x86("haswell", "", "avx2", "fma", "bmi2"),
        "haswell without fma": _x86("haswell", "-fma", "avx2", "bmi2"),
        "skylake-avx512": _x86("skylake-avx512", "", "avx512f", "avx512vl", "avx512dq", "avx512bw"),
    }


def possible() -> list[str]:
    """Return the names of the processors whose code this machine can run."""
    from llvmlite import binding

    here = binding.get_host_cpu_features()
    return [name for name, one in PROCESSORS.items() if all(here.get(need) for need in one.needs)]


def lived_on(name: str, folder: Path, uncompiled: str = "short") -> dict[str, Any]:
    """Live the golden lives in a process of its own, with the code it compiles kept in `folder`.

    Where nothing is compiled, only those that `uncompiled` names, "short" or "few" (see golden.py);
    compiled, all, or for "few" some.

    Returns what golden.py tells as "told", and as "code" what the kernel was compiled to: the
    processor's name and features, how many instructions are fused and how many AVX-encoded, and
    how many are fused in a function compiled to be so.
    """
    environment = {key: value for key, value in os.environ.items() if not key.startswith("NUMBA_")}
    environment |= {"NUMBA_CACHE_DIR": str(folder), **PROCESSORS[name].settings}
    command = [sys.executable, "-W", "error", str(SCRIPT), "--child", uncompiled]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0 or done.stderr:
        raise RuntimeError(f"{name}: {done.stderr}")
    return json.loads(done.stdout)


def child(uncompiled: str) -> None:
    """Print what is told of the lives, and the code they were lived by."""
    # The announcement that kernels are compiled would be the only word on the error output.
    logging.getLogger("animat").setLevel("ERROR")
    sys.path.insert(0, str(SCRIPT.parent))
    import golden
    from numba import config

    compiled = not config.DISABLE_JIT
    more = {"short": "all", "few": "some"}
    told = golden.told(more[uncompiled] if compiled else uncompiled)
    sys.stdout.write(json.dumps({"told": told, "code": code() if compiled else None}))


def code() -> dict[str, Any]:
    """Return what advance was compiled to in this process."""
    import numba

    from animat.life.kernels import advance
    from animat.numerics.compiled import OPTIONS

    def product_and_sum(x):
        return x * x + 1.0

    fused = numba.njit(**{**OPTIONS, "fastmath": True})(product_and_sum)
    fused(1.0)
    library, _ = next(iter(advance.libraries.values()))
    _, processor, features = library.codegen.magic_tuple()
    assembly = library.get_asm_str()
    return {
        "processor": processor,
        "features": features,
        "fused": len(FUSED.findall(assembly)),
        "vector encoded": len(VECTOR_ENCODED.findall(assembly)),
        "fused where asked": len(FUSED.findall(*fused.inspect_asm().values())),
    }


def differences(told: dict[str, Any]) -> list[str]:
    """Return the hashes told that are not those of golden.json, by part and name."""
    known = json.loads(GOLDEN.read_text(encoding="utf-8"))
    found = []
    for part, hashes in told.items():
        if part not in ("engine", "many"):
            assert hashes
            assert set(hashes) <= set(known[part])
            found += [f"{part}: {name}" for name in hashes if hashes[name] != known[part][name]]
        elif hashes != known[part]:
            found.append(part)
    return found


def main(names: list[str]) -> int:
    """Print a line for every processor; return the exit code."""
    unlike = 0
    sys.stdout.write(f"{'code made for':20} {'hashes':>7} {'equal':>6} {'AVX':>6} {'fused':>6}\n")
    for name in names or possible():
        with tempfile.TemporaryDirectory() as folder:
            said = lived_on(name, Path(folder))
        total = sum(1 if isinstance(part, str) else len(part) for part in _hashes(said["told"]))
        found = differences(said["told"])
        made = said["code"] or {"vector encoded": "-", "fused": "-"}
        sys.stdout.write(
            f"{name:20} {total:7} {total - len(found):6} {made['vector encoded']:>6}"
            f" {made['fused']:>6}\n"
        )
        for each in found[:5]:
            sys.stdout.write(f"    another: {each}\n")
        sys.stdout.flush()
        unlike += bool(found)
    return 1 if unlike else 0


def _hashes(told: dict[str, Any]) -> list[Any]:
    return [part for name, part in told.items() if name != "engine"]


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        child(sys.argv[2])
    else:
        sys.exit(main(sys.argv[1:]))

"""What starting costs: importing, asking for help, a first life cold and warm, and memory.

    python bench/startup.py [--repeat 9] [--json FILE] [--markdown]

Everything is a process of its own. Cold is a process that finds no compiled code, with
NUMBA_CACHE_DIR at an empty folder; warm is the next one with the same folder. Files are in the
memory of the system either way. Targets are held against time of the processor: a start is the work
of one core, and the clock also counts what other programs took.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

import figures
from figures import Table, Target

QUICK, FIRST_LIFE, COMPILE = 0.3, 1.5, 20.0
"""Seconds that an import or --help, a warm start and a cold one may take at most."""

LIFE = "import animat; animat.live(animat.Mind(death=False), {world}, steps={steps})"
ABUNDANT = "animat.World.abundant()"
COUNT = """
from numba.core import event
import animat
with event.install_recorder("numba:compile") as seen:
    animat.live(animat.Mind(), animat.World.abundant(), steps=1)
print(sum(compiling.is_start for _, compiling in seen.buffer))
"""


class Spent(NamedTuple):
    """What a process took and said: seconds by the clock and of the processor, and MB at most."""

    clock: float
    processor: float
    memory: float
    said: str


def process(*arguments: str, **environment: str) -> Spent:
    """Run Python with these arguments, and return what it took. Raises SystemExit if it fails."""
    command = [sys.executable, *arguments]
    with tempfile.TemporaryFile() as said:
        start = time.perf_counter()
        child = subprocess.Popen(
            command, stdout=said, stderr=subprocess.STDOUT, env={**os.environ, **environment}
        )
        _, status, used = os.wait4(child.pid, 0)
        clock = time.perf_counter() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        text = said.read().decode()
    if child.returncode:
        raise SystemExit(f"{' '.join(command)} failed:\n{text}")
    unit = 1 if sys.platform == "darwin" else 1024  # bytes, or KB
    return Spent(clock, used.ru_utime + used.ru_stime, used.ru_maxrss * unit / 2**20, text)


def starts(repeat: int) -> Table:
    """Measure importing the package and asking for help, beside Python itself."""
    measures = {
        "python -c pass": partial(process, "-c", "pass"),
        "python -c 'import animat'": partial(process, "-c", "import animat"),
        "animat --help": partial(process, "-m", "animat", "--help"),
    }
    for measure in measures.values():
        measure()  # writes bytecode
    taken = figures.in_turns(measures, repeat)
    rows = []
    for name, runs in taken.items():
        spent = median(run.processor for run in runs)
        rows.append(
            {
                "process": name,
                "clock, s": median(run.clock for run in runs),
                "processor, s": spent,
                "target": None if name.endswith("pass") else Target(spent, QUICK, at_least=False),
            }
        )
    return Table("Importing and help", rows, f"Medians of {repeat} processes each, in turns.")


def first_lives(repeat: int) -> Table:
    """Measure `animat life --steps 1` cold and warm."""
    command = ("-m", "animat", "life", "--steps", "1")
    cold, warm, compiled = [], [], []
    for _ in range(repeat):
        with tempfile.TemporaryDirectory() as cache:
            cold.append(process(*command, NUMBA_CACHE_DIR=cache))
            kept = files(cache)
            warm.append(process(*command, NUMBA_CACHE_DIR=cache))
            compiled.append(int(process("-c", COUNT, NUMBA_CACHE_DIR=cache).said))
            if files(cache) != kept:
                raise SystemExit("a warm start wrote compiled code")
    rows = [
        begun("cold", cold, COMPILE, None),
        begun("warm", warm, FIRST_LIFE, max(compiled)),
    ]
    compiling = {name: rows[0][name] - rows[1][name] for name in ("clock, s", "processor, s")}
    rows.append({**dict.fromkeys(rows[0]), "start": "compiling: the difference", **compiling})
    return Table(
        "A first life: animat life --steps 1",
        rows,
        f"Medians of {repeat} whole processes, from the command to its last line.",
    )


def begun(start: str, runs: list[Spent], limit: float, compiled: int | None) -> dict[str, Any]:
    """Return a row of first lives."""
    waited = median(run.clock for run in runs)
    return {
        "start": start,
        "clock, s": waited,
        "processor, s": median(run.processor for run in runs),
        "target, s": Target(waited, limit, at_least=False),
        "says that it compiles": all("ompil" in run.said for run in runs),
        "functions compiled": compiled,
        "target, functions": None if compiled is None else Target(compiled, 0, at_least=False),
    }


def files(folder: str) -> set[tuple[str, int]]:
    """Return the files below a folder, with when they were written."""
    return {(str(file), file.stat().st_mtime_ns) for file in Path(folder).rglob("*.nb?")}


def memory(steps: int, lives: int) -> Table:
    """Measure the most memory that whole processes have had."""
    large = (
        "animat.World.random(dict.fromkeys(('TS', 'TL', 'CS', 'CL'), 32), seed=1,"
        " arena=animat.Arena(width=4000.0, height=4000.0))"
    )
    many = (
        "import animat; animat.live_many(animat.Mind(death=False), animat.World.abundant(),"
        f" lives={lives}, steps=100)"
    )
    programs = {
        "python -c pass": "pass",
        "import animat": "import animat",
        "a life of 1 step": LIFE.format(world=ABUNDANT, steps=1),
        f"a life of {steps:,} steps": LIFE.format(world=ABUNDANT, steps=steps),
        "a life of 1 step, 4 m x 4 m, 128 objects": LIFE.format(world=large, steps=1),
        f"{lives:,} lives of 100 steps": many,
    }
    rows = [
        {"process": name, "most memory, MB": process("-c", code).memory}
        for name, code in programs.items()
    ]
    return Table(
        "Memory",
        rows,
        "The most that each process had at any time, code on disk; at least what the measuring "
        "program had when it began it.",
    )


def tables(repeat: int, tiny: bool) -> Iterator[Callable[[], Table]]:
    """Yield what makes each table; the cold start is left out of a tiny run."""
    yield partial(starts, repeat)
    if not tiny:
        yield partial(first_lives, max(1, repeat // 4))
    yield partial(memory, 1_000 if tiny else 5_000_000, 100 if tiny else 10_000)


if __name__ == "__main__":
    figures.run(__doc__, tables, repeat=9)

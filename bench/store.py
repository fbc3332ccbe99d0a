"""What the store costs beside the lives in it, and how much memory a study of many lives needs.

    python bench/store.py cost [--lives 1000000] [--steps 100] [--repeat 3] [--threads 2]
    python bench/store.py memory [--lives 10000 100000 1000000] [--steps 10] [--threads 2]

`cost` lives the same lives as `animat run` does and with the bare engine (`live_chunks`), in turn,
in one process, and compares the least processor time and the least time of each; the bare engine
takes lives in chunks of its own size, and in chunks as large as the parts of the store. `memory`
lives studies of more and more lives, each in a process of its own, and reports the largest memory.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from animat.files.provenance import provenance
from animat.life import lives as engine
from animat.life.lives import live_chunks
from animat.life.scenario import bring_together
from animat.study.execute.run import run, threads
from animat.study.file.settings import LifeSettings
from animat.study.file.study import Study
from animat.study.plan.numbering import LARGEST
from animat.study.plan.plan import plan_of

SEED = 1


def study_of(lives: int, steps: int) -> Study:
    """Return a study of one case, the agent BLIND in World 1."""
    return Study(name="bench", seed=SEED, lives=lives, steps=steps)


def through_the_store(lives: int, steps: int, count: int) -> None:
    """Live a study into a directory that is then thrown away."""
    with tempfile.TemporaryDirectory() as folder, threads(count) as workers:
        plan = plan_of(study_of(lives, steps).to_toml())
        outcome = run(plan, Path(folder) / "results", workers, lambda *_, **__: None)
        assert outcome.complete


def bare(lives: int, steps: int, count: int) -> None:
    """Live the same lives and throw their summaries away."""
    settings = LifeSettings()
    setting = bring_together(settings.mind, settings.world.world(), settings.robot)
    lived = 0
    for chunk in live_chunks(setting, SEED, 0, lives, steps, threads=count):
        lived += len(chunk["life"])
    assert lived == lives


def bare_in_parts(lives: int, steps: int, count: int) -> None:
    """Live them in chunks as large as the parts of a study can be."""
    own = engine.CHUNK
    engine.CHUNK = LARGEST
    try:
        bare(lives, steps, count)
    finally:
        engine.CHUNK = own


def seconds(work: Callable[[], None]) -> tuple[float, float]:
    """Return processor time and time of some work."""
    cpu, wall = time.process_time(), time.perf_counter()
    work()
    return time.process_time() - cpu, time.perf_counter() - wall


def cost(lives: int, steps: int, repeat: int, count: int) -> dict[str, float]:
    """Compare the store with the bare engine."""
    ways = {"store": through_the_store, "bare": bare, "bare in parts": bare_in_parts}
    best = {f"{way}, {what}": float("inf") for way in ways for what in ("cpu s", "s")}
    for way in ways.values():
        way(100, steps, count)
    for _ in range(repeat):
        for name, way in ways.items():
            for what, measured in zip(
                ("cpu s", "s"), seconds(lambda way=way: way(lives, steps, count)), strict=True
            ):
                best[f"{name}, {what}"] = min(best[f"{name}, {what}"], measured)
    for other in ("bare", "bare in parts"):
        for what in ("cpu s", "s"):
            best[f"store / {other}, {what}"] = best[f"store, {what}"] / best[f"{other}, {what}"]
    return {name: round(value, 3) for name, value in best.items()}


def memory(lives: int, steps: int, count: int) -> dict[str, float]:
    """Return the largest memory of a process that lives a study, and how long it took."""
    command = [sys.executable, __file__, "one", "--lives", str(lives), "--steps", str(steps)]
    done = subprocess.run(
        [*command, "--threads", str(count)], check=True, capture_output=True, text=True
    )
    return json.loads(done.stdout)


def one(lives: int, steps: int, count: int) -> dict[str, float]:
    """Live a study in this process."""
    cpu, wall = seconds(lambda: through_the_store(lives, steps, count))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {
        "lives": lives,
        "largest memory, MB": round(peak),
        "s": round(wall, 1),
        "cpu s": round(cpu, 1),
    }


def main() -> None:
    """Measure what is asked for and print it as JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("cost", "memory", "one"))
    parser.add_argument("--lives", type=int, nargs="+")
    parser.add_argument("--steps", type=int)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    if options.what == "one":
        print(json.dumps(one(options.lives[0], options.steps, options.threads)))
        return
    found: object
    if options.what == "cost":
        lives = (options.lives or [1_000_000])[0]
        found = cost(lives, options.steps or 100, options.repeat, options.threads)
    else:
        counts = options.lives or [10_000, 100_000, 1_000_000]
        found = [memory(lives, options.steps or 10, options.threads) for lives in counts]
    print(json.dumps({"made": provenance(), options.what: found}, indent=2))


if __name__ == "__main__":
    sys.exit(main())

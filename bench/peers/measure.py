"""Measure one simulator in its own Python, and print what it does as a line of JSON.

    python bench/peers/measure.py with_numpy:start --obstacles 0 10 --robots 1 100

An adapter's function `start(obstacles, robots, seed)` returns an object with two methods: `step(n)`
moves every robot n steps on, `turning()` returns the share of robots that are turning away now. On
one core, in time of the processor.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import time
from collections.abc import Callable
from importlib.metadata import version
from typing import Any

import work

SEED = 1


def steps_per_second(robots: Any, number: int, seconds: float) -> float:
    """Return the robot-steps per second of the processor, over at least so many seconds."""
    steps = 1
    while True:
        start = time.process_time()
        robots.step(steps)
        spent = time.process_time() - start
        if spent >= seconds:
            return number * steps / spent
        steps = int(steps * min(10.0, 1.2 * seconds / max(spent, seconds / 100.0))) + 1


def share_turning(robots: Any, number: int, samples: int) -> float:
    """Return how large a share of the robot-steps is spent turning away."""
    times = max(1, samples // number)
    total = 0.0
    for _ in range(times):
        robots.step(1)
        total += robots.turning()
    return total / times


def figures(start: Callable[..., Any], options: argparse.Namespace) -> list[dict[str, Any]]:
    """Return what is measured, for every number of obstacles and of robots."""
    rows = []
    for count in options.obstacles:
        for number in options.robots:
            robots = start(work.obstacles(count), number, SEED)
            robots.step(1)  # compiles, where there is something to compile
            speed = steps_per_second(robots, number, options.seconds)
            most = number == max(options.robots)
            turning = share_turning(robots, number, options.samples) if most else None
            rows.append(
                {
                    "obstacles": count,
                    "robots": number,
                    "steps per second": speed,
                    "turning away": turning,
                }
            )
    return rows


def main() -> None:
    """Start, step once, measure, print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("adapter", help="module:function")
    parser.add_argument("--obstacles", type=int, nargs="+", default=[0, 10, 20, 30])
    parser.add_argument("--robots", type=int, nargs="+", default=[1])
    parser.add_argument("--seconds", type=float, default=0.5)
    parser.add_argument("--samples", type=int, default=1000)
    parser.add_argument("--packages", nargs="*", default=[], help="whose versions are told")
    options = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    module, _, function = options.adapter.partition(":")
    start = getattr(importlib.import_module(module), function)
    start(work.obstacles(10), 1, SEED).step(1)
    said: dict[str, Any] = {"start-up, seconds": time.process_time()}
    said["versions"] = {name: version(name) for name in options.packages}
    said["figures"] = figures(start, options)
    print(json.dumps(said))


if __name__ == "__main__":
    main()

"""How many robot-steps a second animat and other simulators make, of the same work.

    python bench/peers/run.py --venv DIR [--json FILE] [--markdown]

The work is that of `work.py`: a Khepera wanders among round obstacles in a walled square metre, one
robot to a world. Each simulator is measured in a process of its own, on one core, in time of the
processor; in turns, forwards and backwards, and the best of them is shown. Every simulator gets a
virtual environment under DIR, made on the first run from `requirements.txt`; one that cannot be
installed is told of and left out. NumPy, Numba and animat run in the Python of this program.
"""

from __future__ import annotations

import argparse
import json
import sys
from functools import partial
from pathlib import Path
from typing import Any

from simulators import HERE, PEERS, Peer, PeerError, output, python_of

sys.path.append(str(HERE.parent))

import figures
from figures import Table

OBSTACLES = (0, 10, 20, 30)
MIDDLE = 20
"""The number of obstacles by which the best number of robots at once is chosen."""

OURS = ("animat, rays", "animat, michel1996")
"""What peers are compared with: one ray to a sensor, as they have it, and the sensors of a Khepera
as animat has them where nothing else is said."""


def measure(peer: Peer, python: str, options: argparse.Namespace) -> dict[str, Any]:
    """Measure a simulator once. Raises PeerError."""
    robots = [number for number in peer.robots if number <= options.most_robots]
    command = [python, str(HERE / "measure.py"), peer.adapter]
    command += ["--obstacles", *map(str, options.obstacles)]
    command += ["--robots", *map(str, robots)]
    command += ["--seconds", str(options.seconds), "--samples", str(options.samples)]
    command += ["--packages", *peer.packages]
    return json.loads(output(command).splitlines()[-1])


def measured(
    options: argparse.Namespace,
) -> tuple[dict[str, list[dict[str, Any]]], dict[str, str]]:
    """Return what every turn found of every simulator, and what went wrong with the others."""
    pythons, wrong = {}, {}
    chosen = [peer for peer in PEERS if not options.only or peer.name in options.only]
    for peer in chosen:
        try:
            pythons[peer.name] = python_of(peer, options.venv)
        except PeerError as failure:
            wrong[peer.name] = f"does not install: {failure}"

    def once(peer: Peer) -> dict[str, Any] | None:
        if peer.name in wrong:
            return None
        print(f"measuring {peer.name}", file=sys.stderr, flush=True)
        try:
            return measure(peer, pythons[peer.name], options)
        except PeerError as failure:
            wrong[peer.name] = f"does not run: {failure}"
            return None

    turns = figures.in_turns({peer.name: partial(once, peer) for peer in chosen}, options.repeat)
    found = {
        name: [turn for turn in taken if turn is not None]
        for name, taken in turns.items()
        if name not in wrong
    }
    return found, wrong


def best(turns: list[dict[str, Any]], obstacles: int, robots: int) -> float:
    """Return the most steps per second of all turns."""
    return max(
        figure["steps per second"]
        for turn in turns
        for figure in turn["figures"]
        if (figure["obstacles"], figure["robots"]) == (obstacles, robots)
    )


def best_number(turns: list[dict[str, Any]], obstacles: int) -> int:
    """Return how many robots at once make the most steps, together."""
    numbers = {figure["robots"] for figure in turns[0]["figures"]}
    return max(sorted(numbers), key=lambda number: best(turns, obstacles, number))


def speeds(found: dict[str, list[dict[str, Any]]], options: argparse.Namespace) -> Table:
    """Return steps per second, one robot at a time and as many as are best."""
    middle = MIDDLE if MIDDLE in options.obstacles else options.obstacles[-1]
    rows = []
    for name, turns in found.items():
        for number in sorted({1, best_number(turns, middle)}):
            rows.append(
                {
                    "simulator": name,
                    "start-up, s": min(turn["start-up, seconds"] for turn in turns),
                    "robots at once": number,
                }
                | {f"{count} obstacles": best(turns, count, number) for count in options.obstacles}
                | {f"turning away, {middle} obstacles": turning(turns, middle)}
            )
    return Table(
        "Robot-steps a second, on one core",
        rows,
        "Of the processor, together where there are many robots, the best of "
        f"{options.repeat} turns; one robot, and the number of those tried that is best among "
        f"{middle} obstacles. Start-up is a process up to its first step, compiled code on disk "
        "where it is kept. Turning away is the share of steps that is spent so: it shows whether "
        "all do the same.",
    )


def turning(turns: list[dict[str, Any]], obstacles: int) -> float:
    """Return the mean share of steps spent turning away, of the most robots that were measured."""
    shares = [
        figure["turning away"]
        for turn in turns
        for figure in turn["figures"]
        if figure["obstacles"] == obstacles and figure["turning away"] is not None
    ]
    return sum(shares) / len(shares)


def ratios(
    name_of_ours: str, found: dict[str, list[dict[str, Any]]], options: argparse.Namespace
) -> Table:
    """Return how many times as many steps animat makes as each peer."""
    ours = found[name_of_ours]
    rows = []
    for name, turns in found.items():
        if name.startswith("animat"):
            continue
        row: dict[str, Any] = {"simulator": name}
        for count in options.obstacles:
            most = [best(of, count, best_number(of, count)) for of in (ours, turns)]
            row[f"{count} obstacles, one robot"] = best(ours, count, 1) / best(turns, count, 1)
            row[f"{count} obstacles, best number"] = most[0] / most[1]
        rows.append(row)
    return Table(
        f"How many times as many steps {name_of_ours}, makes",
        rows,
        "The best number of robots at once is that of each simulator, for that many obstacles.",
    )


def left_out(found: dict[str, list[dict[str, Any]]], wrong: dict[str, str]) -> Table:
    """Return what each leaves out of the work, with its versions."""
    rows = []
    for peer in PEERS:
        if peer.name in found:
            versions = found[peer.name][0]["versions"]
            told = ", ".join(f"{name} {version}" for name, version in versions.items())
            rows.append({"simulator": peer.name, "of": told, "leaves out": peer.leaves_out})
        elif peer.name in wrong:
            rows.append({"simulator": peer.name, "of": wrong[peer.name], "leaves out": "all"})
    return Table("What each leaves out", rows)


def main() -> None:
    """Install, measure, print, and write JSON where asked."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--venv", type=Path, required=True, help="where peers are installed")
    parser.add_argument("--only", nargs="+", choices=[peer.name for peer in PEERS])
    parser.add_argument("--obstacles", type=int, nargs="+", default=list(OBSTACLES))
    parser.add_argument("--repeat", type=figures.times, default=3, help="how often all is measured")
    figures.add_output(parser)
    options = parser.parse_args()
    options.seconds, options.samples = (0.01, 10) if options.tiny else (0.5, 2000)
    options.most_robots = 100 if options.tiny else 10_000
    options.venv = options.venv.resolve()
    made = figures.opened(options.markdown)
    found, wrong = measured(options)
    if found:
        figures.tell(speeds(found, options), made, options.markdown)
    for name in OURS:
        if name in found and any(not other.startswith("animat") for other in found):
            figures.tell(ratios(name, found, options), made, options.markdown)
    figures.tell(left_out(found, wrong), made, options.markdown)
    made["turns"], made["failures"] = found, wrong
    figures.closed(made, options.json)
    if not found:
        raise SystemExit("no simulator could be measured")


if __name__ == "__main__":
    main()

"""How a study stands: what is finished, who is at it, how fast, how long still."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from animat.files.lock import holder
from animat.study.store.eta import Pace
from animat.study.store.log import entries
from animat.study.store.results import Results
from animat.study.store.store import LOCK, LOG


def status(results: Results) -> list[str]:
    """Return in a few lines how a study stands, whether or not it is being run."""
    tally = results.tally()
    lives, robots = tally.counts["lives"], tally.counts["teachers"]
    total = tally.numbering["lives"].total
    lines = [
        f"{results.manifest['study']}: {lives.rows:,} of {total:,} lives,"
        f" {tally.finished_cases:,} of {results.cases.num_rows:,} cases"
    ]
    if all_robots := tally.numbering["teachers"].total:
        lines.append(f"{robots.rows:,} of {all_robots:,} robots that teach have learnt")
    if lives.failed:
        lines.append(f"{lives.failed:,} lives failed")
    if robots.failed:
        lines.append(f"{robots.failed:,} robots failed to learn")
    lines += results.unusable()
    return [*lines, _who(results, Pace(tally, results.steps_to_learn, *_speed(results.directory)))]


def _who(results: Results, pace: Pace) -> str:
    who, held = holder(results.directory / LOCK)
    if held:
        return f"run by {who or 'another process'}; {pace}"
    if pace.tally.complete:
        return "finished"
    return "not run by anybody" + (f"; {who} ended without a word" if who else "")


def _speed(directory: Path) -> tuple[int, float]:
    """Return the steps lived since the first part of the last run, and the seconds it took."""
    try:
        parts = _parts_of_last_run(entries(directory / LOG))
        return sum(p["steps"] for p in parts[1:]), parts[-1]["seconds"] - parts[0]["seconds"]
    except (OSError, IndexError, KeyError, TypeError):
        # Nothing is taken down yet, or somebody else has written into the log.
        return 0, 0.0


def _parts_of_last_run(events: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    parts: list[dict[str, Any]] = []
    for event in events:
        if event["event"] == "start":
            parts = []
        elif event["event"] == "part":
            parts.append(event)
    return parts

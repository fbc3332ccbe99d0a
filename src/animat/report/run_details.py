"""How a study was run: how far it is, with what, on what, and which lives failed."""

from __future__ import annotations

import json
from typing import Any

import pyarrow as pa

from animat.report.page import Section, TableBlock
from animat.study.store.results import Progress, Results

ERRORS_SHOWN = 20


def how_run_section(results: Results, progress: Progress, failed: pa.Table) -> Section:
    """Return how it was run; `failed` are the lives that have an `error`.

    `progress` is how far it was when the lives were read; more may be finished by now.
    """
    manifest = results.manifest
    done, total = progress
    tables = [_failures(failed)] if failed.num_rows else []
    return Section(
        "How it was run",
        terms={
            "Lives": f"{done:,} of {total:,} finished{_shared(results)}",
            "Failed": f"{failed.num_rows:,}",
            "Study": f"{manifest['study']}, SHA-256 {manifest['hash']}",
            "Engine": str(manifest["engine"]),
            **_runs(manifest["runs"]),
        },
        tables=tables,
        notices=notices(progress, failed),
    )


def notices(progress: Progress, failed: pa.Table) -> list[str]:
    """Return what nobody should miss: a study that still runs, lives that failed."""
    done, total = progress
    told = []
    if done < total:
        told.append(
            f"Not finished: {total - done:,} of {total:,} lives are still to be simulated. All"
            " numbers are of the lives that are there, some of every case where there are many."
        )
    if failed.num_rows:
        told.append(
            f"{failed.num_rows:,} lives failed. They are left out of all numbers; their errors"
            " stand under How it was run."
        )
    return told


def _shared(results: Results) -> str:
    """Return how many cases have the lives of another case, settings that matter being equal."""
    same = results.cases["same_as"].to_numpy()
    shared = int((same != results.cases["case"].to_numpy()).sum())
    if not shared:
        return ""
    return (
        f"; {shared:,} of {len(same):,} cases differ from another in nothing that matters to a"
        " life, and have its lives"
    )


def _runs(runs: list[dict[str, Any]]) -> dict[str, str]:
    """Return commands, versions and machines, each once with the times of the runs that had it."""
    told: dict[str, str] = {}
    for name, heading in (("command", "Command"), ("versions", "Versions"), ("machine", "Machine")):
        times: dict[str, list[str]] = {}
        for run in runs:
            times.setdefault(_said(run[name]), []).append(run["made"])
        told[heading] = "; ".join(
            what if len(times) == 1 else f"{what} ({', '.join(made)})"
            for what, made in times.items()
        )
    told["Begun"] = runs[0]["made"]
    if len(runs) > 1:
        told["Resumed"] = ", ".join(run["made"] for run in runs[1:])
    return told


def _said(value: Any) -> str:
    if not isinstance(value, dict):
        return str(value)
    return ", ".join(
        f"{k} {v if isinstance(v, str | int) else json.dumps(v)}" for k, v in value.items()
    )


def _failures(failed: pa.Table) -> TableBlock:
    """Return the errors, the most frequent first, with the first life of each."""
    counted = (
        failed.append_column("row", pa.array(range(failed.num_rows)))
        .group_by("error")
        .aggregate([("row", "count"), ("row", "min")])
        .sort_by([("row_count", "descending"), ("row_min", "ascending")])
        .to_pylist()
    )
    rows = [
        (
            each["error"],
            f"{each['row_count']:,}",
            f"case {failed['case'][each['row_min']]}, life {failed['life'][each['row_min']]}",
        )
        for each in counted[:ERRORS_SHOWN]
    ]
    left = len(counted) - len(rows)
    return TableBlock(
        ("Error", "Lives", "First"),
        rows,
        f"and {left:,} other errors" if left else "",
        title="Lives that failed",
    )

"""`animat verify`."""

from __future__ import annotations

import sys

from animat.cli.app import DONE, FAILED, app
from animat.cli.options import Debug, ResultsDirectory


@app.command()
def verify(directory: ResultsDirectory, debug: Debug = False) -> int:
    """Read all results of a study, simulate some of its lives again, and report differences."""
    from animat.progress import telling
    from animat.study.execute.verify import verify as look
    from animat.study.store.results import open as open_results

    results = open_results(directory)
    with telling() as tell:
        found = look(results, tell)
    for problem in found.problems:
        print(f"animat: {problem}", file=sys.stderr)
    if found.problems:
        return FAILED
    print(
        f"{found.parts:,} of {found.all_parts:,} parts are there and unchanged;"
        f" {found.lives:,} lives simulated again are the same"
    )
    return DONE

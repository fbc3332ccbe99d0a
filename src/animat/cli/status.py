"""`animat status`."""

from __future__ import annotations

from animat.cli.app import app
from animat.cli.options import Debug, ResultsDirectory


@app.command()
def status(directory: ResultsDirectory, debug: Debug = False) -> None:
    """Say how far a study is, whether it is being run, and how long that will take."""
    from animat.study.store.results import open as open_results
    from animat.study.store.status import status as how_it_stands

    for line in how_it_stands(open_results(directory)):
        print(line)

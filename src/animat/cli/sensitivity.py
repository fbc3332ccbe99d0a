"""`animat sensitivity`."""

from __future__ import annotations

import sys
from pathlib import Path

from animat.cli.app import DONE, INTERRUPTED, app
from animat.cli.options import Debug, Out, Quick, Set, StudyFile, Threads

QUICK = ("lives=4", "steps=5_000", "teacher.steps=20_000", "design.sample.points=4")


@app.command()
def sensitivity(
    study: StudyFile = "sensitivity",
    out: Out = None,
    changes: Set = None,
    threads: Threads = None,
    quick: Quick = False,
    debug: Debug = False,
) -> int:
    """Say which continuous parameters lifespans depend on: Sobol's indices."""
    from animat.experiments.sensitivity import check
    from animat.experiments.sensitivity import sensitivity as indices_of
    from animat.files.provenance import provenance
    from animat.progress import telling
    from animat.report.sensitivity_page import publish, short
    from animat.study.execute.run import run
    from animat.study.execute.run import threads as workers_of
    from animat.study.file.builtin import study_file
    from animat.study.file.read import read_study
    from animat.study.plan.plan import Plan
    from animat.study.store.results import open as open_results

    asked = read_study(study_file(study), [*(QUICK if quick else ()), *(changes or ())])
    check(asked)
    directory = out or Path("results") / asked.name
    with telling() as tell, workers_of(threads) as workers:
        outcome = run(Plan(asked), directory, workers, tell)
    if not outcome.complete:
        print(f"animat: the same command resumes {directory}", file=sys.stderr)
        return INTERRUPTED
    found = indices_of(open_results(directory))
    publish(found, directory, str(provenance()["command"]))
    for line in short(found):
        print(line)
    print(f"open {directory / 'sensitivity.html'}")
    return DONE

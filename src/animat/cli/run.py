"""`animat run`."""

from __future__ import annotations

import sys
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from animat.cli.app import DONE, FAILED, INTERRUPTED, app
from animat.cli.options import CheckFunctions, Debug, Out, Set, StudyFile, Threads

if TYPE_CHECKING:
    from animat.study.execute.run import Outcome, Workers
    from animat.study.plan.plan import Plan

SHOWN = 3
"""Lives that failed of which the error is shown."""


@app.command()
def run(
    study: StudyFile,
    out: Out = None,
    changes: Set = None,
    threads: Threads = None,
    cluster: Annotated[
        str | None,
        typer.Option(
            metavar="WHERE",
            help="Run on a cluster: tcp://HOST:PORT of a Dask scheduler, or slurm, pbs, ...",
        ),
    ] = None,
    jobs: Annotated[
        int | None,
        typer.Option(help="Jobs a batch system is asked for; one unless given.", min=1),
    ] = None,
    check_functions: CheckFunctions = False,
    debug: Debug = False,
) -> int:
    """Run a study, or resume one: simulate the lives that its results directory lacks."""
    from animat.files.settings import SettingsError
    from animat.progress import telling
    from animat.study.execute.run import run as live
    from animat.study.file.builtin import study_file
    from animat.study.file.read import read_study
    from animat.study.plan.plan import plan_of
    from animat.study.plan.preflight import check_livable
    from animat.study.store.manifest import MANIFEST

    if check_functions and cluster is not None:
        raise SettingsError("--check-functions: is for this machine; leave out --cluster")
    plan = plan_of(read_study(study_file(study), changes or ()).to_toml(), check_functions)
    directory = out or Path("results") / plan.study.name
    _say_what(plan, directory)
    with telling() as tell, _workers(plan, threads, cluster, jobs) as workers:
        if not (directory / MANIFEST).exists():
            check_livable(plan)
        outcome = live(plan, directory, workers, tell)
    return _say_how_it_ended(outcome, directory)


def _workers(
    plan: Plan, count: int | None, where: str | None, jobs: int | None
) -> AbstractContextManager[Workers]:
    from animat.files.settings import SettingsError
    from animat.study.cluster.cluster import cluster
    from animat.study.execute.run import threads

    if where is None:
        if jobs is not None:
            raise SettingsError("--jobs: belongs to --cluster with a batch system")
        return threads(count)
    if count is not None:
        raise SettingsError("--threads: is for this machine; workers of a cluster have their own")
    return cluster(where, plan, lambda line: print(f"animat: {line}", file=sys.stderr), jobs)


def _say_what(plan: Plan, directory: Path) -> None:
    from animat.study.file.cases import excluded

    cases, lives = len(plan.cases), plan.numbering["lives"].total
    print(f"{plan.study.name}: {cases:,} cases, {lives:,} lives; results in {directory}")
    for rule in excluded(plan.study):
        print(f"left out: {rule.count:,} combinations: {rule.why}")
    sys.stdout.flush()


def _say_how_it_ended(outcome: Outcome, directory: Path) -> int:
    from animat.study.store.results import open as open_results

    lives = outcome.tally.counts["lives"]
    total = outcome.tally.numbering["lives"].total
    if not outcome.complete:
        print(
            f"animat: {lives.rows:,} of {total:,} lives are in {directory}; the same command"
            " resumes the run",
            file=sys.stderr,
        )
        return INTERRUPTED
    print(f"{total:,} lives are in {directory}; {outcome.seconds:.0f} s")
    if not lives.failed:
        return DONE
    print(f"animat: {lives.failed:,} of {total:,} lives failed", file=sys.stderr)
    for told in open_results(directory).failures(SHOWN):
        print(f"animat: {told}", file=sys.stderr)
    return FAILED

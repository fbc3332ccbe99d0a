"""A multiverse simulated and analysed; a finished part is not simulated again.

Directories of studies stand in the directory of the multiverse: `universes` (or the portions of the
full product), `longer` (some universes with a late cap), `confirmation` (fresh universes for each
smallest set). Each is the results directory of a study like any other.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pyarrow as pa

from animat.errors import Error
from animat.experiments.judging import Judged, judge
from animat.experiments.multiverse_designs import fresh, longer, portions
from animat.experiments.universes import Reading, Universes, readings_of
from animat.files.settings import SettingsError
from animat.progress import Telling
from animat.statistics.claims import CLAIMS
from animat.statistics.interactions import strongest_interactions
from animat.statistics.marginal_effects import marginal_effects
from animat.statistics.predict import Prediction, available, predict
from animat.statistics.readings import codes, fewest_together
from animat.statistics.sufficient_sets import Confirmation, SufficientSet, confirm, sufficient_set
from animat.statistics.time_limit import time_limit_effects
from animat.statistics.universes import verdict_shares
from animat.study.execute.run import Workers, run
from animat.study.file.cases import Excluded, excluded
from animat.study.file.study import Study
from animat.study.plan.plan import Plan
from animat.study.store.manifest import MANIFEST
from animat.study.store.results import open as open_results

LATE = 300_000
"""The cap of the paper's Experiment 1, taken here for the lives that show what a cap does."""


class Size(NamedTuple):
    """How much is run besides the universes themselves.

    `confirming` fresh universes for each set of readings, and `longer` universes up to `late`
    steps; none of them if it is 0.
    """

    confirming: int = 200
    longer: int = 60
    late: int = LATE


class InterruptedStudyError(Error):
    """A run was ended before all lives were finished; the same command resumes it."""


class Multiverse(NamedTuple):
    """What was found in the universes of a study.

    `left_out` is how many cases each rule leaves out. `found` has a set for each claim, or None;
    `confirmed` what fresh universes say of those found, where not all of them failed. `time_limit`
    is None where nothing was simulated up to a late cap, `predicted` where scikit-learn is not
    installed.
    """

    study: Study
    universes: Universes
    table: pa.Table
    deaths: pa.Table
    missing: int
    left_out: list[Excluded]
    fewest_together: int
    shares: pa.Table
    marginal: pa.Table
    interactions: pa.Table
    predicted: list[Prediction] | None
    found: dict[str, SufficientSet | None]
    confirmed: dict[str, Confirmation]
    time_limit: pa.Table | None


def run_multiverse(
    study: Study, out: Path, size: Size, workers: Workers, tell: Telling, *, full: bool
) -> Multiverse:
    """Simulate and analyse a multiverse, `full` in every combination of its readings.

    Raises:
        InterruptedStudyError: it was asked to end.
        SettingsError: a study that is no multiverse, or a directory that holds something else.
    """
    if study.design.sample is None:
        raise SettingsError(f"{study.name}: a multiverse needs a [design.sample]")
    readings = readings_of(study)
    parts = [
        _lived(Plan(one), readings, out / name, name, workers, tell)
        for name, one in _studies(study, full)
    ]
    judged = _together(parts)
    if not judged.table.num_rows:
        raise SettingsError(f"{out}: in every universe some lives failed; nothing can be judged")
    names = judged.universes.names()
    tell("Analysis", 0, len(CLAIMS) + 4)
    found = {}
    for claim in CLAIMS:
        found[claim] = sufficient_set(judged.table, names, claim)
        tell("Analysis", 1, len(CLAIMS) + 4)
    shares = verdict_shares(judged.table)
    marginal = marginal_effects(judged.table, names)
    tell("Analysis", 1, len(CLAIMS) + 4)
    interactions = strongest_interactions(judged.table, names)
    tell("Analysis", 1, len(CLAIMS) + 4)
    predicted = predict(judged.table, names) if available() else None
    tell("Analysis", 2, len(CLAIMS) + 4)
    return Multiverse(
        study,
        judged.universes,
        judged.table,
        judged.deaths,
        judged.missing,
        [] if full else excluded(study),
        fewest_together(codes(judged.table, names)),
        shares,
        marginal,
        interactions,
        predicted,
        found,
        _confirmed(study, found, out, size, workers, tell),
        None if full else _late(study, judged, out, size, workers, tell),
    )


def _studies(study: Study, full: bool) -> Iterator[tuple[str, Study]]:
    if not full:
        yield "universes", study
        return
    for portion in portions(study):
        yield f"universes-{portion.name}", portion.study


def _lived(
    plan: Plan,
    readings: tuple[Reading, ...],
    directory: Path,
    stage: str,
    workers: Workers,
    tell: Telling,
) -> Judged:
    """Simulate what a study lacks, and judge its universes."""

    def tell_stage(task: str, done: int, total: int, note: str = "") -> None:
        tell(f"{stage}, {task[0].lower()}{task[1:]}", done, total, note)

    if not run(plan, directory, workers, tell_stage).complete:
        raise InterruptedStudyError(str(directory))
    total = len(plan.cases) // 4
    tell_stage("Universes judged", 0, total)
    return judge(
        plan,
        open_results(directory),
        readings,
        tell=lambda universes: tell_stage("Universes judged", universes, total),
    )


def _together(parts: list[Judged]) -> Judged:
    """The universes of all portions as one, numbered through."""
    if len(parts) == 1:
        return parts[0]
    tables, ways, before = [], [], 0
    for part in parts:
        for collected, table in ((tables, part.table), (ways, part.deaths)):
            if table.num_rows:
                number = pa.array(before + table.column("universe").to_numpy())
                collected.append(table.set_column(0, "universe", number))
        before += len(part.universes.values)
    return Judged(
        parts[0].universes,
        pa.concat_tables(tables),
        pa.concat_tables(ways),
        sum(part.missing for part in parts),
    )


def _confirmed(
    study: Study,
    found: dict[str, SufficientSet | None],
    out: Path,
    size: Size,
    workers: Workers,
    tell: Telling,
) -> dict[str, Confirmation]:
    """Judge each set by fresh universes; claims that have one set share them."""
    if not size.confirming:
        return {}
    lived: dict[object, pa.Table] = {}
    told = {}
    for claim, one in found.items():
        if one is None:
            continue
        if one.conditions not in lived:
            allowed = {condition.reading: condition.values for condition in one.conditions}
            again = fresh(study, allowed, size.confirming)
            name = f"confirmation/{claim}"
            directory = _directory_of(again, out / name)
            lived[one.conditions] = _lived(
                Plan(again), readings_of(study), directory, name, workers, tell
            ).table
        if lived[one.conditions].num_rows:
            told[claim] = confirm(one, lived[one.conditions])
    return told


def _directory_of(study: Study, wanted: Path) -> Path:
    """Return `wanted`, or where another study stands there, the first free name after it.

    A set may be another one where an analysis is made again by a later version.
    """
    for number in itertools.count(2):
        if not (wanted / MANIFEST).exists():
            break
        if open_results(wanted).study.to_toml() == study.to_toml():
            break
        wanted = wanted.with_name(f"{wanted.name.partition('-')[0]}-{number}")
    return wanted


def _late(
    study: Study, judged: Judged, out: Path, size: Size, workers: Workers, tell: Telling
) -> pa.Table | None:
    """Compare the first universes with themselves under a late cap."""
    if not size.longer or size.late <= study.steps:
        return None
    plan = Plan(longer(study, size.longer, size.late))
    late = _lived(plan, readings_of(study), out / "longer", "longer", workers, tell)
    same = len(late.universes.values)
    if late.universes.values != judged.universes.values[:same]:
        raise AssertionError("a sample does not begin like a larger one of the same seed")
    if not late.table.num_rows:
        return None
    return time_limit_effects(judged.table, late.table)

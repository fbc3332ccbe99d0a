import json
import shutil

import pyarrow.parquet as pq
import pytest

from animat.experiments import multiverse as module
from animat.experiments import multiverse_designs as designs
from animat.experiments.multiverse import (
    InterruptedStudyError,
    Size,
    run_multiverse,
)
from animat.files.settings import SettingsError
from animat.statistics.claims import CLAIMS
from animat.statistics.estimates import share
from animat.statistics.lives import column
from animat.statistics.sufficient_sets import Condition, SufficientSet
from animat.study.execute.run import threads
from animat.study.store.results import open as open_results

NOTHING_BESIDE = Size(confirming=0, longer=0)


def quiet(*_, **__):
    pass


def go(study, directory, size=NOTHING_BESIDE, tell=quiet, full=False):
    with threads(2) as workers:
        return run_multiverse(study, directory, size, workers, tell, full=full)


def test_everything_asked_for_is_found(lived, small):
    found = lived.found
    total = found.table.num_rows
    assert found.missing == 0
    assert sum(rule.count for rule in found.left_out) / 4 + total == small.design.sample.points
    assert found.shares.num_rows == 3 * len(CLAIMS)
    assert set(found.found) == set(CLAIMS)
    assert found.predicted is not None
    assert found.time_limit is not None
    assert column(found.time_limit, "universes").tolist() == [len_of(lived, "longer")] * 11
    assert found.fewest_together >= 1


def len_of(lived, name):
    return open_results(lived.directory / name).cases.num_rows // 4


def test_the_late_cap_is_that_of_the_same_universes(lived, small):
    late = open_results(lived.directory / "longer")
    assert late.study.steps == 1_200
    assert late.study.model_copy(update={"steps": small.steps}).seed == small.seed
    early = open_results(lived.directory / "universes").lives(["case", "life", "lifespan"])
    assert max(column(late.lives(["lifespan"]), "lifespan")) > 600 >= max(column(early, "lifespan"))


def test_all_of_it_is_told_to_its_end(lived):
    done: dict[str, int] = {}
    for task, count, _ in lived.told:
        done[task] = done.get(task, 0) + count
    totals = {task: total for task, _, total in lived.told}
    assert done == totals
    assert {"universes, lives", "universes, robots that learn", "longer, lives"} <= set(done)


def test_a_directory_that_is_finished_is_only_analysed(lived, small, tmp_path):
    directory = tmp_path / "again"
    shutil.copytree(lived.directory, directory)
    before = {p: p.stat().st_mtime_ns for p in directory.rglob("part-*.parquet")}
    again = go(small, directory)
    assert again.table.equals(lived.found.table)
    assert again.marginal.to_pandas().equals(lived.found.marginal.to_pandas())
    after = {p: p.stat().st_mtime_ns for p in directory.rglob("part-*.parquet")}
    assert after == before


def test_one_that_was_ended_in_the_middle_is_gone_on_with(small, lived, tmp_path, monkeypatch):
    directory = tmp_path / "ended"
    seen = []

    def ended(plan, where, workers, tell):
        outcome = whole(plan, where, workers, tell)
        for part in sorted((where / "lives").glob("part-*.parquet"))[3:]:
            part.unlink()
            seen.append(part.name)
        return outcome._replace(tally=open_results(where).tally())

    whole = module.run
    monkeypatch.setattr(module, "run", ended)
    with pytest.raises(InterruptedStudyError, match="ended"):
        go(small, directory)
    assert seen
    monkeypatch.setattr(module, "run", whole)
    kept = {p.name: p.stat().st_mtime_ns for p in (directory / "universes/lives").glob("part-*")}
    found = go(small, directory)
    assert found.table.equals(lived.found.table)
    for name, time in kept.items():
        assert (directory / "universes/lives" / name).stat().st_mtime_ns == time


def test_a_set_that_is_found_is_confirmed_by_fresh_universes(small, tmp_path, monkeypatch):
    conditions = (Condition("overflow", ("clamp",)),)

    def found_by_hand(universes, readings, claim):
        if claim not in {"C1", "C6"}:
            return None
        return SufficientSet(claim, conditions, 40, share(39, 40))

    monkeypatch.setattr(module, "sufficient_set", found_by_hand)
    found = go(small, tmp_path, Size(confirming=4, longer=0))
    assert set(found.confirmed) == {"C1", "C6"}
    # Both claims have one set, so they share its universes.
    assert [path.name for path in (tmp_path / "confirmation").iterdir()] == ["C1"]
    fresh = open_results(tmp_path / "confirmation/C1")
    assert set(fresh.cases["mind.overflow"].to_pylist()) == {"clamp"}
    assert fresh.study.seed != small.seed
    for told in found.confirmed.values():
        assert told.universes == fresh.cases.num_rows // 4
        assert told.verdict == "undecided" or told.share.value < 0.95


def test_where_another_set_is_found_later_it_is_confirmed_beside_the_first(
    small, lived, tmp_path, monkeypatch
):
    """As by a later version: what was lived of the universes is not lost for it."""
    directory = tmp_path / "again"
    shutil.copytree(lived.directory, directory)
    for value, there in (("clamp", {"C1"}), ("lethal", {"C1", "C1-2"}), ("clamp", {"C1", "C1-2"})):
        conditions = (Condition("overflow", (value,)),)

        def by_hand(universes, readings, claim, conditions=conditions):
            return SufficientSet(claim, conditions, 40, share(39, 40)) if claim == "C1" else None

        monkeypatch.setattr(module, "sufficient_set", by_hand)
        found = go(small, directory, Size(confirming=4, longer=0))
        assert found.confirmed["C1"].found.conditions == conditions
        assert {path.name for path in (directory / "confirmation").iterdir()} == there
    second = open_results(directory / "confirmation/C1-2")
    assert set(second.cases["mind.overflow"].to_pylist()) == {"lethal"}


def test_the_full_product_is_lived_in_portions(small, tmp_path, monkeypatch):
    data = json.loads(small.model_dump_json(exclude_none=True))
    over = data["design"]["sample"]["over"]
    kept = ("mind.physiology", "mind.lethal_margin", "mind.overflow", "worlds.rich.seed")
    data["design"]["sample"]["over"] = {name: over[name] for name in kept}
    data["design"]["exclude"] = data["design"]["exclude"][:1]
    for world, name in (("rich", "abundant"), ("poor", "scarce")):
        data["worlds"][world] = {"layout": name}
    study = module.Study.model_validate_json(json.dumps(data))
    monkeypatch.setattr(designs, "PORTION", 20)
    found = go(study, tmp_path, full=True)
    assert found.table.num_rows == 6 * 2
    assert column(found.table, "universe").tolist() == list(range(12))
    assert column(found.deaths, "lives").sum() == 12 * 4 * 3
    assert len(list(tmp_path.glob("universes-*"))) == 4
    assert found.time_limit is None


def test_a_study_without_a_sample_is_refused(small, tmp_path):
    design = small.design.model_copy(update={"sample": None, "exclude": []})
    with pytest.raises(SettingsError, match=r"needs a \[design.sample\]"):
        go(small.model_copy(update={"design": design}), tmp_path)


def test_universes_that_all_failed_are_told_of(small, lived, tmp_path, monkeypatch):
    universes = lived.found.table.slice(0, 0)
    empty = (lived.found.universes, universes, lived.found.deaths.slice(0, 0), 5)
    monkeypatch.setattr(module, "judge", lambda *_, **__: module.Judged(*empty))
    with pytest.raises(SettingsError, match="nothing can be judged"):
        go(small, lived.directory)


def test_where_only_universes_beside_them_failed_the_others_are_told_of(
    small, lived, tmp_path, monkeypatch
):
    directory = tmp_path / "again"
    shutil.copytree(lived.directory, directory)
    one = SufficientSet("C1", (), 40, share(39, 40))
    monkeypatch.setattr(module, "sufficient_set", lambda *_: one)
    whole = module.judge

    def judge(plan, results, readings, **settings):
        judged = whole(plan, results, readings, **settings)
        if results.directory.name == "universes":
            return judged
        return judged._replace(table=judged.table.select(["universe"]).slice(0, 0))

    monkeypatch.setattr(module, "judge", judge)
    found = go(small, directory, Size(confirming=4, longer=4, late=1_200))
    assert found.table.equals(lived.found.table)
    assert (found.time_limit, found.confirmed) == (None, {})


def test_the_tables_are_those_of_the_store(lived):
    assert pq.read_table(lived.directory / "universes/cases.parquet").num_rows == 4 * (
        lived.found.table.num_rows
    )

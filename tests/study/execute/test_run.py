"""A study lived: every life once, whoever lives it; ended, and gone on with."""

from __future__ import annotations

import json
import shutil
from collections import Counter
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from threading import Event

import pytest

from animat.study.execute import run as module
from animat.study.execute.run import Workers, run, threads
from animat.study.plan.numbering import Part
from animat.study.store.log import entries
from animat.study.store.store import StoreError


def silent(*_, **__):
    pass


class AtOnce(Executor):
    """Lives a part when it is handed out, from what could be sent anywhere, and keeps count."""

    def __init__(self):
        self.parts = []

    def submit(self, live, text, part, networks):
        self.parts.append(part)
        future = Future()
        kept = {place: json.loads(json.dumps(w.tolist())) for place, w in networks.items()}
        assert all(len(weights) == 3 for weights in kept.values())
        future.set_result(live(text, part, networks))
        return future


def lived_in(directory):
    """Which parts were lived in each run, by its log."""
    runs = []
    for event in entries(directory / "log.jsonl"):
        if event["event"] == "start":
            runs.append([])
        elif event["event"] == "part":
            runs[-1].append(Part(event["kind"], event["number"]))
    return runs


@pytest.mark.parametrize("count", [1, 2, 5])
def test_the_number_of_threads_does_not_matter(count, small, finished, faults, tmp_path):
    with threads(count) as workers:
        outcome = run(small, tmp_path, workers, silent)
    assert outcome.complete
    assert faults.told_of(tmp_path) == faults.told_of(finished)


def test_who_lives_the_parts_does_not_matter(small, finished, faults, tmp_path):
    executor = AtOnce()
    outcome = run(small, tmp_path, Workers(executor, 3, None), silent)
    assert outcome.complete
    assert sorted(executor.parts) == sorted(small.all_parts())
    assert faults.told_of(tmp_path) == faults.told_of(finished)


def test_only_what_is_missing_is_lived(small, finished, faults, tmp_path):
    directory = shutil.copytree(finished, tmp_path / "results")
    for parts in ([], [Part("lives", 1)], [Part("teachers", 0)], list(small.all_parts())):
        for part in parts:
            (directory / part.file).unlink()
        executor = AtOnce()
        assert run(small, directory, Workers(executor, 1, None), silent).complete
        assert sorted(executor.parts) == sorted(parts)
        assert sorted(lived_in(directory)[-1]) == sorted(parts)
        assert faults.told_of(directory) == faults.told_of(finished)


@contextmanager
def asking_after(parts):
    """Ctrl-C when so many parts are written."""
    asked = Event()

    @contextmanager
    def interruptible(stop):
        yield asked

    def tell(task, done, total, note=""):
        tell.told += done > 0
        if tell.told >= parts:
            asked.set()

    tell.told = 0
    before, module.interruptible = module.interruptible, interruptible
    try:
        yield tell
    finally:
        module.interruptible = before


def test_what_is_under_way_is_finished_and_no_more_begun(faults, tmp_path):
    plan = faults.plan(faults.LARGER)
    with asking_after(3) as tell, threads(1) as workers:
        outcome = run(plan, tmp_path, workers, tell)
    (first,) = lived_in(tmp_path)
    assert not outcome.complete
    assert 3 <= len(first) <= 3 + module.AHEAD
    assert outcome.tally.counts["lives"].rows == sum(
        plan.numbering["lives"].rows(part.number) for part in first if part.kind == "lives"
    )
    assert list(entries(tmp_path / "log.jsonl"))[-1]["why"] == "interrupted"
    faults.go_on(plan, tmp_path)
    parts = Counter(part for run_ in lived_in(tmp_path) for part in run_)
    assert parts == dict.fromkeys(plan.all_parts(), 1)


def test_parts_that_nobody_has_begun_are_taken_back(faults, tmp_path):
    handed_out = []

    class Later(Executor):
        def submit(self, *_):
            handed_out.append(Future())
            tell("Lives", len(handed_out) == 6, 100)
            return handed_out[-1]

    with asking_after(1) as tell:
        outcome = run(faults.plan(faults.LARGER), tmp_path, Workers(Later(), 4, None), tell)
    assert outcome.tally.counts["lives"].rows == 0
    assert len(handed_out) == 6
    assert all(future.cancelled() for future in handed_out)


def test_the_second_interruption_stops_at_once_and_loses_nothing_that_is_finished(faults, tmp_path):
    plan = faults.plan(faults.SMALL.replace("steps = 150", "steps = 1_000_000_000"))
    started = Event()

    def tell(task, done, total, note=""):
        if done:
            started.set()
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), threads(2) as workers:
        run(plan, tmp_path, workers, tell)
    assert started.is_set()
    assert lived_in(tmp_path) == [[Part("teachers", 0)]]
    last = list(entries(tmp_path / "log.jsonl"))[-1]
    assert (last["event"], last["why"]) == ("end", "KeyboardInterrupt")


def test_a_disk_that_fails_ends_the_run(small, tmp_path, monkeypatch):
    def fails(self, part, made):
        raise StoreError("no disk")

    monkeypatch.setattr(module.Store, "put", fails)
    with pytest.raises(StoreError, match="no disk"), threads(2) as workers:
        run(small, tmp_path, workers, silent)
    assert list(entries(tmp_path / "log.jsonl"))[-1]["why"] == "StoreError"


def test_a_mistake_of_ours_is_no_result(small, tmp_path, monkeypatch):
    def fails(*_, **__):
        raise ZeroDivisionError

    monkeypatch.setattr(module, "live_part", fails)
    with pytest.raises(ZeroDivisionError), threads(2) as workers:
        run(small, tmp_path, workers, silent)
    assert not list((tmp_path / "lives").glob("part-*"))


def test_it_is_told_how_far_it_is(small, finished, tmp_path):
    directory = shutil.copytree(finished, tmp_path / "results")
    (directory / "lives" / "part-000001.parquet").unlink()
    told = []
    with threads(1) as workers:
        run(small, directory, workers, lambda *each: told.append(each))
    assert [each[:3] for each in told] == [
        ("Robots that learn", 3, 3),
        ("Lives", 8, 16),
        ("Lives", 8, 16),
    ]
    assert told[1][3] == "time left not known yet, 1 of 2 cases"
    assert told[2][3].endswith(", 2 of 2 cases")

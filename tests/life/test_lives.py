"""Many lives: the same as one by one, whatever the threads, the chunks and the order."""

import re
import threading

import numpy as np
import pytest

from animat.life import batch
from animat.life import lives as module
from animat.life.life import live
from animat.life.lives import live_chunks, live_many
from animat.life.scenario import LifeError, bring_together
from animat.mind.mind import Mind
from animat.statistics.survival import ALIVE

STEPS = 4_000


@pytest.fixture(scope="module")
def many(small):
    return live_many(Mind(), small, lives=70, seed=6, steps=STEPS)


def test_many_lives_are_lives_one_by_one(many, small):
    rows = many.table.to_pylist()
    assert [row["life"] for row in rows] == list(range(70))
    for row in rows:
        assert row == live(Mind(), small, seed=6, life=row["life"], steps=STEPS).summary
    assert {row["censored"] for row in rows} == {True, False}


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_the_number_of_threads_does_not_matter(threads, many, small):
    told = live_many(Mind(), small, lives=70, seed=6, steps=STEPS, threads=threads)
    assert told.table.equals(many.table)


@pytest.mark.parametrize(("chunk", "length"), [(1, 10_000), (7, 333), (1_000, 1)])
def test_chunks_and_slices_do_not_matter(chunk, length, many, small, monkeypatch):
    monkeypatch.setattr(module, "chunk_size", lambda steps, lives, threads: chunk)
    monkeypatch.setattr(batch, "LOOK_EVERY", length)
    steps, lives = (STEPS, 70) if length > 1 else (300, 10)
    told = live_many(Mind(), small, lives=lives, seed=6, steps=steps)
    if length > 1:
        assert plain(told.table) == plain(many.table)
    else:
        monkeypatch.undo()
        other = live_many(Mind(), small, lives=lives, seed=6, steps=steps)
        assert plain(told.table) == plain(other.table)


def plain(table):
    return table.to_pydict()


@pytest.mark.parametrize("first", [1, 40, 69])
def test_lives_may_begin_at_any_index(first, many, small):
    told = live_many(Mind(), small, lives=70 - first, seed=6, first=first, steps=STEPS)
    assert plain(told.table) == plain(many.table.slice(first))


def test_networks_are_dealt_out_in_turn(small, trained):
    other = live(Mind(agent="LEARNING"), small, seed=9, steps=3_000).networks
    told = live_many(
        Mind(agent="AF", networks=trained),
        small,
        lives=7,
        first=2,
        seed=6,
        steps=STEPS,
        networks=[trained, other, trained],
    )
    for row in told.table.to_pylist():
        networks = [trained, other, trained][row["life"] % 3]
        mind = Mind(agent="AF", networks=networks)
        assert row == live(mind, small, seed=6, life=row["life"], steps=STEPS).summary


def test_networks_stand_in_for_those_a_mind_lacks(small, trained):
    told = live_many(Mind(agent="AF"), small, lives=3, steps=500, networks=[trained])
    own = live_many(Mind(agent="AF", networks=trained), small, lives=3, steps=500)
    assert told.table.equals(own.table)


def test_what_lives_have_to_say_of_themselves(many):
    mean = many.mean_lifespan()
    spans = many.table["lifespan"].to_numpy()
    assert mean.value == pytest.approx(spans.mean())
    assert mean.low < mean.value < mean.high
    counted = {cause.label: cause.count for cause in many.causes()}
    assert sum(counted.values()) == 70
    assert counted[ALIVE] == sum(many.table["censored"].to_pylist()) > 0
    for variable in ("nutrition", "stamina", "restlessness"):
        died = many.table["death_variable"].to_pylist().count(variable)
        assert sum(n for label, n in counted.items() if label.startswith(variable)) == died


def test_progress_is_told_as_steps_lived(small):
    told = []
    lock = threading.Lock()

    def progress(steps):
        with lock:
            told.append(steps)

    lives = live_many(Mind(), small, lives=40, seed=6, steps=30_000, progress=progress)
    assert sum(told) == sum(lives.table["lifespan"].to_pylist())
    assert len(told) > 2
    one = []
    live(Mind(death=False), small, steps=250_000, progress=one.append)
    assert one == [100_000, 100_000, 50_000]


def test_lives_stop_soon_when_they_are_told_to(small):
    """As Ctrl-C does: the lives under way end at the next look outside."""
    stop, told = threading.Event(), []
    setting = bring_together(Mind(death=False), small)

    def progress(steps):
        told.append(steps)
        stop.set()

    own = batch.Batch(setting, 1, 10**9, stop=stop, progress=progress)
    with pytest.raises(batch.StoppedError):
        own.run(np.arange(4, dtype=np.uint64))
    assert told == [4 * batch.LOOK_EVERY]


def test_an_interruption_reaches_the_caller_and_stops_the_threads(small):
    calls = []

    def interrupted(steps):
        calls.append(steps)
        raise KeyboardInterrupt

    before = threading.active_count()
    with pytest.raises(KeyboardInterrupt):
        live_many(Mind(death=False), small, lives=64, steps=10**9, progress=interrupted)
    assert threading.active_count() == before
    assert len(calls) <= 4


def test_chunks_that_nobody_waits_for_are_not_lived_on(small):
    setting = bring_together(Mind(death=False), small)
    chunks = live_chunks(setting, 1, 0, 1_000_000, 200, threads=1)
    first = next(chunks)
    before = threading.active_count()
    chunks.close()
    assert threading.active_count() < before
    assert first["life"].to_pylist() == list(range(module.chunk_size(200, 1_000_000, 1)))


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"seed": -1}, "seed = -1; allowed are whole numbers from 0 to 2^64 - 1"),
        ({"seed": 2**64}, f"seed = {2**64}; allowed are whole numbers from 0 to 2^64 - 1"),
        ({"steps": 0}, "steps = 0; allowed are whole numbers from 1 to 2^50"),
        ({"steps": 2**50 + 1}, f"steps = {2**50 + 1}; allowed are whole numbers from 1 to 2^50"),
        ({"lives": 0}, "lives = 0; allowed are whole numbers from 1 to 1,000,000,000"),
        ({"first": -1}, "first = -1; allowed are whole numbers from 0 to 2^63 - 1"),
        ({"first": 2**63 - 1}, "lives = 2; allowed are whole numbers from 1 to 1"),
        ({"networks": []}, "networks is empty; give at least one"),
    ],
)
def test_lives_that_cannot_be_lived_are_refused(asked, told, small):
    with pytest.raises(LifeError, match=f"^{re.escape(told)}$"):
        live_many(Mind(), small, **{"lives": 2, "steps": 10, **asked})


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"seed": -1}, "seed = -1"),
        ({"life": -1}, "life = -1"),
        ({"life": 2**63}, f"life = {2**63}"),
        ({"steps": -5}, "steps = -5"),
    ],
)
def test_a_life_that_cannot_be_lived_is_refused(asked, told, small):
    with pytest.raises(LifeError, match=told):
        live(Mind(), small, **{"steps": 10, **asked})


def test_consumed_objects_need_spare_sites(small):
    with pytest.raises(LifeError, match="spare sites"):
        live(Mind(consumed=True), small, steps=10)


def test_an_affordance_the_world_does_not_know_is_refused(small):
    behaviours = {"eat": {"serves": "hunger", "needs": "grip"}}
    with pytest.raises(LifeError, match='needs = "grip"'):
        live(Mind(behaviours=behaviours), small, steps=10)


@pytest.mark.parametrize(("lives", "threads"), [(512, 2), (100_000, 2), (1_000_000, 16)])
@pytest.mark.parametrize("steps", [100, 10_000, 300_000])
def test_every_thread_takes_several_chunks_and_none_is_long(lives, threads, steps):
    size = module.chunk_size(steps, lives, threads)
    assert module.CHUNK <= size <= module.LARGEST_CHUNK
    assert size * threads * module.TURNS <= lives + threads * module.TURNS or size == module.CHUNK
    assert size * steps <= module.STEPS_OF_A_CHUNK or size == module.CHUNK

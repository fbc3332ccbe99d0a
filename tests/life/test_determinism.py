"""The same bits: on any processor, compiled or not, recorded or not, however lives are cut up,
batched, ordered and spread over threads.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from animat.life import batch as life_batch
from animat.life import lives as life_lives
from animat.life.batch import advance
from animat.life.digest import digest
from animat.life.engine import ENGINE
from animat.life.life import live
from animat.life.lives import live_many
from animat.life.scenario import bring_together
from animat.mind.agents import AGENTS
from animat.mind.mind import Mind
from animat.mind.physiology import PHYSIOLOGIES
from animat.robot.parameters import MODELS

from . import golden, processors

HERE = Path(__file__).parent


@pytest.fixture(scope="module")
def known():
    return json.loads(golden.FILE.read_text(encoding="utf-8"))


def test_golden_lives_are_lived_to_the_bit(known):
    assert golden.told() == known


def test_golden_lives_are_of_this_engine(known):
    assert type(ENGINE) is int
    assert known["engine"] == ENGINE
    assert golden.unexplained(golden.CHANGELOG.read_text(encoding="utf-8"), ENGINE) == []


def test_golden_lives_are_lives_of_many_kinds(known):
    """Of every agent, physiology, sensor model and world; and much happens in them."""
    cases = list(golden.cases())
    assert list(known["long"]) == [case.name for case in cases]
    assert list(known["short"]) == [case.name for case in cases if case.short]
    assert list(known["rasters"]) == list(golden.worlds())
    kinds = {
        (case.world.name, case.mind.agent, case.mind.physiology, case.robot.infrared)
        for case in cases
    }
    assert len(kinds) >= 4 * len(AGENTS) * len(PHYSIOLOGIES) * len(MODELS)
    for part, share in (("rasters", 1.0), ("short", 0.85), ("long", 0.95)):
        assert len(set(known[part].values())) >= share * len(known[part])
    short = [golden.lived(case, golden.SHORT)[0] for case in cases if case.world is golden.SMALL]
    assert sum(state.acts > 0 for state in short) > 0.8 * len(short)
    ends = [golden.lived(case, golden.LONG) for case in cases]
    for what in ("acts", "successes", "disregarded", "unreached", "trainings", "blocked", "dead"):
        assert sum(state[what] > 0 for state, _ in ends) > 0, what
    assert sum(present[4:].any() for _, present in ends if len(present) == 6) > 0


# One processor that has fused multiply-add, the best reason to round otherwise; the nightly profile
# takes all that this machine can run, and so does the script processors.py.
NIGHTLY = settings.get_current_profile_name() == "nightly"
POSSIBLE = [name for name in processors.possible() if name != "this machine"]
COMPILED = "haswell" if "haswell" in POSSIBLE else "generic"
WITHOUT_AVX = {"generic", "nehalem"}


@pytest.mark.long
@pytest.mark.parametrize("name", POSSIBLE if NIGHTLY else ["uncompiled", COMPILED])
def test_golden_lives_are_the_same_on_code_for(name, tmp_path):
    said = processors.lived_on(name, tmp_path, "short" if NIGHTLY else "few")
    assert processors.differences(said["told"]) == []
    kept = {path.suffix for path in tmp_path.rglob("*.nb*")}
    if name == "uncompiled":
        assert kept == set()
        return
    parts = {"engine", "rasters", "short", "many"}
    assert set(said["told"]) == (parts | {"long"} if NIGHTLY else parts)
    assert kept == {".nbi", ".nbc"}
    code = said["code"]
    wanted = processors.PROCESSORS[name].settings
    assert code["processor"] == wanted["NUMBA_CPU_NAME"]
    assert code["features"] == wanted["NUMBA_CPU_FEATURES"]
    assert code["fused"] == 0
    assert bool(code["vector encoded"]) == (name not in WITHOUT_AVX)
    assert bool(code["fused where asked"]) >= (name == "haswell")


def test_the_few_are_of_every_kind(known):
    few = golden.few()
    assert {case.name for case in few} <= set(known["short"])
    assert {case.mind.agent for case in few} == set(AGENTS)
    assert {case.mind.physiology for case in few} == set(PHYSIOLOGIES)
    assert {case.robot.infrared for case in few} == set(MODELS)
    assert {case.name for case in few} >= set(golden.READINGS)


def test_a_processor_that_fuses_would_be_found(known):
    other = {**known, "short": dict.fromkeys(known["short"], "0"), "many": "1"}
    assert processors.differences(known) == []
    assert len(processors.differences(other)) == len(known["short"]) + 1
    for line in ("vfmadd213sd %xmm1, %xmm2, %xmm0", "fmadd d0, d1, d2, d3", "fmla v0.2d, v1.2d"):
        assert processors.FUSED.search("\t" + line)
    for line in ("vmulsd %xmm1, %xmm2, %xmm0", "mulsd %xmm1, %xmm0", "fmul d0, d1, d2"):
        assert not processors.FUSED.search("\t" + line)


# Every two of the three with each other.
@pytest.mark.parametrize(
    ("threads", "batch", "shuffled"),
    [
        (threads, batch, bool((i + j) % 2))
        for i, threads in enumerate((1, 2, 4))
        for j, batch in enumerate((1, 7, 1_000))
    ],
)
def test_threads_batches_and_order_do_not_matter(threads, batch, shuffled, known):
    assert golden.many(batch, threads, shuffled) == known["many"]


def test_neither_threads_nor_chunks_matter_to_many_lives_at_once(monkeypatch):
    mind = Mind(agent="LEARNING", death=False, **golden.USUAL)
    tables = []
    for threads, chunk, cut in ((1, 32, 10_000), (2, 7, 10_000), (4, 1, 100), (4, 1_000, 999)):
        monkeypatch.setattr(life_lives, "CHUNK", chunk)
        monkeypatch.setattr(life_batch, "LOOK_EVERY", cut)
        tables.append(
            live_many(mind, golden.SMALL, lives=70, seed=3, steps=2_000, threads=threads).table
        )
    assert tables[0].num_rows == 70
    assert all(table.equals(tables[0]) for table in tables)


@pytest.mark.parametrize("cut", [1, 7, 1_000])
def test_a_life_may_be_cut_anywhere(cut, small):
    setting = bring_together(Mind(agent="LEARNING"), small)
    lives = np.array([3], np.uint64)
    states, present = setting.begin(8, lives)
    for until in [*range(cut, 1_500, cut), 1_500]:
        advance(setting, 8, lives, states, present, until)
    whole = live(Mind(agent="LEARNING"), small, seed=8, life=3, steps=1_500)
    assert digest(states[0], present[0]) == digest(whole.state, present[0])


@pytest.mark.parametrize("record", ["all", "every:7", "last:20"])
def test_to_be_recorded_changes_nothing(record, small):
    mind = Mind(agent="LEARNING")
    recorded, alone = (
        live(mind, small, seed=8, life=3, steps=2_000, record=how) for how in (record, None)
    )
    present = np.ones(4, np.uint8)
    assert digest(recorded.state, present) == digest(alone.state, present)


def test_the_largest_indices_are_lives_like_others(small):
    setting = bring_together(Mind(), small)
    indices = np.array([0, 1, 2**40, 2**63 - 1], np.uint64)
    alone = {}
    for index in indices:
        life = live(Mind(), small, seed=1, life=int(index), steps=900)
        alone[int(index)] = digest(life.state, np.ones(4, np.uint8))
    assert len(set(alone.values())) == len(indices)
    for order in (indices, indices[::-1].copy()):
        states, present = setting.begin(1, order)
        advance(setting, 1, order, states, present, 900)
        ends = [digest(*one) for one in zip(states, present, strict=True)]
        assert ends == [alone[int(index)] for index in order]


@pytest.mark.parametrize("seed", [0, 1, 2**32, 2**64 - 1])
def test_every_seed_and_life_is_another_life(seed, small):
    starts = {
        (float(state.x), float(state.y))
        for state in (
            live(Mind(), small, seed=seed ^ flip, life=life, steps=1).state
            for flip in (0, 1, 2**63)
            for life in (0, 1, 2**32)
        )
    }
    assert len(starts) == 9


def test_a_changed_hash_is_not_written_under_the_same_engine(known):
    name = next(iter(known["long"]))
    other = {**known, "long": {**known["long"], name: "0" * 32}}
    shorter = {**known, "short": dict(list(known["short"].items())[1:])}
    drawn = {**known, "rasters": dict.fromkeys(known["rasters"], "0" * 32)}
    more = {**known, "long": {**known["long"], "another life": "0" * 32}}
    raised = {**other, "engine": ENGINE + 1}
    every = " ".join(f"engine {number}" for number in range(2, ENGINE + 2))
    for allowed in (known, more, drawn, raised):
        assert golden.objection(known, allowed, every) is None
    for changed, where in ((other, f"long: {name}"), (shorter, "short: small")):
        reason = golden.objection(known, changed, every)
        assert where in reason
        assert "raise ENGINE" in reason
    assert "many" in golden.objection(known, {**known, "many": ""}, every)
    assert f"nothing of engine {ENGINE + 1}" in golden.objection(known, raised, "Engine 0: no.")
    assert "this is engine" in golden.objection({**known, "engine": ENGINE + 1}, known, every)


def test_the_changelog_speaks_of_every_engine():
    said = "- **Engine 2**: because.\n- **Engine 4**: and so on, as engine 12 did."
    assert golden.unexplained(said, 1) == []
    assert golden.unexplained(said, 2) == []
    assert golden.unexplained(said, 5) == [3, 5]


def test_the_command_refuses_to_write_what_changed(tmp_path, known, monkeypatch, capsys):
    """Beside a file that says something else; what is lived is held to `known` above."""
    file = tmp_path / "golden.json"
    monkeypatch.setattr(golden, "FILE", file)
    monkeypatch.setattr(golden, "told", lambda: known)
    file.write_text(json.dumps({**known, "many": "another"}))
    assert golden.main([]) == 1
    assert capsys.readouterr().err.startswith("1 golden lives are not those of engine")
    assert json.loads(file.read_text())["many"] == "another"
    file.unlink()
    assert golden.main([]) == 0
    assert capsys.readouterr().err == ""
    assert json.loads(file.read_text()) == known


def test_the_page_names_tests_that_are_there():
    root = HERE.parents[1]
    page = (root / "docs" / "determinism.md").read_text(encoding="utf-8")
    named = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", page)
    assert len(named) > 20
    for file, test in named:
        assert f"def {test}(" in (root / file).read_text(encoding="utf-8"), test

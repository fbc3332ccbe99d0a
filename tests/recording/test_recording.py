"""Recordings: whatever life is in one can be lived again, gone on with, and told from another."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from animat.files.atomic import RunError
from animat.files.checksummed import TEXT, writing
from animat.files.settings import SettingsError
from animat.life.engine import ENGINE
from animat.life.life import Moment, birth, live, lived
from animat.life.scenario import LifeError, bring_together
from animat.mind.mind import Mind
from animat.recording import recording as recording_module
from animat.recording.checkpoint import keep
from animat.recording.divergence import KEPT
from animat.recording.recording import BLOCK, EVERY, Recording, write_recording
from animat.robot.khepera import Khepera
from animat.world.world import World

PRODUCT = Path(__file__).parents[2] / "docs" / "examples" / "product.py"
MADE = {"made": "today"}
SEED, LIFE = 7, 2**63 - 1
STEPS, LATER = 900, 1_500


@pytest.fixture(autouse=True)
def in_small_blocks(monkeypatch):
    """Let every recording have several blocks."""
    monkeypatch.setattr(recording_module, "BLOCK", 256)


def born(mind: Mind, world: World, robot: Khepera | None = None) -> Moment:
    return birth(bring_together(mind, world, robot), SEED, LIFE)


def after(moment: Moment, steps: int) -> Moment:
    """Return the same life at a later step, lived without being recorded."""
    moment = moment.copy()
    assert list(lived(moment, steps, None)) == []
    return moment


def record(path: Path, moment: Moment, steps: int = STEPS, every: int = 100) -> Recording:
    write_recording(path, moment, steps=steps, every=every, made=MADE)
    return Recording.load(path)


MINDS: dict[str, dict[str, Any]] = {
    **{agent: {"agent": agent} for agent in ("BLIND", "AF", "LEARNING", "ORACLE", "RANDOM")},
    **{
        each: {"physiology": each, "death": False}
        for each in ("excess", "decay", "relax", "linear")
    },
    "noisy features": {"agent": "LEARNING", "feature_noise": 0.3, "gate": "always"},
    "consumed": {"agent": "LEARNING", "consumed": True, "gate": "always"},
    "more of everything": {
        "agent": "LEARNING",
        "variables": {
            "warmth": {"law": "linear", "kind": "deficit", "rate": 2e-4, "set_point": 0.9}
        },
        "drives": {**Mind().drives, "chill": {"a": {"warmth": 3.0}}},
        "behaviours": {**Mind().behaviours, "bask": {"serves": "chill", "needs": "shelter"}},
        "learning": {"hidden_units": 3},
    },
    "own function": {"agent": "ORACLE", "selector": f"{PRODUCT}:product", "death": False},
}


@pytest.mark.parametrize("name", MINDS)
def test_any_life_goes_on_from_any_recorded_step_with_the_same_future(
    name, small, spared, trained, tmp_path
):
    networks = trained if name == "AF" else None
    robot = Khepera(infrared="linear") if name == "relax" else None
    moment = born(
        Mind(networks=networks, **MINDS[name]), spared if name == "consumed" else small, robot
    )
    recording = record(tmp_path / "a.parquet", moment)
    head = recording.head
    assert recording.verify() is None
    future = after(moment, LATER)
    for step in (0, 1, 99, 100, 101, 255, 256, 257, 600, head.last - 1, head.last):
        if step > head.last:
            continue
        there = recording.at(step)
        assert there.step == step
        assert there.digest == after(moment, step).digest
        goes_on = after(there, LATER)
        # To the last bit of every field, but for those that hold nothing from step to step.
        assert keep(goes_on, head.fields) == keep(future, head.fields)
    if name == "consumed":
        assert future.present.tobytes() != moment.present.tobytes()


def test_what_is_recorded_is_the_life(small, tmp_path):
    mind = Mind(agent="LEARNING")
    told: list[int] = []
    path = tmp_path / "a.parquet"
    life = write_recording(
        path, born(mind, small), steps=STEPS, every=100, made=MADE, progress=told.append
    )
    alone = live(mind, small, seed=SEED, life=LIFE, steps=STEPS, record="all")
    assert life.summary == alone.summary
    assert life.trace is None
    assert sum(told) == STEPS
    recording = Recording.load(path)
    assert alone.trace is not None
    assert recording.trace.to_pylist() == alone.trace.to_pylist()
    assert recording.trace.column_names == alone.trace.column_names
    sizes = [recording.file.metadata.row_group(n).num_rows for n in range(4)]
    assert sizes == [256, 256, 256, STEPS - 3 * 256]
    kept = pq.read_table(path, columns=["step", *KEPT])
    steps = [row["step"] for row in kept.to_pylist() if row["kept_state"] is not None]
    assert steps == list(range(0, STEPS, 100))
    for row in kept.to_pylist():
        if row["kept_digest"] is not None:
            assert row["kept_digest"] == after(born(mind, small), row["step"]).digest
    assert recording.head.end.digest == after(born(mind, small), STEPS).digest
    assert BLOCK >= 10_000
    assert EVERY == 1_000


@pytest.mark.parametrize("every", [1, 7, 256, 10_000])
def test_a_moment_may_be_kept_every_so_many_steps(every, small, tmp_path):
    moment = born(Mind(agent="LEARNING"), small)
    recording = record(tmp_path / "a.parquet", moment, 300, every)
    kept = [row["kept_digest"] for row in recording.file.read(["kept_digest"]).to_pylist()]
    assert [n for n, each in enumerate(kept) if each] == list(range(0, 300, every))
    assert recording.head.moments == len(range(0, 300, every)) + 1
    assert recording.verify() is None
    assert recording.at(299).digest == after(moment, 299).digest


def test_a_life_gone_on_with_can_be_recorded_in_its_turn(small, tmp_path):
    moment = born(Mind(agent="LEARNING"), small)
    first = record(tmp_path / "a.parquet", moment, 500)
    second = record(tmp_path / "b.parquet", first.at(333), 800)
    third = record(tmp_path / "c.parquet", second.at(700), LATER)
    assert (second.head.first, second.head.last) == (333, 800)
    assert second.verify() is None
    assert third.verify() is None
    assert second.trace["step"].to_pylist() == list(range(333, 800))
    assert second.at(333).digest == first.at(333).digest
    assert after(third.at(710), LATER).digest == after(moment, LATER).digest
    for step in (0, 332, 801):
        with pytest.raises(LifeError, match=f"step {step} is not recorded, only 333 to 800 are"):
            second.at(step)


def test_a_recording_needs_nothing_beside_it(tmp_path):
    """Neither the file of the world nor that of the function's helper is asked for again."""
    World.random({"TS": 1, "CL": 1}, seed=3, name="mine").save(tmp_path / "w.toml")
    moment = born(Mind(agent="LEARNING"), World.load(tmp_path / "w.toml"))
    recording = record(tmp_path / "a.parquet", moment)
    (tmp_path / "w.toml").unlink()
    assert recording.verify() is None
    assert recording.setting.world == moment.setting.world


# --- differences --------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def known(small, tmp_path_factory):
    """The recording of a learner, and a place for forgeries of it."""
    folder = tmp_path_factory.mktemp("known")
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(recording_module, "BLOCK", 256)
        return record(folder / "a.parquet", born(Mind(agent="LEARNING"), small))


def forged(known: Recording, change=None, **head: Any) -> Recording:
    """Return a recording that was changed and written again: `change` gets and returns its rows."""
    path = known.path.with_name("forged.parquet")
    parts = [known.file.read_row_group(group) for group in range(known.file.num_row_groups)]
    with path.open("wb+") as out, writing(out, parts[0].schema) as file:
        for part in parts:
            rows = part.to_pylist()
            told = rows if change is None else change(rows)
            file.write(pa.Table.from_pylist(told, part.schema), "some")
        file.close(json.dumps({**json.loads(known.head.json_text()), **head}))
    return Recording.load(path)


COLUMNS = {
    "x": lambda value: np.nextafter(value, np.inf),
    "heading": lambda value: -value,
    "nutrition": lambda value: value + 1e-9,
    "curiosity": lambda value: value - 1e-9,
    "left": lambda value: value + 1,
    "infrared_3": lambda value: value + 1,
    "behaviour": lambda value: "approach" if value != "approach" else "leave",
    "object": lambda value: None if value else "TS",
    "event": lambda value: value + " success",
    "reward": lambda value: value - 1,
    "likelihood_eat": lambda value: (value or 0.0) / 2 + 0.1,
}


@given(step=st.integers(0, STEPS - 1), column=st.sampled_from(sorted(COLUMNS)))
def test_a_step_that_differs_is_found_whatever_differs_in_it(known, step, column):
    was = known.trace.slice(step, 1).to_pylist()[0][column]

    def change(rows):
        for row in rows:
            if row["step"] >= step:
                row[column] = COLUMNS[column](row[column])
        return rows

    found = forged(known, change).verify()
    assert found is not None
    assert found.step == step
    assert found.fields == (
        (column, repr(float(c) if isinstance(c := COLUMNS[column](was), float) else c), repr(was)),
    )


@settings(max_examples=settings().max_examples // 2)
@given(kept=st.integers(0, STEPS // 100 - 1), data=st.data())
def test_a_state_that_differs_is_found_though_the_trace_does_not(known, kept, data):
    step = 100 * kept
    place = data.draw(st.integers(0, 8))
    layout = np.dtype([(name, kind, shape) for name, kind, shape in known.head.fields])
    was = np.frombuffer(known._kept(step).state, layout)["weights"][0, 1, place].item()

    def change(rows):
        for row in rows:
            if row["step"] >= step and row["kept_state"]:
                state = np.frombuffer(row["kept_state"], layout).copy()
                state["weights"][0, 1, place] += 0.25
                row["kept_state"] = state.tobytes()
        return rows

    recording = forged(known, change)
    found = recording.verify()
    assert found is not None
    assert found.step == step
    assert found.fields == ((f"weights[shelter][{place}]", repr(was + 0.25), repr(was)),)
    with pytest.raises(LifeError, match=f"forged.*the state kept before step {step} does not fit"):
        recording.at(step + 50)


def test_an_end_that_differs_is_found(known):
    end = known.head.end.model_dump()
    found = forged(known, end={**end, "digest": "0" * 32}).verify()
    assert found is not None
    assert found.step == STEPS
    assert found.fields == (("digest", repr("0" * 32)[1:-1], known.head.end.digest),)
    present = "00" + end["present"][2:]
    found = forged(known, end={**end, "present": present}).verify()
    assert found is not None
    assert found.fields == (("present[0]", "0", "1"),)


@pytest.mark.parametrize(
    "change",
    [
        {"wander": "curved", "cruise_speed": 6},
        {"approach_steps": 9},
        {"variables": {"nutrition": {"set_point": 0.7}}},
        {"learning": {"rate": 0.25}},
        {"interaction_steps": 21},
    ],
)
def test_another_life_parts_where_the_lives_part(known, small, change):
    """The settings of the head are another's: the trace differs where the two lives' do."""
    other = Mind(agent="LEARNING", **change)
    trace = live(other, small, seed=SEED, life=LIFE, steps=STEPS, record="all").trace
    assert trace is not None
    pairs = zip(known.trace.to_pylist(), trace.to_pylist(), strict=True)
    parts = next(step for step, (old, new) in enumerate(pairs) if old != new)
    found = forged(known, mind=json.loads(other.model_dump_json())).verify()
    assert found is not None
    # The state, which is kept every 100 steps, may differ before the trace does, never after.
    assert found.step == parts or (found.step < parts and found.step % 100 == 0)
    if found.step == parts:
        old, new = (table.slice(parts, 1).to_pylist()[0] for table in (known.trace, trace))
        assert {each.name for each in found.fields if "[" not in each.name} >= {
            name for name in old if old[name] != new[name]
        }


def test_a_life_that_ends_elsewhere_is_another(small, tmp_path):
    mortal = born(Mind(variables={"stamina": {"start": 0.9995}}), small)
    recording = record(tmp_path / "a.parquet", mortal)
    assert recording.head.death is not None
    end = recording.head.last
    assert end < STEPS
    assert recording.verify() is None
    assert recording.at(end).state.dead
    immortal = json.loads(
        Mind(variables={"stamina": {"start": 0.9995}}, death=False).model_dump_json()
    )
    other = forged(recording, mind=immortal)
    found = other.verify()
    assert found is not None
    assert found.step == end - 1
    assert "event" in {each.name for each in found.fields}


# --- refusals -----------------------------------------------------------------------------------


@given(data=st.data())
def test_a_byte_that_is_changed_is_found(known, data):
    content = known.path.read_bytes()
    at = data.draw(st.integers(0, len(content) - 1))
    changed = bytearray(content)
    changed[at] ^= data.draw(st.integers(1, 255))
    path = known.path.with_name("changed.parquet")
    path.write_bytes(changed)
    with pytest.raises(SettingsError) as caught:
        Recording.load(path)
    (line,) = str(caught.value).splitlines()
    assert line.startswith(f"{path}: ")
    group = known.file.metadata.row_group
    begins = [
        group(n).column(0).dictionary_page_offset or group(n).column(0).data_page_offset
        for n in range(4)
    ]
    if begins[1] <= at < begins[2]:
        assert line.endswith(": steps 256 to 511")


@given(data=st.data())
def test_a_file_that_is_cut_short_is_refused(known, data):
    content = known.path.read_bytes()
    path = known.path.with_name("short.parquet")
    path.write_bytes(content[: data.draw(st.integers(0, len(content) - 1))])
    with pytest.raises(SettingsError) as caught:
        Recording.load(path)
    assert len(caught.value.problems) == 1


def test_a_trace_is_no_recording(small, tmp_path):
    trace = live(Mind(), small, steps=20, record="all").trace
    pq.write_table(trace, tmp_path / "t.parquet")
    with pytest.raises(SettingsError, match=r"t\.parquet: has no checksum"):
        Recording.load(tmp_path / "t.parquet")


def test_a_checksummed_file_of_something_else_is_refused(known):
    def why(change=None, **head) -> str:
        with pytest.raises(SettingsError) as caught:
            forged(known, change, **head).at(0)
        assert all(line.startswith(f"{known.path.parent}") for line in caught.value.problems)
        return str(caught.value)

    assert "is of format 0; this animat reads format 1" in why(format=0)
    assert "its head: key seed = -1" in why(seed=-1)
    assert "its steps are not those its head tells of" in why(last=STEPS + 1)
    assert "its steps are not those its head tells of" in why(lambda rows: rows[:-1])
    assert f"was lived by engine {ENGINE + 1}" in why(engine=ENGINE + 1)
    fields = [field for field in known.head.model_dump()["fields"] if field[0] != "mode"]
    assert "they differ in mode" in why(fields=fields)
    agent = {**json.loads(known.head.mind.model_dump_json()), "agent": "AF"}
    assert "AF needs trained networks" in why(mind=agent)
    world = {**known.head.world.model_dump(), "spares": [{"type": "TS", "x": 0.0, "y": 0.0}]}
    assert "leaves the free part of the arena" in why(world=world)
    with pytest.raises(LifeError, match=r"forged\.parquet: holds no state before step 100"):
        forged(known, first=50, last=STEPS + 50).at(150)


def test_states_whose_fields_have_another_order_are_the_same_states(known, monkeypatch, small):
    """As in a recording of a version that declares them in another order."""
    order = known.head.fields[::-1]
    monkeypatch.setattr("animat.recording.header.fields_of", lambda state: order)
    other = record(known.path.with_name("order.parquet"), born(Mind(agent="LEARNING"), small))
    assert other.head.fields == order
    assert other._kept(100).state != known._kept(100).state
    assert other.verify() is None
    assert other.at(150).digest == known.at(150).digest


def test_the_columns_must_be_those_of_the_life(known, tmp_path):
    part = known.file.read_row_group(0).drop_columns(["x"])
    path = tmp_path / "a.parquet"
    head = {**json.loads(known.head.json_text()), "last": part.num_rows}
    with path.open("wb+") as out, writing(out, part.schema) as file:
        file.write(part, "some")
        file.close(json.dumps(head))
    with pytest.raises(LifeError, match="its columns are not those of its life"):
        Recording.load(path).verify()
    assert TEXT.encode() in pq.read_metadata(path).metadata
    part = part.drop_columns(list(KEPT))
    with path.open("wb+") as out, writing(out, part.schema) as file:
        file.write(part, "some")
        file.close(json.dumps(head))
    with pytest.raises(SettingsError, match="its steps are not those its head tells of"):
        Recording.load(path)


def test_what_cannot_be_recorded_is_refused_and_leaves_nothing(small, tmp_path):
    path = tmp_path / "a.parquet"

    def why(moment: Moment, steps: int = STEPS, every: int = 1) -> str:
        with pytest.raises(LifeError) as caught:
            write_recording(path, moment, steps=steps, every=every, made=MADE)
        assert list(tmp_path.iterdir()) == []
        return str(caught.value)

    moment = born(Mind(), small)
    assert "every = 0; allowed" in why(moment, every=0)
    assert "steps = 0; allowed" in why(moment, steps=0)
    assert "nothing left to live up to 50" in why(after(moment, 50), steps=50)
    dead = after(born(Mind(variables={"stamina": {"start": 0.9995}}), small), STEPS)
    assert "nothing left to live up to 900" in why(dead)
    assert "selector: a recorded life must find" in why(born(Mind(selector=first), small))


def first(drives, likelihoods, serves, u, memory):
    return 0


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError(28, "No space left on device")])
def test_a_recording_that_comes_to_nothing_leaves_the_old_file(small, tmp_path, monkeypatch, error):
    path = tmp_path / "a.parquet"
    path.write_text("old")
    blocks = []

    def fails(steps):
        blocks.append(steps)
        if len(blocks) == 2:
            raise error

    expected = RunError if isinstance(error, OSError) else error
    with pytest.raises(expected):
        write_recording(path, born(Mind(), small), steps=STEPS, every=9, made=MADE, progress=fails)
    assert path.read_text() == "old"
    assert [each.name for each in tmp_path.iterdir()] == ["a.parquet"]


def test_what_is_recorded_last_does_not_hang_on_what_is_open(known, tmp_path):
    """A recording that is replaced while it is read stays what it was for who reads it."""
    path = tmp_path / "a.parquet"
    path.write_bytes(known.path.read_bytes())
    recording = Recording.load(path)
    write_recording(path, recording.at(200), steps=400, every=50, made=MADE)
    assert recording.verify() is None
    assert Recording.load(path).head.first == 200

"""One life from the command line: what is told and written is the life itself."""

import re
from pathlib import Path

import pyarrow.parquet as pq
import pytest

import animat
from animat.cli import main, one_life
from animat.cli.one_life import OneLife, live_one, story
from animat.files.atomic import RunError
from animat.files.settings import SettingsError
from animat.life import drawing
from animat.life import life as life_module
from animat.life.life import live
from animat.life.scenario import LifeError
from animat.mind.mind import Mind
from animat.recording.recording import EVERY, Recording
from animat.study.file.settings import LifeSettings
from animat.world.world import World


def silent(task, done, total):
    pass


def asked(mind=None, seed=2, index=1, steps=None, trace=None, figure=None, force=False, **further):
    settings = LifeSettings(mind=mind or Mind())
    return OneLife(settings, seed, index, steps, trace, figure, force, **further)


def test_it_is_the_life_asked_for():
    told = []
    life = live_one(asked(), lambda *each: told.append(each))
    alone = live(Mind(), World.abundant(), seed=2, life=1)
    assert life.summary == alone.summary
    assert life.trace is None
    assert sum(done for _, done, _ in told) == life.lifespan
    assert {(task, total) for task, _, total in told} == {("Life, steps", 300_000)}


def test_the_trace_written_is_the_trace_of_the_life(tmp_path, monkeypatch):
    # So small that it is written in several parts.
    monkeypatch.setattr(life_module, "SLICE", 400)
    path = tmp_path / "life.parquet"
    life = live_one(asked(trace=path), silent)
    alone = live(Mind(), World.abundant(), seed=2, life=1, record="all")
    assert alone.trace is not None
    assert life.lifespan > 400
    assert pq.read_table(path).to_pylist() == alone.trace.to_pylist()
    assert [each.name for each in tmp_path.iterdir()] == ["life.parquet"]


@pytest.mark.parametrize(
    ("name", "start"), [("a.svg", b"<?xml"), ("b.png", b"\x89PNG"), ("c.PNG", b"\x89PNG")]
)
def test_the_figure_is_of_the_kind_its_name_says(tmp_path, name, start):
    live_one(asked(steps=300, figure=tmp_path / name), silent)
    assert (tmp_path / name).read_bytes().startswith(start)
    assert [each.name for each in tmp_path.iterdir()] == [name]


def test_the_figure_of_a_life_in_parts_is_that_of_its_whole_trace(tmp_path, monkeypatch):
    monkeypatch.setattr(life_module, "SLICE", 400)
    life = live_one(asked(figure=tmp_path / "a.svg"), silent)
    whole = live(life.mind, life.world, seed=life.seed, life=life.index, record="all")
    whole.figure().savefig(tmp_path / "b.svg")
    drawn = [re.findall(r' d="(.*?)"', (tmp_path / f"{n}.svg").read_text(), re.S) for n in "ab"]
    assert life.lifespan > 400
    assert sorted(drawn[0]) == sorted(drawn[1])


def test_af_learns_first_if_it_knows_nothing(monkeypatch):
    monkeypatch.setattr(one_life, "LEARNING_STEPS", 5_000)
    told = []
    life = live_one(asked(Mind(agent="AF")), lambda *each: told.append(each))
    learner = live(Mind(agent="LEARNING"), World.abundant(), seed=2, life=1, steps=5_000)
    assert life.mind.networks == learner.networks
    assert life.mind.agent == "AF"
    assert {(task, total) for task, _, total in told} == {
        ("Learning first, steps", 5_000),
        ("Life, steps", 300_000),
    }


def test_the_story_tells_what_was_counted():
    life = live_one(asked(), silent)
    told = life.summary
    first, how, met, acted, end = story(life)
    assert first == "BLIND in abundant, physiology excess, seed 2, life 1"
    assert life.dead
    assert how == f"lived {life.lifespan:,} steps and died of {life.death}"
    assert met.startswith(f"met {told['encounters']} objects, disregarded {told['disregarded']},")
    assert acted.startswith(f"acted {told['acts']} times, {told['successes']} with success: eat ")
    values = life.state["values"]
    assert f"nutrition {values[0]:.3f}, stamina {values[1]:.3f}" in end


def test_the_story_of_a_learner_tells_what_it_learnt():
    life = live_one(asked(Mind(agent="LEARNING"), steps=1_000), silent)
    lines = story(life)
    assert lines[1] == "lived 1,000 steps and was alive at the cap"
    said = life.networks.likelihoods({"shape": 0.0, "size": 0.0})
    assert f"TS affords eat {said['eat']:.2f}, shelter {said['shelter']:.2f}" in lines[5]
    assert len(lines) == 5 + 4


@pytest.mark.parametrize("kind", ["trace", "figure", "record"])
def test_a_file_that_cannot_be_written_is_refused_before_any_work(tmp_path, monkeypatch, kind):
    monkeypatch.setattr(one_life, "birth", lambda *_, **__: pytest.fail("it was born"))
    end = "svg" if kind == "figure" else "parquet"
    (tmp_path / "file").touch()
    (tmp_path / f"there.{end}").touch()
    (tmp_path / f"directory.{end}").mkdir()
    for path, why in {
        tmp_path / "a.txt": "give a name that ends in",
        tmp_path / "none": "give a name that ends in",
        tmp_path / f"there.{end}": "is there already; --force replaces it",
        tmp_path / f"directory.{end}": "is a directory",
        tmp_path / "nowhere" / f"a.{end}": "there is no directory",
        tmp_path / "file" / f"a.{end}": "there is no directory",
        Path(f"/proc/a.{end}"): "cannot be written",
        tmp_path / ("a" * 249 + f".{end}"): "cannot be written: File name too long",
        tmp_path / ("a" * 300 + f".{end}"): "cannot be written: File name too long",
    }.items():
        with pytest.raises(SettingsError, match=why):
            live_one(asked(**{kind: path}), silent)
    with pytest.raises(SettingsError, match="is a directory"):
        live_one(asked(**{kind: tmp_path / f"directory.{end}"}, force=True), silent)
    assert len(list(tmp_path.iterdir())) == 3


def test_an_old_file_is_replaced_when_asked(tmp_path):
    path = tmp_path / "life.parquet"
    path.write_text("old")
    live_one(asked(steps=20, trace=path, force=True), silent)
    assert pq.read_table(path).num_rows == 20


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError(28, "No space left on device")])
def test_a_file_that_comes_to_nothing_leaves_the_old_one(tmp_path, monkeypatch, error):
    path = tmp_path / "life.parquet"
    path.write_text("old")
    write = pq.ParquetWriter.write_table

    def fails(self, table):
        write(self, table)
        raise error

    monkeypatch.setattr(pq.ParquetWriter, "write_table", fails)
    expected = RunError if isinstance(error, OSError) else error
    with pytest.raises(expected):
        live_one(asked(steps=20, trace=path, force=True), silent)
    assert path.read_text() == "old"
    assert [each.name for each in tmp_path.iterdir()] == ["life.parquet"]


@pytest.mark.parametrize(
    ("changes", "why"),
    [({"seed": -1}, "seed = -1"), ({"index": -1}, "life = -1"), ({"steps": 0}, "steps = 0")],
)
def test_what_cannot_be_lived_is_refused(changes, why):
    with pytest.raises(LifeError, match=why):
        live_one(asked(**changes), silent)


def test_the_recording_written_is_of_the_life(tmp_path):
    told = []
    path = tmp_path / "a.parquet"
    learner = Mind(agent="LEARNING")
    life = live_one(asked(learner, steps=2_500, record=path), lambda *each: told.append(each))
    alone = live(learner, World.abundant(), seed=2, life=1, steps=2_500, record="all")
    assert life.summary == alone.summary
    recording = Recording.load(path)
    assert alone.trace is not None
    assert recording.trace.to_pylist() == alone.trace.to_pylist()
    assert recording.head.every == EVERY
    assert recording.head.steps == 2_500
    assert recording.verify() is None
    assert sum(done for _, done, _ in told) == 2_500
    assert {"command", "made", "versions"} <= recording.head.made.keys()
    live_one(asked(learner, steps=50, record=path, every=9, force=True), silent)
    assert Recording.load(path).head.every == 9


def test_a_recorded_life_goes_on(tmp_path):
    old, new, trace = (tmp_path / f"{name}.parquet" for name in ("old", "new", "trace"))
    learner = Mind(agent="LEARNING")
    live_one(asked(learner, steps=600, record=old, every=70), silent)
    told = []
    # What the recording says counts, whatever else is asked.
    life = live_one(
        asked(seed=9, index=9, steps=900, source=old, at=333, record=new, trace=trace),
        lambda *each: told.append(each),
    )
    whole = live(learner, World.abundant(), seed=2, life=1, steps=900, record="all")
    assert life.summary == whole.summary
    assert whole.trace is not None
    assert pq.read_table(trace).to_pylist() == whole.trace.slice(333).to_pylist()
    assert Recording.load(new).trace.to_pylist() == whole.trace.slice(333).to_pylist()
    assert sum(done for _, done, _ in told) == 900 - 333
    assert {total for *_, total in told} == {900 - 333}

    assert live_one(asked(source=old, steps=900), silent).summary == whole.summary
    assert live_one(asked(source=old, at=0), silent).lifespan == 600


def test_the_figure_of_a_life_that_goes_on_begins_there(tmp_path, monkeypatch):
    live_one(asked(Mind(agent="LEARNING"), steps=300, record=tmp_path / "a.parquet"), silent)
    drawn = []
    draw = drawing.draw_life
    monkeypatch.setattr(
        drawing, "draw_life", lambda *given: drawn.append(given[-1]) or draw(*given)
    )
    live_one(asked(source=tmp_path / "a.parquet", at=120, figure=tmp_path / "a.svg"), silent)
    assert drawn == [(120, 300)]


def test_where_a_life_cannot_go_on_is_told(tmp_path):
    path = tmp_path / "a.parquet"
    mortal = Mind(variables={"stamina": {"start": 0.97}})
    end = live_one(asked(mortal, record=path), silent).lifespan
    for further, why in {
        ("at", end): f"the life ended at step {end}; go on from before, --at",
        ("at", None): f"the life ended at step {end}",
        ("at", end + 1): f"step {end + 1} is not recorded, only 0 to {end} are",
        ("at", -1): "step = -1; allowed are whole numbers from 0",
    }.items():
        with pytest.raises(SettingsError, match=why):
            live_one(asked(source=path, **dict([further])), silent)
    for steps in (-1, 0, 9, 10):
        with pytest.raises(LifeError, match=f"steps = {steps}: the life has lived 10 steps"):
            live_one(asked(source=path, at=10, steps=steps), silent)
    with pytest.raises(SettingsError, match="no such file"):
        live_one(asked(source=tmp_path / "none.parquet"), silent)


def test_one_file_cannot_be_both_trace_and_recording(tmp_path):
    path = tmp_path / "a.parquet"
    with pytest.raises(SettingsError, match="is to be both trace and recording; give two names"):
        live_one(asked(trace=path, record=tmp_path / "." / "a.parquet"), silent)


def test_a_life_is_recorded_from_python(tmp_path):
    world = World.abundant()
    mind = Mind(agent="LEARNING")
    told = []
    path = tmp_path / "a.parquet"
    life = animat.record(
        mind, world, str(path), seed=3, life=4, steps=700, every=80, progress=told.append
    )
    assert life.summary == live(mind, world, seed=3, life=4, steps=700).summary
    assert sum(told) == 700
    recording = animat.Recording.load(str(path))
    assert recording.verify() is None
    later = recording.at(350).live(steps=900, record="last:20")
    whole = live(mind, world, seed=3, life=4, steps=900, record="last:20")
    assert later.summary == whole.summary
    assert later.trace is not None
    assert whole.trace is not None
    assert later.trace.to_pylist() == whole.trace.to_pylist()
    assert recording.at(350).live(steps=360, record="last:20").trace.num_rows == 10
    with pytest.raises(LifeError, match="steps = 0"):
        animat.record(mind, world, path, steps=0)


LATE = """
def late(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    memory[0] += 1.0
    memory[int(memory[0] / 500.0)] += 0.0
    return speed, speed
"""


def test_checked_functions_are_found_where_the_trial_before_a_life_cannot(
    tmp_path, monkeypatch, capsys
):
    """The index leaves the memory after 2,000 steps of searching."""
    (tmp_path / "late.py").write_text(LATE)
    (tmp_path / "late.toml").write_text('[mind]\ndeath = false\nwander = "late.py:late"\n')
    monkeypatch.chdir(tmp_path)
    command = ["animat", "life", "--settings", "late.toml", "--steps", "20000", "--check-functions"]
    monkeypatch.setattr("sys.argv", command)
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 1
    (line,) = [one for one in capsys.readouterr().err.splitlines() if one.startswith("animat: ")]
    assert "wander: late raised IndexError: index is out of bounds, in step " in line


def test_what_a_custom_estimator_says_is_told_and_nothing_else():
    """At the end of a life that learns, of every object type."""

    def sure(features, weights, hidden):
        return 0.25

    mind = Mind(agent="LEARNING", learning={"estimator": sure})
    lines = story(live(mind, World.abundant(), steps=300))
    affords = [line for line in lines if " affords " in line]
    assert len(affords) == 4
    assert all(line.count("0.25") == 3 for line in affords)

"""What a results directory says of itself: read, compared with a study, written anew."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from animat.files.settings import SettingsError
from animat.study.execute.verify import verify
from animat.study.plan.plan import plan_of
from animat.study.store import manifest as description
from animat.study.store.manifest import changed_inputs, differences_from, read_manifest
from animat.study.store.results import Results
from animat.study.store.store import open_store


def telling(task: str, done: int, total: int, note: str = "") -> None:
    """Tell nobody."""


@pytest.fixture
def copied(finished, tmp_path):
    return shutil.copytree(finished, tmp_path / "results")


def changed(plan, old, new):
    assert old in plan.text
    return plan_of(plan.text.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("steps = 150", "steps = 160", "steps = 150 there and 160 here"),
        ("robots = 3", "robots = 4", "teacher.robots = 3 there and 4 here"),
        ('"LEARNING", "AF"', '"AF", "LEARNING"', 'design.grid."mind.agent" = '),
        ('agent = "BLIND"', 'agent = "RANDOM"', 'mind.agent = "BLIND" there and "RANDOM" here'),
    ],
)
def test_another_study_is_refused_with_the_difference(small, copied, faults, old, new, line):
    before = faults.told_of(copied)
    with pytest.raises(SettingsError) as refused, open_store(copied, changed(small, old, new)):
        pytest.fail("it is open")
    first, last = refused.value.problems
    assert line in first
    assert "--out gives this study a directory of its own" in last
    assert faults.told_of(copied) == before
    assert len(read_manifest(copied)["runs"]) == 1


def test_factors_in_another_order_are_another_study(faults, tmp_path):
    text = (
        'name = "order"\nlives = 1\nsteps = 5\n[design.grid]\n'
        '"mind.gate" = ["positive", "always"]\n"mind.error" = ["signed", "absolute"]\n'
    )
    lines = text.splitlines(keepends=True)
    other = "".join([*lines[:-2], lines[-1], lines[-2]])
    faults.go_on(faults.plan(text), tmp_path / "results")
    found = differences_from(tmp_path / "results", faults.plan(other))
    assert found == ["has its factors in another order"]


def test_another_engine_is_refused(small, copied, monkeypatch):
    monkeypatch.setattr(description, "ENGINE", 999)
    (line,) = differences_from(copied, small)
    assert line == f"was lived by engine {read_manifest(copied)['engine']}, and this is engine 999"


def test_a_file_that_has_changed_is_refused_and_its_copy_kept(faults, tmp_path, lost):
    own = tmp_path / "own.py"
    own.write_text(lost)
    text = f'name = "own"\nlives = 1\nsteps = 5\n[mind]\nwander = "{own}:walk"\n'
    directory = tmp_path / "results"
    faults.go_on(faults.plan(text), directory)
    assert "u_b * 3.0" in lost
    own.write_text(lost.replace("u_b * 3.0", "u_b * 2.0"))
    (line,) = differences_from(directory, faults.plan(text + "# read again\n"))
    assert line == f"{own} has changed since; as it was it is in {directory / 'inputs'}"
    assert verify(Results(directory), telling).problems == [line]
    copy = directory / "inputs" / "outside" / own.relative_to("/")
    assert copy.read_text() == lost
    own.unlink()
    gone = f"{own} is not there any more; as it was it is in {directory / 'inputs'}"
    assert differences_from(directory, faults.plan(text)) == [gone]
    assert verify(Results(directory), telling).problems == [gone]
    shutil.copy(copy, own)
    assert differences_from(directory, faults.plan(text)) == []


WALK = """
def walk(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    return speed, speed - {number}
"""


def test_a_study_can_be_run_again_where_the_copies_are(faults, tmp_path, monkeypatch):
    """With all that its functions import, and with another neighbour of the same name elsewhere."""
    text = 'name = "own"\nlives = 1\nsteps = 5\n[design.grid]\n"mind.wander" = ["{a}", "{b}"]\n'
    text = text.format(a="a/own.py:walk", b=f"{tmp_path}/b/own.py:walk")
    own = "from pkg import helper\nimport util\n" + WALK.format(number="util.K * helper.K")
    for folder, number in (("a", 1), ("b", 2)):
        (tmp_path / folder / "pkg").mkdir(parents=True)
        (tmp_path / folder / "own.py").write_text(own)
        (tmp_path / folder / "util.py").write_text(f"K = {number}\n")
        (tmp_path / folder / "pkg" / "helper.py").write_text(f"K = {number}\n")
    monkeypatch.chdir(tmp_path)
    plan = faults.plan(text)
    assert len(set(plan.identities)) == 2
    description.begin(tmp_path, plan)
    inputs = tmp_path / "inputs"
    names = ["own.py", "pkg/helper.py", "util.py"]
    outside = Path("outside", *tmp_path.parts[1:])
    there = {str(path.relative_to(inputs)) for path in inputs.rglob("*.py")}
    assert there == {*(f"a/{name}" for name in names), *(f"{outside}/b/{name}" for name in names)}
    (tmp_path / "a" / "util.py").write_text("K = 3\n")
    assert differences_from(tmp_path, plan) == [
        f"a/util.py has changed since; as it was it is in {inputs}"
    ]
    monkeypatch.chdir(inputs)
    again = text.replace(f"{tmp_path}/b", f"{outside}/b")
    assert faults.plan(again).identities == plan.identities


def test_a_file_that_is_gone_is_told_of_with_the_folder_it_was_looked_for_in(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (line,) = changed_inputs(Path("results"), {"inputs": {"mine.py": "0"}})
    assert line == (
        f"mine.py is not there any more (looked for in {tmp_path});"
        " as it was it is in results/inputs"
    )


def test_lives_that_became_others_for_reasons_unknown_are_refused(small, copied):
    cases = small.case_table()
    other = cases.set_column(cases.schema.get_field_index("identity"), "identity", [["a", "b"]])
    pq.write_table(other, copied / "cases.parquet")
    (line,) = differences_from(copied, small)
    assert line.startswith("its lives are not those that are lived now of the same study")


@pytest.mark.parametrize(
    "text",
    ['{"study": ', "", "[]", "{}", "7", "null", '{"engine": 1}', "[" * 9_000, "\x00" * 99],
)
def test_a_torn_manifest_is_told(small, copied, text):
    (copied / "manifest.json").write_text(text)
    for read in (Results, lambda directory: open_store(directory, small).__enter__()):
        with pytest.raises(SettingsError, match=r"has no whole manifest\.json; without that file"):
            read(copied)
    assert (copied / "manifest.json").read_text() == text


@pytest.mark.parametrize("key", ["study", "hash", "engine", "lives", "teachers", "inputs", "runs"])
@pytest.mark.parametrize("value", [None, [], {"places": 1}, -1.5])
def test_a_manifest_in_which_something_is_none_is_told(copied, key, value):
    manifest = read_manifest(copied)
    manifest[key] = value
    (copied / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(SettingsError, match="has no whole manifest"):
        Results(copied)


@pytest.mark.parametrize("how", ["lost", "torn", "strange"])
@pytest.mark.parametrize(
    "name",
    ["study.toml", "cases.parquet", "lives/_common_metadata", "teachers/_common_metadata"],
)
def test_what_is_lost_is_told_and_written_anew(small, copied, faults, name, how):
    before = faults.told_of(copied)
    path = copied / name
    was = path.read_bytes()
    path.unlink()
    if how == "torn":
        path.write_bytes(was[:-7])
    elif how == "strange":
        path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SettingsError, match=r"animat run with the same study writes it anew"):
        read_all(Results(copied))
    with open_store(copied, small):
        assert path.read_bytes() == was
    read_all(Results(copied))
    assert faults.told_of(copied) == before


def read_all(results):
    return results.study, results.lives(), results.teachers(), results.failures(1)


@pytest.mark.parametrize("lost", ["manifest.json", "teachers", "lives", "cases.parquet"])
def test_a_run_makes_good_what_is_lost(small, finished, copied, faults, lost):
    path = copied / lost
    shutil.rmtree(path) if path.is_dir() else path.unlink()
    faults.go_on(small, copied)
    assert faults.told_of(copied) == faults.told_of(finished)


@pytest.mark.parametrize("lost", [["manifest.json"], ["manifest.json", "study.toml"]])
def test_lives_without_a_manifest_are_of_no_other_study(small, copied, faults, lost):
    for name in lost:
        (copied / name).unlink()
    before = faults.told_of(copied)
    with pytest.raises(SettingsError) as refused:
        open_store(copied, changed(small, "steps = 150", "steps = 160")).__enter__()
    known = "study.toml" not in lost
    why = "steps = 150 there and 160 here" if known else "study.toml does not tell any more"
    assert why in refused.value.problems[0]
    assert faults.told_of(copied) == before
    assert not (copied / "manifest.json").exists()


def test_what_was_begun_with_another_study_and_has_no_lives_yet_is_no_hindrance(small, tmp_path):
    (tmp_path / "study.toml").write_text("name = 'other'")
    with open_store(tmp_path, small):
        assert (tmp_path / "study.toml").read_text() == small.text


def test_a_study_file_that_was_changed_in_its_place_is_another_study(small, copied, faults):
    path = copied / "study.toml"
    path.write_text(path.read_text().replace("lives = 8", "lives = 9"))
    before = faults.told_of(copied)
    with pytest.raises(SettingsError, match=r"study\.toml does not tell any more which it was"):
        open_store(copied, plan_of(path.read_text())).__enter__()
    assert faults.told_of(copied) == before


def test_lives_that_are_numbered_otherwise_are_refused(small, copied):
    manifest = read_manifest(copied)
    manifest["lives"]["in_a_part"] += 1
    (copied / "manifest.json").write_text(json.dumps(manifest))
    (line,) = differences_from(copied, small)
    assert line.startswith("its lives are not those that are lived now of the same study")

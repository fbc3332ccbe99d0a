"""Whatever changes in a results directory is found, and so is what was wrong from the beginning."""

from __future__ import annotations

import shutil

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from animat.study.execute import verify as module
from animat.study.execute.verify import verify
from animat.study.plan.numbering import Part
from animat.study.plan.shard import RUN_AGAIN, part_identity, shard_file, shard_header
from animat.study.store.results import Results

FILES = [
    "lives/part-000000",
    "lives/part-000001",
    "teachers/part-000000",
    "curves/lives-000000",
    "curves/teachers-000000",
    "traces/part-000001",
]


@pytest.fixture
def copied(finished, tmp_path):
    return shutil.copytree(finished, tmp_path / "results")


def looked(directory):
    return verify(Results(directory), lambda *_, **__: None)


def changed(table):
    """A table with one number changed by the least there is."""
    for n, field in enumerate(table.schema):
        if pa.types.is_floating(field.type) and table.column(n).null_count == 0:
            values = table.column(n).to_numpy().copy()
            values[2] = np.nextafter(values[2], 2.0)
            return table.set_column(n, field, pa.array(values))
    raise AssertionError


def test_what_is_as_it_was_is_told_to_be(finished):
    told = []
    found = verify(Results(finished), lambda *each: told.append(each))
    assert found == (3, 3, 3, [])
    assert told.count(("Parts read", 1, 3)) == told.count(("Lives lived again", 1, 3)) == 3


@pytest.mark.parametrize("file", FILES)
def test_a_number_that_has_changed_is_found(copied, file):
    path = copied / f"{file}.parquet"
    metadata = pq.read_metadata(path).metadata
    table = changed(pq.read_table(path))
    assert metadata is not None
    pq.write_table(table.replace_schema_metadata(metadata), path)
    (problem,) = looked(copied).problems
    assert problem.startswith(f"{path}: is altered")
    assert problem.endswith(RUN_AGAIN)


@pytest.mark.parametrize("file", FILES)
def test_a_bit_that_has_changed_is_found(copied, file):
    path = copied / f"{file}.parquet"
    whole = path.read_bytes()
    for place in np.linspace(4, len(whole) - 9, 12).astype(int):
        content = bytearray(whole)
        content[place] ^= 0x10
        path.write_bytes(content)
        found = looked(copied).problems
        assert found
        assert all(str(path) in problem or "missing" in problem for problem in found)


@pytest.mark.parametrize("file", FILES)
def test_a_torn_file_is_found(copied, file):
    path = copied / f"{file}.parquet"
    path.write_bytes(path.read_bytes()[:-5])
    problems = looked(copied).problems
    assert problems[0].startswith(f"{path}: is cut short")


def test_a_lost_file_is_found_where_its_part_is_finished(copied):
    (copied / "traces" / "part-000000.parquet").unlink()
    (problem,) = looked(copied).problems
    assert problem == f"{copied / 'traces' / 'part-000000.parquet'}: is missing"


def test_a_part_that_is_not_finished_is_no_problem(copied):
    (copied / "lives" / "part-000000.parquet").unlink()
    found = looked(copied)
    assert (found.parts, found.all_parts, found.problems) == (2, 3, [])


def test_lives_whose_teachers_are_lost_are_told_of_and_not_lived_again(copied):
    path = copied / "teachers" / "part-000000.parquet"
    path.unlink()
    assert looked(copied) == (2, 3, 1, [f"{path}: is missing, and lives were taught by it"])
    path.write_bytes(b"torn")
    assert looked(copied) == (
        2,
        3,
        1,
        [f"{path}: is no table of results: it does not begin like one; {RUN_AGAIN}"],
    )


def test_a_part_in_the_place_of_another_is_found(copied):
    path = copied / "lives" / "part-000001.parquet"
    shutil.copy(copied / "lives" / "part-000000.parquet", path)
    (problem,) = looked(copied).problems
    assert problem.startswith(f"{path}: holds the lives of another part or study")


def test_what_was_wrong_when_it_was_written_is_found_by_living_again(copied, small):
    path = copied / "lives" / "part-000000.parquet"
    said, table = shard_header(path), pq.read_table(path)
    for name in ("lifespan", "weights", "likelihood_eat_TS"):
        n = table.schema.get_field_index(name)
        turned = table.set_column(n, name, table.column(n).take(list(range(7, -1, -1))))
        identity = part_identity(small, Part("lives", 0))
        path.write_bytes(shard_file([turned], turned.schema, identity, said.steps, said.failed))
        problems = looked(copied).problems
        wrong = f"{path}: row 0 is another when it is lived again, in {name}"
        # All were alive at the cap.
        assert problems == ([] if name == "lifespan" else [wrong])


def test_lives_of_all_parts_are_lived_again_where_there_are_few(finished, monkeypatch):
    assert looked(finished).lives == 3
    monkeypatch.setattr(module, "SAMPLE", 1)
    assert looked(finished).lives == 2


def test_a_study_or_cases_that_have_changed_are_found(copied):
    study = copied / "study.toml"
    text = study.read_text()
    study.write_text(text.replace("seed = 0", "seed = 1"))
    (problem,) = looked(copied).problems
    assert problem.startswith(f"{study}: has changed since")
    study.write_text(text)
    cases = copied / "cases.parquet"
    pq.write_table(pq.read_table(cases).drop_columns("mind.agent"), cases)
    assert looked(copied).problems == [f"{cases}: has other cases than the study"]


def test_lives_of_another_engine_cannot_be_lived_again(finished, monkeypatch):
    monkeypatch.setattr(module, "ENGINE", 999)
    (problem,) = looked(finished).problems
    assert "this is engine 999" in problem


def test_what_tells_of_the_study_is_looked_at(copied):
    columns = copied / "lives" / "_common_metadata"
    shutil.copy(copied / "teachers" / "_common_metadata", columns)
    (problem,) = looked(copied).problems
    assert problem.startswith(f"{columns}: has other columns than the study; animat run")
    columns.unlink()
    (problem,) = looked(copied).problems
    assert problem.startswith(f"{columns}: is missing or torn; animat run")


def test_lives_that_are_others_now_are_told_of(copied):
    cases = pq.read_table(copied / "cases.parquet")
    other = cases.set_column(cases.schema.get_field_index("identity"), "identity", [["a", "b"]])
    pq.write_table(other, copied / "cases.parquet")
    (problem,) = looked(copied).problems
    assert problem.startswith(f"{copied}: its lives are not those that are lived now")


def test_a_copy_of_a_file_that_is_none_any_more_is_found(faults, tmp_path, lost):
    own = tmp_path / "own.py"
    own.write_text(lost)
    plan = faults.plan(f'name = "own"\nlives = 1\nsteps = 5\n[mind]\nwander = "{own}:walk"\n')
    faults.go_on(plan, tmp_path / "results")
    assert looked(tmp_path / "results").problems == []
    copy = tmp_path / "results" / "inputs" / "outside" / own.relative_to("/")
    copy.write_text("")
    assert looked(tmp_path / "results").problems == [
        f"{copy}: is no copy of {own} any more; animat run with the same study writes it anew"
    ]


@pytest.mark.parametrize("name", ["part-000002.parquet", "part-00.parquet", "part-x.parquet", "a"])
def test_a_file_of_nobody_is_found(copied, name):
    path = copied / "lives" / name
    shutil.copy(copied / "lives" / "part-000000.parquet", path)
    assert looked(copied) == (3, 3, 3, [f"{path}: is none of the files of the study"])

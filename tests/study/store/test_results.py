"""Results read: every life under every case that has it, lazily, also while a study runs."""

from __future__ import annotations

import shutil

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest

import animat.study
from animat.files.settings import SettingsError
from animat.study.store.results import Results

SHARED = """
name = "shared"
lives = 20
steps = 1500
[design.grid]
"mind.agent" = ["BLIND", "ORACLE"]
"mind.likelihood_threshold" = [0.5, 0.8]
"""


@pytest.fixture(scope="module")
def shared(faults, tmp_path_factory):
    """Results in which one case has the lives of another."""
    directory = tmp_path_factory.mktemp("shared") / "results"
    faults.go_on(faults.plan(SHARED), directory)
    return animat.study.open(directory)


def test_every_case_has_its_lives_with_its_factors(shared):
    assert shared.cases["same_as"].to_pylist() == [0, 0, 2, 3]
    assert shared.dataset().count_rows() == 60
    lives = shared.lives()
    assert lives.num_rows == 80
    assert lives.column_names[:3] == ["case", "mind.agent", "mind.likelihood_threshold"]
    rows = lives.to_pylist()
    assert [(row["case"], row["life"]) for row in rows] == [
        (case, life) for case in range(4) for life in range(20)
    ]
    for row in rows:
        factors = shared.cases.to_pylist()[row["case"]]
        assert all(row[name] == factors[name] for name in shared.factors)
        assert row["agent"] == row["mind.agent"]
    own = [{k: v for k, v in row.items() if k not in {"case", *shared.factors}} for row in rows]
    assert own[:20] == own[20:40]
    assert own[20:40] != own[40:60]


def test_columns_and_rows_are_those_asked_for(shared):
    whole = shared.lives()
    some = shared.lives(["lifespan", "mind.agent"])
    assert some.equals(whole.select(["lifespan", "mind.agent"]))
    long_ones = (pc.field("mind.agent") == "BLIND") & (pc.field("lifespan") > 1_300)
    chosen = shared.lives(["case", "life"], where=long_ones)
    assert chosen.to_pylist() == whole.filter(long_ones).select(["case", "life"]).to_pylist()
    assert 0 < chosen.num_rows < 40
    assert shared.lives(where=pc.field("lifespan") < 0).num_rows == 0
    with pytest.raises(SettingsError, match='no column "lifespn"; did you mean "lifespan"'):
        shared.lives(["lifespn"])


def test_pandas_has_the_same(shared):
    frame = shared.to_pandas()
    assert frame["lifespan"].tolist() == shared.lives()["lifespan"].to_pylist()
    assert list(frame.columns) == shared.lives().column_names


def test_what_is_finished_can_be_read_and_the_rest_not_yet(finished, tmp_path):
    directory = shutil.copytree(finished, tmp_path / "results")
    whole = Results(directory)
    assert whole.progress == (16, 16)
    assert whole.tally().complete
    all_lives = whole.lives()
    (directory / "lives" / "part-000000.parquet").unlink()
    (directory / "lives" / ".part-000000.parquet.9.part").write_bytes(b"half")
    part = Results(directory)
    assert part.progress == (8, 16)
    assert part.lives().to_pylist() == all_lives.to_pylist()[8:]
    (directory / "lives" / "part-000001.parquet").unlink()
    none = Results(directory)
    assert none.progress == (0, 16)
    assert none.lives().schema.equals(all_lives.schema)
    assert none.lives().num_rows == 0
    assert none.teachers().num_rows == 3


def test_a_study_without_teachers_curves_and_traces_has_empty_tables(shared):
    for table in (shared.teachers(), shared.curves(), shared.traces()):
        assert isinstance(table, pa.Table)
        assert table.num_rows == 0


def test_curves_and_traces_are_there(finished):
    results = Results(finished)
    assert set(results.curves()["life"].to_pylist()) == set(range(8))
    assert set(results.curves("teachers")["robot"].to_pylist()) == set(range(3))
    traces = results.traces()
    assert set(zip(traces["case"].to_pylist(), traces["life"].to_pylist(), strict=True)) == {
        (0, 0),
        (1, 0),
    }


def test_the_study_is_the_study(small, finished):
    assert Results(finished).study.to_toml() == small.text
    assert Results(finished).steps_to_learn == small.steps_to_learn
    assert Results(finished).numbering == small.numbering


def test_nothing_is_no_results(tmp_path):
    with pytest.raises(SettingsError, match=r"is no results directory: it has no manifest\.json"):
        animat.study.open(tmp_path)
    with pytest.raises(SettingsError, match="none: no such directory"):
        animat.study.open(tmp_path / "none")


@pytest.mark.parametrize(
    "name",
    [
        *("part-000002", "part-999999", "part-00", "part-0000000", "part-x", "part-000000 (copy)"),
        "x",
    ],
)
def test_what_only_looks_like_a_part_is_none(finished, tmp_path, name):
    directory = shutil.copytree(finished, tmp_path / "results")
    shutil.copy(directory / "lives/part-000000.parquet", directory / f"lives/{name}.parquet")
    results = Results(directory)
    assert results.progress == (16, 16)
    assert results.tally().complete
    assert results.lives().equals(Results(finished).lives())


def test_a_torn_part_is_not_counted_and_not_read(finished, tmp_path):
    directory = shutil.copytree(finished, tmp_path / "results")
    path = directory / "lives" / "part-000000.parquet"
    shutil.copy(directory / "teachers" / "part-000000.parquet", path)
    assert Results(directory).progress == (8, 16)  # of other lives than it should be
    path.write_bytes(path.read_bytes()[:-9])
    results = Results(directory)
    assert results.progress == (8, 16)
    with pytest.raises(SettingsError, match=r"part-000000\.parquet: is cut short"):
        results.lives()


def test_a_file_that_cannot_be_read_to_its_end_is_told_of(finished, tmp_path):
    directory = shutil.copytree(finished, tmp_path / "results")
    for name in ("lives", "teachers", "traces", "curves"):
        (path, *_) = sorted((directory / name).glob("*-000000.parquet"))
        content = bytearray(path.read_bytes())
        content[4:900] = bytes(896)
        path.write_bytes(content)
    results = Results(directory)
    assert results.progress == (16, 16)
    for read in (results.lives, results.teachers, results.traces, results.curves):
        with pytest.raises(SettingsError, match=r"-000000\.parquet: is (altered|damaged)"):
            read()


WRONG = [
    None, True, -1, 0, 1.5, 10**30, "", "nope", b"case", [1], ["nope"], [None], {"nope"}, {1, "a"},
    {}, object(), np.array(["case"]), pc.field("nope") > 1, pc.field("lifespan") > "x",
]  # fmt: skip


@pytest.mark.parametrize(
    ("method", "argument"),
    [
        ("dataset", "kind"),
        ("lives", "columns"),
        ("lives", "where"),
        ("batches", "columns"),
        ("curves", "kind"),
        ("failures", "count"),
    ],
)
def test_whatever_is_wrong_is_refused_in_one_line(shared, method, argument):
    refused = 0
    for value in WRONG:
        try:
            found = getattr(shared, method)(**{argument: value})
            if method == "batches":
                list(found)
        except animat.Error as error:
            refused += all(error.problems)
    assert refused >= 12


def test_the_name_of_a_directory_is_no_column(finished, tmp_path):
    directory = shutil.copytree(finished, tmp_path / "lifespan=1")
    results, same = Results(directory), Results(finished)
    assert results.lives().equals(same.lives())
    assert results.cases.equals(same.cases)
    assert results.curves().equals(same.curves())

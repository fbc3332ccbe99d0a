import shutil

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from animat.experiments import judging as module
from animat.experiments.judging import judge
from animat.files.settings import validated
from animat.statistics import paper_claims
from animat.statistics.claims import CELLS, CLAIMS, EFFECTS
from animat.statistics.lives import column
from animat.study.execute.run import run, threads
from animat.study.file.study import Study
from animat.study.plan.plan import Plan
from animat.study.plan.shard import shard_file, shard_header
from animat.study.store.results import open as open_results


@pytest.fixture(scope="module")
def plan(small) -> Plan:
    return Plan(small)


@pytest.fixture(scope="module")
def results(lived):
    return open_results(lived.directory / "universes")


@pytest.fixture(scope="module")
def judged(plan, results):
    return judge(plan, results, resamples=99)


def test_every_universe_is_judged_by_its_own_lives_and_teachers(plan, results, judged):
    """The oracle: the claims of a reproduction, from what the results say of the cases."""
    lives = results.lives()
    teachers = results.teachers()
    assert judged.missing == 0
    assert judged.table.num_rows == len(judged.universes.values) == len(plan.cases) / 4
    for row, cases in zip(judged.table.to_pylist(), judged.universes.cases, strict=True):
        cells = []
        for (world, agent), case in zip(CELLS, cases, strict=True):
            rows = lives.filter(pc.field("case") == int(case))
            names = {"world": world, "agent": agent}
            rows = rows.select([n for n in rows.column_names if n not in names])
            for name, value in names.items():
                rows = rows.append_column(name, pa.array([value] * rows.num_rows))
            cells.append(rows)
            spans = column(rows, "lifespan")
            assert row[f"mean_{world}_{agent}"] == pytest.approx(spans.mean())
        taught = plan.classes[plan.class_of(plan.lived.index(plan.cases[cases[1]]))]
        rows = teachers.filter(pc.field("identity") == taught.identity).to_pylist()
        told = [
            {"seed": one["robot"], "network": network, "object": thing, "afforded": afforded,
             "likelihood": one[f"likelihood_{network}_{thing}"]}
            for one in rows
            for network in ("eat", "shelter", "interact")
            for thing, afforded in (("TS", network == "eat"), ("CS", network == "eat"),
                                    ("TL", network == "shelter"), ("CL", network == "shelter"))
        ]  # fmt: skip
        claims = paper_claims.judge(
            pa.concat_tables(cells), pa.Table.from_pylist(told), resamples=99
        )
        assert row["learning_error"] == pytest.approx(claims[-1].ours)
        assert {name: row[name] for name in CLAIMS} == {one.id: one.verdict for one in claims}


def test_the_table_has_the_readings_then_what_is_told(judged):
    names = judged.table.column_names
    readings = list(judged.universes.names())
    assert names[: 1 + len(readings)] == ["universe", *readings]
    assert {*EFFECTS, *CLAIMS} <= set(names)
    assert column(judged.deaths, "lives").sum() == judged.table.num_rows * 4 * 3


def test_how_many_are_read_at_a_time_does_not_show(plan, results, judged, monkeypatch):
    monkeypatch.setattr(module, "AT_A_TIME", 3)
    counted = []
    again = judge(plan, results, resamples=99, tell=counted.append)
    assert again.table.equals(judged.table)
    assert again.deaths.equals(judged.deaths)
    assert sum(counted) == judged.table.num_rows
    assert max(counted) == 3


def test_universes_whose_lives_or_robots_failed_are_left_out(plan, lived, judged, tmp_path):
    directory = tmp_path / "universes"
    shutil.copytree(lived.directory / "universes", directory)
    case = fail_one(directory / "lives", 0)["case"]
    identity = fail_one(directory / "teachers", -1)["identity"]
    classes = [one.identity for one in plan.classes]
    taught = [
        plan.class_of(plan.lived.index(plan.cases[cases[1]])) for cases in judged.universes.cases
    ]
    hit = {u for u, cases in enumerate(judged.universes.cases) if case in cases}
    hit |= {u for u, place in enumerate(taught) if classes[place] == identity}
    again = judge(plan, open_results(directory), resamples=99)
    assert again.missing == len(hit) > 0
    assert not hit & set(column(again.table, "universe").tolist())
    assert again.table.num_rows == judged.table.num_rows - len(hit)


def fail_one(folder, place):
    """Let the first or the last row (0 or -1) of a folder's tables be of a life that failed."""
    file = sorted(folder.glob("part-*.parquet"))[place]
    errors: list[str | None] = [None] * pq.read_metadata(file).num_rows
    errors[place] = "a robot broke"
    return with_errors(file, errors).to_pylist()[place]


def with_errors(file, errors):
    """Write a part anew, with these errors, and return the rows it had."""
    rows, said = pq.read_table(file), shard_header(file)
    place = rows.schema.get_field_index("error")
    failed = rows.set_column(place, "error", pa.array(errors, pa.string()))
    how_many = sum(error is not None for error in errors)
    file.write_bytes(shard_file([failed], rows.schema, said.identity, said.steps, how_many))
    return rows


def test_universes_that_share_their_lives_have_them_each(small, tmp_path):
    """Where no law has a margin, the margin changes nothing, and such lives are lived once."""
    data = small.model_dump(mode="json", exclude_none=True)
    data["design"]["sample"] |= {
        "points": 4,
        "over": {
            "mind.physiology": ["excess", "linear"],
            "mind.lethal_margin": [0.05, 0.01],
        },
    }
    data["design"]["exclude"] = []
    for world, layout in (("rich", "abundant"), ("poor", "scarce")):
        data["worlds"][world] = {"layout": layout}
    plan = Plan(validated(data, Study))
    assert len(plan.lived) < len(plan.cases)
    with threads(2) as workers:
        run(plan, tmp_path, workers, lambda *_, **__: None)
    results = open_results(tmp_path)
    judged = judge(plan, results, resamples=99)
    lives = results.lives(["case", "lifespan"]).to_pandas()
    mean = lives.groupby("case").lifespan.mean()
    assert judged.table.num_rows == len(judged.universes.values) > 0
    for row, cases in zip(judged.table.to_pylist(), judged.universes.cases, strict=True):
        for (world, agent), case in zip(CELLS, cases, strict=True):
            assert row[f"mean_{world}_{agent}"] == pytest.approx(mean[case])


def test_of_nothing_finished_nothing_is_judged(plan, lived, tmp_path):
    directory = tmp_path / "universes"
    shutil.copytree(lived.directory / "universes", directory)
    for file in directory.glob("lives/part-*.parquet"):
        file.unlink()
    none = judge(plan, open_results(directory))
    assert none.table.num_rows == 0
    assert none.missing == len(none.universes.values)


def test_where_a_robot_of_every_class_failed_nothing_is_judged(plan, lived, tmp_path):
    directory = tmp_path / "universes"
    shutil.copytree(lived.directory / "universes", directory)
    for file in (directory / "teachers").glob("part-*.parquet"):
        with_errors(file, ["a robot broke"] * pq.read_metadata(file).num_rows)
    none = judge(plan, open_results(directory))
    assert none.table.num_rows == 0
    assert none.missing == len(none.universes.values)

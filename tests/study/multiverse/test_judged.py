import shutil

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from animat.report.claims import judge_learning, judge_lifespans
from animat.report.lives import column
from animat.report.multiverse.universes import CELLS, CLAIMS, EFFECTS
from animat.study.multiverse import judged as module
from animat.study.multiverse.judged import judge
from animat.study.plan import Plan
from animat.study.results import open as open_results


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
        for claim in judge_lifespans(pa.concat_tables(cells), resamples=99):
            assert row[claim.id] == claim.verdict
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
        learning = judge_learning(pa.Table.from_pylist(told), resamples=99)
        assert row["learning_error"] == pytest.approx(learning.ours)
        assert row["C7"] == learning.verdict


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
    case = fail_first(directory / "lives")["case"]
    identity = fail_first(directory / "teachers")["identity"]
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


def fail_first(folder):
    """Let the first row of the tables of a folder be that of a life that failed; return it."""
    file = min(folder.glob("part-*.parquet"))
    rows = pq.read_table(file)
    errors = pa.array(["a robot broke", *[None] * (rows.num_rows - 1)], pa.string())
    place = rows.schema.get_field_index("error")
    pq.write_table(rows.set_column(place, "error", errors), file)
    return rows.slice(0, 1).to_pylist()[0]


def test_of_nothing_finished_nothing_is_judged(plan, lived, tmp_path):
    directory = tmp_path / "universes"
    shutil.copytree(lived.directory / "universes", directory)
    for file in directory.glob("lives/part-*.parquet"):
        file.unlink()
    none = judge(plan, open_results(directory))
    assert none.table.num_rows == 0
    assert none.missing == len(none.universes.values)

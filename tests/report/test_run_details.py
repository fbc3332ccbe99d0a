"""How a study was run, and what of it failed or is missing."""

import pyarrow as pa

from animat.report.run_details import ERRORS_SHOWN, how_run_section, notices

from .small import ran

NONE = pa.table({"case": pa.array([], pa.int64()), "life": pa.array([], pa.int64()),
                 "error": pa.array([], pa.string())})  # fmt: skip


def failed(*errors):
    count = len(errors)
    return pa.table({"case": [0] * count, "life": list(range(count)), "error": list(errors)})


def test_versions_machine_command_and_hash_are_told(results):
    terms = how_run_section(results, results.progress, NONE).terms
    run = results.manifest["runs"][0]
    assert terms["Lives"] == "100 of 100 finished"
    assert terms["Failed"] == "0"
    assert results.manifest["hash"] in terms["Study"]
    assert terms["Engine"] == str(results.manifest["engine"])
    assert terms["Command"] == run["command"]
    assert f"numpy {run['versions']['numpy']}" in terms["Versions"]
    assert run["machine"]["processor"] in terms["Machine"]
    assert terms["Begun"] == run["made"]
    assert "Resumed" not in terms
    assert notices(results.progress, NONE) == []


def test_runs_on_other_machines_are_told_apart(results, monkeypatch):
    (run,) = results.manifest["runs"]
    later = run | {"made": "2030-01-01T00:00:00+00:00", "machine": {"processor": "another"}}
    monkeypatch.setitem(results.manifest, "runs", [run, later])
    terms = how_run_section(results, results.progress, NONE).terms
    assert "processor another (2030-01-01T00:00:00+00:00)" in terms["Machine"]
    assert f"({run['made']})" in terms["Machine"]
    assert terms["Command"] == run["command"]
    assert terms["Resumed"] == later["made"]


def test_a_study_that_still_runs_is_told_loudly(copied):
    results = copied(without=1)
    done, total = results.progress
    assert done < total
    section = how_run_section(results, results.progress, NONE)
    assert section.terms["Lives"] == f"{done} of 100 finished"
    (notice,) = section.notices
    assert notice.startswith(
        f"Not finished: {total - done} of 100 lives are still to be simulated."
    )


def test_errors_are_told_once_with_their_first_life(results):
    section = how_run_section(results, results.progress, failed("nan", "oops", "nan"))
    (table,) = section.tables
    assert [tuple(row) for row in table.rows] == [
        ("nan", "2", "case 0, life 0"), ("oops", "1", "case 0, life 1"),
    ]  # fmt: skip
    assert section.notices[0].startswith("3 lives failed. They are left out of all numbers")


def test_of_very_many_errors_the_first_are_shown(results):
    errors = [f"error {k:03}" for k in range(ERRORS_SHOWN + 5)]
    (table,) = how_run_section(results, results.progress, failed(*errors)).tables
    assert len(table.rows) == ERRORS_SHOWN
    assert table.note == "and 5 other errors"


def test_cases_that_share_their_lives_are_told(tmp_path):
    text = """
name = "sharing"
lives = 3
steps = 100
[design.grid]
"mind.likelihood_threshold" = [0.4, 0.5, 0.6]
"""
    results = ran(text, tmp_path)
    lives = how_run_section(results, results.progress, NONE).terms["Lives"]
    assert lives.startswith("3 of 3 finished; 2 of 3 cases differ from another in nothing")

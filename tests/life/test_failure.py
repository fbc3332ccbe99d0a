"""Custom functions that go wrong: whoever simulates a life, it fails alike, and alone."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pyarrow.compute as pc
import pytest

from animat.cli.one_life import record
from animat.life.batch import Batch
from animat.life.failure import FailedLifeError
from animat.life.life import live
from animat.life.lives import live_many
from animat.life.scenario import bring_together
from animat.life.trace import ROW
from animat.mind.functions import SIGNATURES, FunctionError
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.robot.khepera import Khepera

STEPS = 6_000
LIVES = 300

FILE = Path(__file__).with_name("hostile.py")
OWN = {role: f"{FILE}:{role}" for role in SIGNATURES}


def hostile(**wrong: float) -> Mind:
    """Return a mind of custom functions alone; in each role named one thing goes wrong.

    What goes wrong is said by a number that the function is given, so that all are compiled once.
    """
    custom = {"law": OWN["law"], "kind": "deficit", "set_point": 0.9}
    return Mind(
        agent="LEARNING",
        death=False,
        variables={
            "nutrition": {**custom, "rate": wrong.get("law", 1e-4)},
            "stamina": {**custom, "rate": 1e-4},
            "restlessness": {**custom, "rate": 1e-3},
        },
        drives={
            "hunger": {"a": {"nutrition": 1.0}, "b": {"nutrition": wrong.get("drives", 0.0)}},
            "fatigue": {"a": {"stamina": 1.0}},
            "curiosity": {"a": {"restlessness": 1.0}, "b": {"stamina": wrong.get("selector", 0.0)}},
        },
        drive_function=OWN["drives"],
        selector=OWN["selector"],
        wander=OWN["wander"],
        cruise_speed=int(wrong.get("wander", 5)),
        encounter_range=120.0,
        learning={
            "estimator": OWN["estimator"],
            "learner": OWN["learner"],
            "threshold": 0.0,
            "rate": wrong.get("learner", 0.5),
        },
    )


KINDS = {
    "law returns NaN": ({"law": 2e-4}, "law: law returned a value that is not finite"),
    "law returns infinity": ({"law": 3e-4}, "law: law returned a value that is not finite"),
    "law raises": ({"law": 4e-4}, "law: law raised ValueError: no way, out of here"),
    "drives leave NaN": ({"drives": 1.0}, "drives: drives left a drive that is not finite"),
    "drives raise": ({"drives": 2.0}, "drives: drives raised ZeroDivisionError: nothing left"),
    "selector returns 99": (
        {"selector": 1.0},
        "selector: selector returned 99, allowed are -1 (none) and 0 to 2",
    ),
    "selector returns -2": (
        {"selector": 2.0},
        "selector: selector returned -2, allowed are -1 (none) and 0 to 2",
    ),
    "selector raises": ({"selector": 3.0}, "selector: selector raised KeyError"),
    "learner leaves infinity": (
        {"learner": 1.0},
        "learner: learner left a weight that is not finite",
    ),
    "learner raises": ({"learner": 2.0}, "learner: learner raised StopIteration"),
    "wander goes too fast": (
        {"wander": 6},
        "wander: wander returned (1000, 3), the motors take -10 to 10",
    ),
    "wander goes back too fast": (
        {"wander": 7},
        "wander: wander returned (3, -11), the motors take -10 to 10",
    ),
    "wander returns NaN": (
        {"wander": 8},
        "wander: wander returned (nan, 3), the motors take -10 to 10",
    ),
    "wander returns infinity": (
        {"wander": 9},
        "wander: wander returned (3, inf), the motors take -10 to 10",
    ),
    "wander raises": ({"wander": 10}, "wander: wander raised MemoryError: stop"),
}


def failing(mind, world, life, **more):
    """Return why a life fails, on one line, if it does."""
    try:
        live(mind, world, seed=2, life=life, steps=STEPS, **more)
    except FailedLifeError as error:
        (line,) = str(error).splitlines()
        head, _, why = line.partition(" failed: ")
        assert head == f"life {life} of seed 2"
        return why
    return None


@pytest.mark.parametrize("kind", KINDS)
def test_such_a_life_fails_alike_in_every_way_to_have_one(kind, small, tmp_path):
    wrong, told = KINDS[kind]
    mind = hostile(**wrong)
    errors = Batch(bring_together(mind, small), 2, STEPS).run(np.arange(8, dtype=np.uint64)).errors
    first = next(n for n, error in enumerate(errors) if error is not None)
    for n in {0, first}:
        assert failing(mind, small, n) == errors[n]
        assert failing(mind, small, n, record="last:50") == errors[n]
    error = errors[first]
    assert error is not None
    what, _, step = error.rpartition(", in step ")
    assert what == told
    assert live(mind, small, seed=2, life=first, steps=int(step) or 1).lifespan == (int(step) or 1)
    with pytest.raises(FailedLifeError, match=re.escape(error)):
        record(mind, small, tmp_path / "a.parquet", seed=2, life=first, steps=STEPS)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("first", "told"),
    [(3.0, "returned a likelihood that is not finite"), (4.0, "raised ValueError: who knows")],
)
def test_an_estimator_that_gives_no_number_fails_its_life(first, told, small):
    mind = hostile()
    features = small.feature_names
    weights = np.full((3, mind.weight_count(len(features))), first)
    known = Networks(tuple(mind.behaviours), features, mind.learning.hidden_units, weights)
    mind = Mind(**{**dict(mind), "networks": known})
    why = failing(mind, small, 0) or ""
    assert why.startswith(f"estimator: estimator {told}, in step ")
    batch = Batch(bring_together(mind, small), 2, STEPS)
    assert batch.run(np.zeros(1, np.uint64)).errors == [why]
    curve = Batch(batch.setting, 2, STEPS, curve=True).run(np.zeros(1, np.uint64))
    assert (curve.errors[0] or "").startswith("estimator: estimator ")


@pytest.mark.parametrize("wrong", [{"drives": 1.0}, {"wander": 6}, {"wander": 10}, {}])
def test_many_hostile_lives_are_the_same_on_any_number_of_threads(wrong, small):
    mind, tables = hostile(**wrong), []
    for threads in (1, 2):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            lives = live_many(mind, small, lives=LIVES, seed=2, steps=1_500, threads=threads)
        tables.append(lives.table)
        failed = lives.failed
        assert len(caught) == (1 if failed else 0)
        if failed:
            why = lives.table["error"].drop_null()[0].as_py()
            said = str(caught[0].message)
            assert f"{failed} of {LIVES} lives failed; the others are kept" in said
            assert why in said
    assert tables[0].equals(tables[1])
    whole = tables[0].filter(pc.field("error").is_null())
    assert bool(wrong) == (whole.num_rows < LIVES)
    assert whole.num_rows > 10
    for row in whole.slice(0, 5).to_pylist():
        assert row == live(mind, small, seed=2, life=row["life"], steps=1_500).summary
    for row in tables[0].filter(pc.field("error").is_valid()).slice(0, 3).to_pylist():
        kept = {name for name, value in row.items() if value is not None}
        assert kept == {"world", "agent", "seed", "life", "error"}


def test_no_statistic_counts_a_life_that_failed(small):
    with pytest.warns(RuntimeWarning, match="lives failed; the others are kept"):
        lives = live_many(hostile(wander=6), small, lives=60, seed=2, steps=1_500)
    whole = lives.table["lifespan"].drop_null().to_numpy()
    assert 0 < lives.failed == 60 - len(whole) < 60
    with pytest.warns(RuntimeWarning, match="left out of account; such as life"):
        assert lives.mean_lifespan().value == pytest.approx(whole.mean())
    with pytest.warns(RuntimeWarning, match="left out of account"):
        assert sum(cause.count for cause in lives.causes()) == len(whole)


def test_the_trace_shows_the_commands_that_were_driven(small, columns):
    """The built-in search asks for more than slow motors take."""
    slow = Khepera(max_motor=3)
    told = columns(live(Mind(), small, robot=slow, seed=2, steps=400, record="all"))
    commands = np.concatenate([told["left"], told["right"]])
    assert np.abs(commands).max() == 3


@pytest.mark.parametrize("role", [role for role in SIGNATURES if role != "law"])
def test_inputs_can_only_be_read(role, small):
    """But for what the role is to write, which the functions above do."""
    with pytest.raises(FunctionError) as told:
        bring_together(with_role(role, f"{FILE}:writes_{role}"), small)
    (line,) = str(told.value).splitlines()
    assert line.startswith(f"{role}: writes_{role} changes what it is given in line ")
    assert line.endswith(f"; wanted {SIGNATURES[role]}")


def with_role(role: str, function: str) -> Mind:
    return {
        "drives": lambda: Mind(drive_function=function),
        "selector": lambda: Mind(selector=function),
        "estimator": lambda: Mind(learning={"estimator": function}),
        "learner": lambda: Mind(learning={"learner": function}),
        "wander": lambda: Mind(wander=function),
    }[role]()


def test_a_failed_life_is_no_part_of_what_a_row_or_a_digest_holds():
    row = {field.name for field in (*ROW.single, *ROW.arrays)}
    assert not {"asked", "failure", "given"} & row

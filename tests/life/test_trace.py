"""The trace: what is recorded, and a whole life derived from it again in plain Python."""

import math
import re

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from animat.life.life import live
from animat.life.scenario import LifeError
from animat.life.state import EVENTS
from animat.mind.behaviours import curved_wander
from animat.mind.mind import Mind
from animat.numerics.compiled import kernel
from animat.numerics.streams import MOTORS, SENSORS, WANDER, bits, uniforms
from animat.robot.collision import CLEAR, collide, touched
from animat.robot.infrared import read_infrared
from animat.robot.khepera import Khepera

STEPS = 6_000
SEED, LIFE = 3, 11

KINDS = {
    "nutrition": ("decay", 1e-4),
    "stamina": ("growth", 1e-4),
    "restlessness": ("growth", 1e-3),
}
SET_POINTS = {"nutrition": 0.9, "stamina": 0.2, "restlessness": 0.1}
DRIVES = {"hunger": "nutrition", "fatigue": "stamina", "curiosity": "restlessness"}
BEHAVIOURS = {"eat": "nutrition", "shelter": "stamina", "interact": "restlessness"}
SENSE = {"nutrition": 1.0, "stamina": -1.0, "restlessness": -1.0}


def robot_of(infrared):
    return Khepera(infrared=infrared)


@pytest.fixture(scope="module", params=["michel1996", "linear"])
def life(request, small):
    """A life without death, so that its variables meet their bounds too."""
    mind = Mind(death=False)
    return live(
        mind,
        small,
        robot=robot_of(request.param),
        seed=SEED,
        life=LIFE,
        steps=STEPS,
        record="all",
    )


@pytest.fixture(scope="module")
def c(life, columns):
    return columns(life)


# --- what is recorded -------------------------------------------------------------------------


def test_every_column_has_its_type(life):
    real = ["x", "y", "heading", *KINDS, *DRIVES, *(f"likelihood_{b}" for b in BEHAVIOURS)]
    whole = ["step", *(f"infrared_{n}" for n in range(8)), "left", "right", "site", "reward"]
    word = ["winning_drive", "behaviour", "object", "event"]
    schema = life.trace.schema
    assert sorted(schema.names) == sorted([*real, *whole, *word])
    assert schema.names[:4] == ["step", "x", "y", "heading"]
    assert all(schema.field(name).type == pa.float64() for name in real)
    assert all(schema.field(name).type == pa.int64() for name in whole)
    words = pa.dictionary(pa.int32(), pa.string())
    assert all(schema.field(name).type == words for name in word)
    assert life.trace["step"].to_pylist() == list(range(STEPS))
    maybe = {"object", *(f"likelihood_{b}" for b in BEHAVIOURS)}
    assert "object" in {n for n in schema.names if life.trace[n].null_count} <= maybe


@pytest.mark.parametrize("every", [1, 2, 7, 1_000])
def test_every_nth_row_is_the_same_row(every, life, small):
    thinned = again(life, small, f"every:{every}")
    assert plain(thinned) == plain(life.trace.take(list(range(0, STEPS, every))))


@pytest.mark.parametrize("last", [1, 500, STEPS, 2 * STEPS])
def test_the_last_rows_are_the_same_rows(last, life, small):
    assert plain(again(life, small, f"last:{last}")) == plain(life.trace[-last:])


def test_a_life_is_the_same_life_whether_recorded_or_not(life, small):
    unseen = live(life.mind, small, robot=life.setting.robot, seed=SEED, life=LIFE, steps=STEPS)
    assert unseen.trace is None
    assert unseen.summary == life.summary
    only_when_searching = {"readings"}
    for name in set(unseen.state.dtype.names) - only_when_searching:
        assert np.array_equal(unseen.state[name], life.state[name]), name


def again(life, world, record):
    robot = life.setting.robot
    return live(
        life.mind, world, robot=robot, seed=SEED, life=LIFE, steps=STEPS, record=record
    ).trace


def plain(table):
    return table.to_pydict()


def test_the_step_of_a_death_is_the_last_row_of_every_recording(small, caring_for):
    mind = Mind(variables=caring_for("nutrition", rate=0.01, lethal_margin=0.1))
    traces = {
        record: live(mind, small, steps=5_000, record=record).trace
        for record in ("all", "every:50", "last:7")
    }
    rows = {record: trace.to_pylist()[-1] for record, trace in traces.items()}
    assert rows["all"]["event"] == "death"
    assert rows["every:50"] == rows["last:7"] == rows["all"]
    steps = traces["every:50"]["step"].to_pylist()
    assert steps[:-1] == list(range(0, rows["all"]["step"], 50))


@pytest.mark.parametrize("record", ["all", "every:50", "last:7"])
def test_the_row_of_a_death_by_an_act_holds_the_values_that_killed(record, small):
    life = live(Mind(failure_effect=0.9), small, seed=1, record=record)
    assert life.death is not None
    assert life.death.endswith("failure")
    last = life.trace.to_pylist()[-1]
    assert [last[name] for name in KINDS] == life.state["values"].tolist()
    died = life.summary["death_variable"]
    assert not 0.0 <= last[died] <= 1.0


def test_a_likelihood_is_null_until_its_network_was_asked(small):
    """And a network that says 0 has been asked."""
    mind = Mind(agent="ORACLE", death=False, gate="always")
    life = live(mind, small, seed=2, steps=STEPS, record="all")
    events = life.trace["event"].to_pylist()
    nulls = 0
    for name in BEHAVIOURS:
        said = life.trace[f"likelihood_{name}"].to_pylist()
        first = next(step for step, value in enumerate(said) if value is not None)
        assert "encounter" in events[first]
        assert None not in said[first:]
        nulls += first
    assert nulls > 0
    assert 0.0 in life.trace["likelihood_eat"].to_pylist()


def test_parts_in_which_nothing_happens_fit_with_the_others(small):
    """A trace is put together from parts; one may hold no event and meet no object."""
    trace = live(Mind(death=False), small, steps=120_000, record="every:4").trace
    assert trace.num_rows == 30_000
    assert trace["event"].num_chunks > 1
    nothing_left = live(Mind(death=False), small, steps=100_000, record="every:4").trace
    assert nothing_left.equals(trace[:25_000])
    quiet = live(Mind(), small, steps=3, record="all").trace
    assert quiet.schema == trace.schema
    assert pa.concat_tables([quiet, trace]).num_rows == 30_003


def test_a_trace_goes_through_a_parquet_file(life, tmp_path):
    pq.write_table(life.trace, tmp_path / "trace.parquet")
    assert pq.read_table(tmp_path / "trace.parquet").equals(life.trace)


@pytest.mark.parametrize(
    "record", ["", "ALL", "all:3", "every", "every:0", "every:-1", "every:x", "last:0", "last:1e3"]
)
def test_an_unknown_recording_is_refused(record, small):
    told = re.escape(f'record = "{record}"; allowed are "all", "every:N", and "last:N"')
    with pytest.raises(LifeError, match=told):
        live(Mind(), small, steps=10, record=record)


# --- derived again ----------------------------------------------------------------------------


@kernel
def luck(seed, life, motors, wander):
    """Fill the uniforms [N, 4] of the motors and of wandering, steps 0 to N - 1."""
    for t in range(len(motors)):
        a, b, c, d = uniforms(seed, life, MOTORS, t)
        motors[t, 0], motors[t, 1], motors[t, 2], motors[t, 3] = a, b, c, d
        a, b, c, d = uniforms(seed, life, WANDER, t)
        wander[t, 0], wander[t, 1], wander[t, 2], wander[t, 3] = a, b, c, d


@kernel
def look(poses, robot, raster, present, seed, life, readings):
    """Fill what the sensors read [N, 8] in the poses [N, 3]."""
    for t in range(len(poses)):
        words = bits(seed, life, SENSORS, t)
        read_infrared(
            poses[t, 0], poses[t, 1], poses[t, 2], robot, raster, present, words, readings[t], 0
        )


@kernel
def bump(poses, moved, robot, raster, present, ended, hits):
    """Fill where collisions lead [N, 3] steps from `poses` to `moved`, and the points hit [N]."""
    for t in range(len(poses)):
        x, y, heading, _ = collide(
            poses[t, 0],
            poses[t, 1],
            poses[t, 2],
            moved[t, 0],
            moved[t, 1],
            moved[t, 2],
            robot,
            raster,
            present,
        )
        ended[t, 0], ended[t, 1], ended[t, 2] = x, y, heading
        hits[t] = touched(moved[t, 0], moved[t, 1], moved[t, 2], robot, raster, present)


@pytest.fixture(scope="module")
def uniform(life):
    motors, wander = np.zeros((STEPS, 4)), np.zeros((STEPS, 4))
    luck(np.uint64(SEED), np.uint64(LIFE), motors, wander)
    return {"motors": motors, "wander": wander}


@pytest.fixture(scope="module")
def poses(c):
    return np.column_stack([c["x"], c["y"], c["heading"]])


@pytest.fixture(scope="module")
def present(small):
    return np.ones(small.n_sites, np.uint8)


def test_the_sensors_read_what_there_is_at_the_recorded_pose(life, c, poses, present):
    readings = np.zeros((STEPS, 8), np.int64)
    setting = life.setting
    look(
        poses,
        setting.robot_parameters,
        setting.raster,
        present,
        np.uint64(SEED),
        np.uint64(LIFE),
        readings,
    )
    assert readings.max() > 900
    for n in range(8):
        assert np.array_equal(c[f"infrared_{n}"], readings[:, n])


def test_the_robot_moves_by_its_motors_and_the_noise_of_the_step(life, c, poses, present, uniform):
    left, right = c["left"] * 0.5, c["right"] * 0.5  # mm
    u = uniform["motors"]
    turn = (right - left) / 50.0 * (0.95 + 0.10 * u[:, 2])
    way = (left + right) / 2.0
    x = c["x"] + way * np.cos(c["heading"] + turn / 2.0) * (0.90 + 0.20 * u[:, 0])
    y = c["y"] + way * np.sin(c["heading"] + turn / 2.0) * (0.90 + 0.20 * u[:, 1])
    moved = np.column_stack([x, y, c["heading"] + turn])
    ended, hits = np.zeros((STEPS, 3)), np.zeros(STEPS, np.int64)
    setting = life.setting
    bump(poses, moved, setting.robot_parameters, setting.raster, present, ended, hits)
    blocked = c.happened("blocked")
    assert np.array_equal(blocked, hits != CLEAR)
    free = np.flatnonzero(~blocked[:-1])
    gone = poses[free + 1] - moved[free]
    assert np.abs(gone[:, :2]).max() < 1e-9
    assert np.abs((gone[:, 2] + math.pi) % math.tau - math.pi).max() < 1e-9
    stopped = np.flatnonzero(blocked[:-1])
    assert np.allclose(poses[stopped + 1, :2], ended[stopped, :2], atol=1e-9)
    assert (np.abs(c["heading"]) <= math.pi).all()


def test_the_variables_follow_their_laws_and_acts_move_them(c):
    effects = {
        variable: np.where(c["behaviour"] == behaviour, 0.2 * c["reward"] * SENSE[variable], 0.0)
        for behaviour, variable in BEHAVIOURS.items()
    }
    for variable, (law, rate) in KINDS.items():
        assert np.count_nonzero(effects[variable]) > (0 if variable != "restlessness" else 5)
        after = np.clip(c[variable] + effects[variable], 0.0, 1.0)
        before = np.concatenate([[0.5], after[:-1]])
        factor = math.exp(-rate if law == "decay" else rate)
        assert np.abs(c[variable] - np.minimum(before * factor, 1.0)).max() < 1e-12


def test_the_drives_follow_equation_3_and_the_strongest_wins(c):
    drives = np.column_stack(
        [SENSE[variable] * (SET_POINTS[variable] - c[variable]) for variable in DRIVES.values()]
    )
    for d, name in enumerate(DRIVES):
        assert np.abs(c[name] - drives[:, d]).max() < 1e-15
    names = np.array(list(DRIVES), object)
    assert np.array_equal(c["winning_drive"], names[drives.argmax(axis=1)])
    assert set(c["winning_drive"]) == set(names)


def test_a_wandering_robot_sets_its_motors_by_what_it_sees_and_its_luck(life, c, uniform):
    robot = life.setting.robot_parameters
    memory = np.zeros(4)
    seen = np.column_stack([c[f"infrared_{n}"] for n in range(8)])
    searching = np.flatnonzero(c["behaviour"] == "wander")
    for t in searching:
        u_a, u_b = uniform["wander"][t, :2]
        left, right = curved_wander(
            seen[t], robot.sensor_cosine, robot.sensor_y, memory, u_a, u_b, 5, 5
        )
        assert (c["left"][t], c["right"][t]) == (left, right), t
    assert len(searching) > STEPS / 2


def test_an_approaching_robot_turns_to_the_object_and_goes_to_it(life, c):
    raster = life.setting.raster
    rows = np.flatnonzero(c["behaviour"] == "approach")
    assert len(rows) > 100
    for t in rows:
        site = c["site"][t]
        dx, dy = raster.site_x[site] - c["x"][t], raster.site_y[site] - c["y"][t]
        bearing = math.remainder(math.atan2(dy, dx) - c["heading"][t], math.tau)
        motors = (5, 5) if abs(bearing) < math.atan(0.3) else (-5, 5) if bearing > 0 else (5, -5)
        assert (c["left"][t], c["right"][t]) == motors


def test_the_outcome_is_what_table_1_says(life, c):
    affords = {"eat": ("TS", "CS"), "shelter": ("TL", "CL"), "interact": ("TS", "CS", "TL", "CL")}
    ended = np.flatnonzero(c["reward"])
    assert {-1, 1} == set(c["reward"][ended])
    for t in ended:
        assert (c["reward"][t] == 1) == (c["object"][t] in affords[c["behaviour"][t]])


def test_the_object_is_named_while_it_is_dealt_with(life, c, small):
    types = [small.types[t].name for t in small.layout.site_types()]
    for name, site, doing in zip(c["object"], c["site"], c["behaviour"], strict=True):
        assert (site == -1) == (doing == "wander") == (name is None)
        assert name is None or name == types[site]


def test_the_summary_counts_the_events(life, c):
    counted = life.summary
    told = {
        "encounters": "encounter",
        "successes": "success",
        "failures": "failure",
        "disregarded": "disregarded",
        "unreached": "unreached",
        "blocked": "blocked",
        "trainings": "trained",
    }
    for column, event in told.items():
        assert counted[column] == c.happened(event).sum(), column
    assert counted["acts"] == np.count_nonzero(c["reward"])
    for behaviour in BEHAVIOURS:
        own = c["reward"][c["behaviour"] == behaviour]
        assert counted[f"acts_{behaviour}"] == np.count_nonzero(own)
        assert counted[f"successes_{behaviour}"] == np.count_nonzero(own == 1)
    drives = np.column_stack([c[name] for name in DRIVES])
    assert counted["mean_drive"] == pytest.approx(drives.mean(), rel=1e-12)


def test_every_event_has_a_name_of_its_own():
    assert len(set(EVENTS)) == 9
    assert not any(" " in name for name in EVENTS)

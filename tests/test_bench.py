"""The measuring programs: they run, say what they promise, and measure what they say."""

from __future__ import annotations

import importlib
import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

BENCH = Path(__file__).parents[1] / "bench"
sys.path += [str(BENCH), str(BENCH / "peers")]

figures, simulators, work = (
    importlib.import_module(name) for name in ("figures", "simulators", "work")
)
with_animat, with_numba, with_numpy = (
    importlib.import_module(name) for name in ("with_animat", "with_numba", "with_numpy")
)

POSITIVE = st.floats(1e-6, 1e9)


@given(POSITIVE, POSITIVE, st.booleans())
def test_a_target_is_met_or_says_how_far_it_is(value, limit, at_least):
    target = figures.Target(value, limit, at_least)
    assert target.met == (value >= limit if at_least else value <= limit)
    assert str(target).endswith(": met") == target.met
    if not target.met:
        far = str(target).split(": ")[1].split("%")[0]
        assert int(far) == pytest.approx(100 * abs(value / limit - 1), abs=0.51)


def test_a_target_of_none_tells_how_many_there_are():
    assert str(figures.Target(7, 0, at_least=False)) == "at most 0: 7 too much"


@given(st.floats(-1e12, 1e12, allow_subnormal=False))
def test_a_cell_keeps_three_digits(value):
    assert float(figures.cell(value).replace(",", "")) == pytest.approx(value, rel=0.0051)


def test_a_table_is_written_for_a_page_and_for_a_terminal():
    target = figures.Target(5.0, 6.0, at_least=True)
    rows = [
        {"world": "empty", "ns": 123.45, "target": target},
        {"world": "a", "ns": 1, "target": None},
    ]
    table = figures.Table("Steps", rows, "Read with care.")
    assert figures.written(table, markdown=True).splitlines() == [
        "### Steps",
        "",
        "| world | ns | target |",
        "|---|---:|---|",
        "| empty | 123 | at least 6: 17% too little |",
        "| a | 1 |  |",
        "",
        "Read with care.",
    ]
    assert figures.written(table, markdown=False).splitlines()[2:5] == [
        "world   ns  target",
        "empty  123  at least 6: 17% too little",
        "a        1",
    ]


@given(st.lists(st.text(), unique=True, min_size=1, max_size=5), st.integers(0, 4))
def test_turns_go_forwards_and_backwards(names, repeat):
    called = []

    def note(name):
        called.append(name)
        return len(called)

    taken = figures.in_turns({name: lambda name=name: note(name) for name in names}, repeat)
    turns = [called[n : n + len(names)] for n in range(0, len(called), len(names))]
    assert turns == [names[::-1] if n % 2 else names for n in range(repeat)]
    assert {name: len(values) for name, values in taken.items()} == dict.fromkeys(names, repeat)


def said_by(program: str, *options: str, folder: Path) -> dict:
    """Run a program of the bench at its smallest, and return the JSON it writes."""
    file = folder / "said.json"
    command = [sys.executable, str(BENCH / program), *options, "--json", str(file)]
    told = subprocess.run(command, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    return checked(file, told.stdout)


def checked(file: Path, told: str) -> dict:
    """What a program wrote and printed, which is the same."""
    said = json.loads(file.read_text())
    for part in [said] if "tables" in said else said.values():
        assert part["machine"]["cores"]
        assert part["versions"]["numba"]
        assert part["command"]
        for table in part["tables"]:
            assert f"### {table['title']}\n" in told
            columns = list(table["rows"][0])
            assert f"| {' | '.join(columns)} |\n" in told
            assert all(list(row) == columns for row in table["rows"])
    return said


@pytest.mark.long
def test_all_that_is_measured_is_told_with_its_targets(tmp_path, monkeypatch, capsys):
    said = said_by("all.py", "--tiny", "--markdown", "--only", "startup", folder=tmp_path)
    assert set(said) == {"startup"}
    # Here, and not in processes of their own, which load what is loaded.
    for name in ("speed", "threads", "parts"):
        program, file = importlib.import_module(name), tmp_path / f"{name}.json"
        options = ["--tiny", "--repeat=1", "--markdown", "--json", str(file)]
        monkeypatch.setattr(sys, "argv", [str(program.__file__), *options])
        figures.run(program.__doc__, program.tables, repeat=9)
        said[name] = checked(file, capsys.readouterr().out)
    tables = {table["title"]: table["rows"] for part in said.values() for table in part["tables"]}
    steps = tables["A robot-step on one core"]
    assert {row["world"] for row in steps} >= {"abundant", "scarce", "empty"}
    assert [row["target"]["limit"] for row in steps if row["target"]] == [6.0, 8.0, 10.0]
    for row in steps:
        assert row["BLIND, million steps/s"] == pytest.approx(1e3 / row["BLIND, ns"])
    (*layouts, mean) = tables["16 times the area with 16 times the objects"]
    assert mean["target"]["limit"] == 1.1
    assert mean["4 m x 4 m, ns"] == pytest.approx(
        np.mean([row["4 m x 4 m, ns"] for row in layouts])
    )
    assert {row["target"]["limit"] for row in tables["Two threads"]} == {1.9}
    assert [row["target"] and row["target"]["limit"] for row in tables["Importing and help"]] == [
        None,
        0.3,
        0.3,
    ]
    assert all(row["most memory, MB"] > 1.0 for row in tables["Memory"])
    parts = tables["Where the time of a step goes"]
    step = parts.pop()["alone, ns a step"]
    whole = [row for row in parts if not row["part"].startswith(("-", "sine"))]
    assert sum(row["alone, ns a step"] for row in whole) == pytest.approx(step)


@given(st.integers(0, 30), st.integers(0, 100))
def test_the_robot_can_pass_everywhere_and_starts_clear(count, seed):
    placed = work.obstacles(count, seed)
    discs = [shapely.Point(place).buffer(work.OBSTACLE_RADIUS) for place in placed]
    walls = shapely.box(0, 0, work.SIDE, work.SIDE).exterior
    assert placed == work.obstacles(30, seed)[:count]
    for n, disc in enumerate(discs):
        assert all(disc.distance(other) >= work.GAP - 1e-6 for other in [walls, *discs[:n]])
    for x, y, _ in work.starts(5, placed, seed):
        robot = shapely.Point(x, y).buffer(work.RADIUS)
        assert all(robot.distance(other) > 0.0 for other in [walls, *discs])


@pytest.mark.parametrize("start", [with_numpy.start, with_numba.start, with_animat.wander_linear])
def test_robots_wander_and_touch_nothing(start):
    placed = work.obstacles(30)
    robots = start(placed, 32, 3)
    shares = []
    been = set()
    for _ in range(400):
        robots.step(5)
        places = positions(robots)
        assert np.all((places >= work.RADIUS) & (places <= work.SIDE - work.RADIUS))
        apart = np.linalg.norm(places[:, None] - np.array(placed), axis=2)
        # The octagon that animat draws on cells of 2 mm may be that much smaller than the disc.
        assert apart.min() >= work.OBSTACLE_RADIUS + work.RADIUS - 2.0
        shares.append(robots.turning())
        been |= {(n, *cell) for n, cell in enumerate((places // 100).astype(int).tolist())}
    assert 0.02 < np.mean(shares) < 0.5
    assert len(been) > 300


@given(st.floats(-math.pi, math.pi), st.floats(-1.4, 1.4))
def test_a_robot_is_stopped_by_what_it_touches(bearing, aside):
    """Both hand-written loops stop a robot that goes at an obstacle, and let it go away."""
    away = work.RADIUS + work.OBSTACLE_RADIUS + 0.1
    x, y = 500.0 + away * math.cos(bearing), 500.0 + away * math.sin(bearing)
    for heading, stopped in ((bearing + math.pi + aside, True), (bearing + aside, False)):
        by_numba = with_numba.start([(500.0, 500.0)], 1, 1)
        by_numba.states[0, :3] = x, y, heading
        with_numba.move(by_numba.states[0], work.SPEED, 0.0, by_numba.obstacles)
        by_numpy = with_numpy.start([(500.0, 500.0)], 1, 1)
        by_numpy.pose[0] = x, y, heading
        by_numpy.move(np.array([work.SPEED]), np.array([0.0]))
        for robots in (by_numba, by_numpy):
            assert np.array_equal(positions(robots)[0], [x, y]) == stopped


def positions(robots) -> np.ndarray:
    """Return where robots are [R, 2], in mm."""
    if hasattr(robots, "pose"):
        return robots.pose[:, :2].copy()
    if robots.states.dtype.names:
        return np.stack([robots.states["x"], robots.states["y"]], axis=1)
    return robots.states[:, :2].copy()


@given(st.integers(0, 1000))
def test_rays_end_where_geometry_says(seed):
    """Both hand-written loops see what shapely sees, but for the noise of 1 %."""
    placed = work.obstacles(30, 5)
    solid = [shapely.Point(place).buffer(work.OBSTACLE_RADIUS, quad_segs=64) for place in placed]
    solid.append(shapely.box(0, 0, work.SIDE, work.SIDE).exterior)
    by_numpy = with_numpy.start(placed, 1, seed)
    by_numba = with_numba.start(placed, 1, seed)
    x0, y0, heading = work.starts(1, placed, seed)[0]
    sine, cosine = math.sin(heading), math.cos(heading)
    seen = by_numpy.sense()[0]
    for number, (x, y, degrees) in enumerate(work.SENSORS):
        origin = x0 + cosine * x - sine * y, y0 + sine * x + cosine * y
        angle = heading + math.radians(degrees)
        end = (
            origin[0] + work.REACH * math.cos(angle),
            origin[1] + work.REACH * math.sin(angle),
        )
        ray = shapely.LineString([origin, end])
        hits = [ray.intersection(thing) for thing in solid if ray.intersects(thing)]
        free = min((shapely.Point(origin).distance(hit) for hit in hits), default=work.REACH)
        of_numba = with_numba.sense(
            by_numba.states[0], sine, cosine, with_numba.SENSORS[number], by_numba.obstacles
        )
        assert seen[number] == pytest.approx(free, rel=0.011, abs=0.1)
        assert of_numba == pytest.approx(free, rel=0.011, abs=0.1)


@pytest.mark.long
def test_simulators_are_compared_in_one_table(tmp_path):
    names = ("animat, rays", "Numba loop", "NumPy loop")
    options = ("--venv", str(tmp_path), "--tiny", "--repeat", "1", "--obstacles", "0", "30")
    said = said_by("peers/run.py", *options, "--markdown", "--only", *names, folder=tmp_path)
    speeds, ratios, left_out = (table["rows"] for table in said["tables"])
    assert list(dict.fromkeys(row["simulator"] for row in speeds)) == list(names)
    assert all(row["30 obstacles"] > 0.0 for row in speeds)
    assert [row["simulator"] for row in ratios] == list(names[1:])
    assert [row["simulator"] for row in left_out] == list(names)
    one = {row["simulator"]: row["0 obstacles"] for row in speeds if row["robots at once"] == 1}
    for row in ratios:
        assert row["0 obstacles, one robot"] == pytest.approx(
            one["animat, rays"] / one[row["simulator"]]
        )


def test_a_simulator_that_fails_is_told_of_in_a_line():
    program = "import sys; print('ERROR: no such thing\\nhint', file=sys.stderr); sys.exit(1)"
    with pytest.raises(simulators.PeerError, match=r"^ERROR: no such thing$"):
        simulators.output([sys.executable, "-c", program])
    with pytest.raises(simulators.PeerError, match="No such file"):
        simulators.output(["/nowhere/python"])


def test_every_simulator_is_pinned_and_every_pin_used():
    packages = {name for peer in simulators.PEERS if not peer.installed for name in peer.packages}
    lines = (BENCH / "peers" / "requirements.txt").read_text().splitlines()
    pins = [line for line in lines if line and not line.startswith("#")]
    assert sorted(simulators.pins(sorted(packages))) == sorted(pins)


@pytest.mark.parametrize("peer", simulators.PEERS, ids=lambda peer: peer.name)
def test_every_simulator_has_an_adapter(peer):
    module, _, function = peer.adapter.partition(":")
    text = (BENCH / "peers" / f"{module}.py").read_text()
    assert f"\ndef {function}(" in text
    assert peer.robots[0] == 1

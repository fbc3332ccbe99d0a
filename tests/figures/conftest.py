from functools import cache

import numpy as np
import pyarrow as pa
import pytest

from ..statistics.tables import likelihoods_table, lives_table, paper_table  # noqa: F401

TYPES = ("TS", "TL", "CS", "CL")
BEHAVIOURS = ("eat", "shelter", "interact")
NEEDS = (
    ("nutrition", "hunger", 0.9),
    ("stamina", "fatigue", 0.2),
    ("restlessness", "curiosity", 0.1),
)


@cache
def make_trace(steps=4000, seed=1, start=0):
    """A trace as a life would leave one: a walk, needs that move, encounters with objects."""
    rng = np.random.default_rng(seed)
    step = np.arange(start, start + steps)
    heading = np.cumsum(rng.normal(0, 0.05, steps))
    x = np.abs((200 + np.cumsum(4 * np.cos(heading))) % 1900 - 950) + 25
    y = np.abs((700 + np.cumsum(4 * np.sin(heading))) % 1900 - 950) + 25
    values = {name: np.empty(steps) for name, _, _ in NEEDS}
    level = [0.55, 0.45, 0.3]
    behaviour = np.full(steps, "wander", dtype=object)
    thing = np.full(steps, None, dtype=object)
    event = np.full(steps, "", dtype=object)
    reward = np.zeros(steps, dtype=np.int64)
    likelihoods = {name: np.empty(steps) for name in BEHAVIOURS}
    now = {"eat": 0.9, "shelter": 0.1, "interact": 0.97}
    left, kind, act, phase = 0, None, "eat", ""
    for t in range(steps):
        level[0] *= np.exp(-1e-4)
        level[1] *= np.exp(1e-4)
        level[2] *= np.exp(1e-3)
        if left == 0 and phase == "" and rng.random() < 0.02:
            kind, act = TYPES[rng.integers(4)], BEHAVIOURS[rng.integers(3)]
            phase, left = "approach", int(rng.integers(5, 25))
            event[t] = "encounter"
        if phase:
            thing[t] = kind
            behaviour[t] = act if phase == "act" else phase
            left -= 1
            if phase == "act":
                good = act == "interact" or (act == "eat") == kind.endswith("S")
                now[act] = 0.95 + rng.normal(0, 0.01) if good else 0.05 + rng.normal(0, 0.01)
            if left == 0:
                if phase == "approach":
                    phase, left = "act", 20
                elif phase == "act":
                    number = BEHAVIOURS.index(act)
                    sign = 1 if number == 0 else -1
                    level[number] += 0.2 * sign * (1 if good else -1)
                    level[number] = float(np.clip(level[number], 0.02, 0.98))
                    reward[t] = 1 if good else -1
                    event[t] = "success trained" if good else "failure trained"
                    phase, left = "leave", 15
                else:
                    phase, left = "", 0
        for (name, _, _), value in zip(NEEDS, level, strict=True):
            values[name][t] = value
        for name in BEHAVIOURS:
            likelihoods[name][t] = now[name]
    event[-1] = "death"
    drives = {
        "hunger": 0.9 - values["nutrition"],
        "fatigue": values["stamina"] - 0.2,
        "curiosity": values["restlessness"] - 0.1,
    }
    return pa.table(
        {
            "step": step,
            "x": x,
            "y": y,
            "heading": heading,
            **values,
            **drives,
            "behaviour": pa.array(behaviour.tolist(), pa.string()),
            "object": pa.array(thing.tolist(), pa.string()),
            **{f"likelihood_{name}": line for name, line in likelihoods.items()},
            "reward": reward,
            "event": pa.array(event.tolist(), pa.string()),
        }
    )


@cache
def make_learning(seeds=40, episodes=150):
    rng = np.random.default_rng(2)
    afforded = {
        (n, k): float(n == "interact" or (n == "eat") == k.endswith("S"))
        for n in BEHAVIOURS
        for k in TYPES
    }
    columns = {name: [] for name in ("seed", "episode", "network", "object", "likelihood")}
    for seed in range(seeds):
        for (network, kind), end in afforded.items():
            pace = rng.uniform(15, 40)
            start = rng.uniform(0.65, 0.85)
            episode = np.arange(0, episodes, 3)
            columns["seed"] += [seed] * len(episode)
            columns["episode"] += episode.tolist()
            columns["network"] += [network] * len(episode)
            columns["object"] += [kind] * len(episode)
            settled = 0.04 + 0.92 * end
            columns["likelihood"] += (
                settled + (start - settled) / (1 + np.exp((episode - 2 * pace) / 8))
            ).tolist()
    return pa.table(columns), afforded


@cache
def make_ratios(layouts=20):
    rng = np.random.default_rng(3)
    rows = []
    for objects in range(3, 41):
        middle = 1 + 30 / (1 + np.exp(-(objects - 14) / 3))
        for layout in range(layouts):
            ratio = 1 + (middle - 1) * rng.lognormal(0, 0.5)
            rows.append({"objects": objects, "layout": layout, "ratio": float(ratio)})
    return pa.Table.from_pylist(rows)


def polygon(sides, radius, x, y, turn=0.0):
    angle = turn + 2 * np.pi * np.arange(sides) / sides
    return np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)])


SHAPES = {"TS": (3, 26.0), "TL": (3, 57.7), "CS": (4, 26.9), "CL": (8, 54.1)}


def make_world(title, objects, pose=(500.0, 500.0, 0.6), **changes):
    from animat.figures.worlds import WorldDrawing

    rng = np.random.default_rng(objects)
    spots = [(150 + 175 * c, 150 + 175 * r) for r in range(5) for c in range(5) if (r, c) != (2, 2)]
    chosen = rng.permutation(len(spots))[:objects]
    types = [TYPES[i % 4] for i in range(objects)]
    polygons = [
        polygon(*SHAPES[kind], *spots[at], turn=rng.uniform(0, 6))
        for kind, at in zip(types, chosen, strict=True)
    ]
    return WorldDrawing(
        title, 1000.0, 1000.0, (22.0, 978.0, 26.0, 976.0), polygons, types, pose
    )._replace(**changes)


def make_robot():
    from animat.figures.worlds import RobotDrawing

    right = np.radians([90, 45, 0, 0, -45, -90, 180, 180])
    forward = [9.5, 18, 24.5, 24.5, 18, 9.5, -23, -23]
    leftward = [23, 17.5, 5.5, -5.5, -17.5, -23, -9.5, 9.5]
    return RobotDrawing(27.5, np.column_stack([forward, leftward, right]), 58.0, np.radians(22))


@pytest.fixture(scope="session")
def trace():
    return make_trace


@pytest.fixture(scope="session")
def learning():
    return make_learning


@pytest.fixture(scope="session")
def ratios():
    return make_ratios


@pytest.fixture(scope="session")
def world():
    return make_world


@pytest.fixture(scope="session")
def robot():
    return make_robot()


def is_legible(fig):
    """Every word of the figure lies inside it and is large enough."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.text import Text

    canvas = FigureCanvasAgg(fig)
    canvas.draw()
    whole = fig.bbox
    ticks = {
        id(tick.label1): low <= tick.get_loc() <= high
        for ax in fig.axes
        for axis, (low, high) in (
            (ax.xaxis, sorted(ax.get_xlim())),
            (ax.yaxis, sorted(ax.get_ylim())),
        )
        for tick in axis.get_major_ticks()
    }
    for text in fig.findobj(Text):
        if not (text.get_visible() and text.get_text().strip() and ticks.get(id(text), True)):
            continue
        assert text.get_fontsize() >= 8
        box = text.get_window_extent(canvas.get_renderer())
        assert box.x0 >= whole.x0 - 1, text
        assert box.x1 <= whole.x1 + 1, text
        assert box.y0 >= whole.y0 - 1, text
        assert box.y1 <= whole.y1 + 1, text


@pytest.fixture
def legible():
    return is_legible

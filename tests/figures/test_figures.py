"""What holds for every figure: it is drawn without pyplot, saved the same again, and legible."""

import subprocess
import sys

import matplotlib
import numpy as np
import pyarrow as pa
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from animat.figures import style
from animat.figures.causes import causes_figure
from animat.figures.factor_effects import factor_effects_figure, trend_figure
from animat.figures.interaction import InteractionLine, interaction_figure
from animat.figures.learning import learning_curve_figure, learning_figure
from animat.figures.life import life_figure
from animat.figures.networks import SURFACE, networks_figure
from animat.figures.ratio import Mark, ratio_figure
from animat.figures.survival import (
    Bar,
    Panel,
    level_curves_figure,
    lifespans_figure,
    survival_figure,
)
from animat.figures.worlds import worlds_figure
from animat.statistics import survival
from animat.statistics.estimates import Estimate, share
from animat.statistics.survival import ALIVE, DeathCount

SET_POINTS = {"nutrition": 0.9, "stamina": 0.2, "restlessness": 0.1}
DRIVES = {"hunger": "nutrition", "fatigue": "stamina", "curiosity": "restlessness"}
BEHAVIOURS = {"eat": "nutrition", "shelter": "stamina", "interact": "restlessness"}
MIND = {"set_points": SET_POINTS, "drives": DRIVES, "behaviours": BEHAVIOURS}
CELLS = [(world, agent) for world in ("abundant", "scarce") for agent in ("BLIND", "AF")]


@pytest.fixture(scope="module")
def drawings(trace, learning, ratios, world, robot, lives_table):
    rng = np.random.default_rng(1)
    table = lives_table({cell: rng.exponential(3000, 200) + 1 for cell in CELLS}, cap=8000)
    curves = {key: survival.kaplan_meier(rows) for key, rows in survival.cells(table)}
    bars = [Bar(*cell, Estimate(100.0 * k, 90.0 * k, 115.0 * k)) for k, cell in enumerate(CELLS, 1)]
    deaths = [
        DeathCount("nutrition", "low", "metabolism", 3, share(3, 10)),
        DeathCount("stamina", "high", "failure", 2, share(2, 10)),
        DeathCount(ALIVE, "", "", 5, share(5, 10)),
    ]
    worlds = [world("World 1", 12), world("World 2", 6)]
    return {
        "worlds": lambda: worlds_figure(worlds, robot),
        "learning": lambda: learning_figure(trace(300)),
        "lifespans": lambda: lifespans_figure([Panel("20 lives", bars), Panel("1,000", bars)]),
        "learning_curve": lambda: learning_curve_figure(learning(3, 30)[0]),
        "survival": lambda: survival_figure(curves),
        "survival_log": lambda: survival_figure(curves, log=True),
        "survival_levels": lambda: level_curves_figure(
            {
                f"a level with a rather long name, number {k}": curve
                for k, curve in enumerate(curves.values())
            },
            ordered=True,
        ),
        "factor_effects": lambda: factor_effects_figure(
            {
                "mind.variables.nutrition.rate": {"0.0001": bars[0].mean, "0.001": bars[1].mean},
                "agent": {
                    "a level with a name that is much longer than a page is wide": bars[2].mean
                },
            },
            250.0,
        ),
        "interaction": lambda: interaction_figure(
            "mind.failure_effect",
            ("0", "0.001", "1", "not set"),
            (0.0, 0.001, 1.0, np.nan),
            [
                InteractionLine(f"{bar.agent}, {k}", dict.fromkeys(range(4), bar.mean))
                for k, bar in enumerate(bars)
            ],
            "agent",
        ),
        "interaction_words": lambda: interaction_figure(
            "world.layout",
            ["a level with a name that is much longer than a page is wide"] * 5,
            None,
            [InteractionLine("BLIND", {k: bar.mean for k, bar in enumerate(bars)})],
            "agent",
        ),
        "trend": lambda: trend_figure(
            "mind.success_effect",
            rng.random(50),
            300 + 900 * rng.random(50),
            [(0.2, bars[0].mean), (0.7, bars[1].mean)],
        ),
        "causes": lambda: causes_figure({", ".join(cell): deaths for cell in CELLS}),
        "life": lambda: life_figure(trace(300), **MIND, world=worlds[0], title="A life"),
        "life_alone": lambda: life_figure(trace(300), **MIND),
        "ratio": lambda: ratio_figure(ratios(5), marks=[Mark("World 1", 8, 2.0)]),
        "networks": lambda: networks_figure(
            ("eat", "shelter", "interact"),
            ("shape", "size"),
            [(rng.normal(size=(2, 3)), rng.normal(size=3)) for _ in range(3)],
            rng.random((3, len(SURFACE), len(SURFACE))),
            {"TS": (np.zeros(2), [0.1, 0.5, 1.0]), "CL": (np.ones(2), [0.1, 0.5, 1.0])},
        ),
        "networks_of_many": lambda: networks_figure(
            ("eat", "shelter"),
            ("shape", "size", "colour"),
            [(rng.normal(size=(4, 4)), rng.normal(size=5)) for _ in range(2)],
            None,
            {name: (np.zeros(3), [0.1, 0.5]) for name in ("TS", "TL", "CS", "CL")},
        ),
    }


NAMES = (
    "worlds", "learning", "lifespans", "learning_curve", "survival", "survival_log",
    "survival_levels", "factor_effects", "interaction", "interaction_words", "trend", "causes",
    "life", "life_alone", "ratio", "networks", "networks_of_many",
)  # fmt: skip


# Pictures with hatches, with clipped parts and with parts of parts: what SVG names by its place.
@pytest.mark.parametrize("name", ["worlds", "causes", "learning", "life"])
def test_the_same_data_give_the_same_picture(drawings, name):
    pictures = {style.svg(drawings[name]()) for _ in range(2)}
    assert len(pictures) == 1


def test_a_figure_is_saved_twice_the_same_as_svg_and_png(drawings, tmp_path):
    once = style.save(drawings["lifespans"](), tmp_path / "once")
    again = style.save(drawings["lifespans"](), tmp_path / "again")
    assert [path.name for path in once] == ["once.svg", "once.png"]
    assert once[0].read_bytes().startswith(b"<?xml")
    assert once[1].read_bytes().startswith(b"\x89PNG")
    for one, other in zip(once, again, strict=True):
        assert one.read_bytes() == other.read_bytes()


@pytest.mark.parametrize("name", NAMES)
def test_every_word_lies_inside_the_picture_and_can_be_read(drawings, name):
    assert set(NAMES) == set(drawings)
    fig = drawings[name]()
    canvas = FigureCanvasAgg(fig)
    canvas.draw()
    renderer = canvas.get_renderer()
    whole = fig.bbox
    words = [text for text in fig.findobj(Text) if text.get_visible() and text.get_text().strip()]
    assert words
    for text in words:
        assert text.get_fontsize() >= 8
        box = text.get_window_extent(renderer)
        if box.width == 0 or text.get_text() in hidden_ticks(fig):
            continue
        inside = (
            box.x0 >= whole.x0 - 1
            and box.x1 <= whole.x1 + 1
            and box.y0 >= whole.y0 - 1
            and box.y1 <= whole.y1 + 1
        )
        assert inside, (text.get_text(), box, whole)


def hidden_ticks(fig):
    """Labels of ticks outside an axis's limits, which matplotlib keeps but does not draw."""
    hidden = set()
    for ax in fig.axes:
        for axis, limits in ((ax.xaxis, ax.get_xlim()), (ax.yaxis, ax.get_ylim())):
            low, high = sorted(limits)
            hidden |= {
                tick.label1.get_text()
                for tick in axis.get_major_ticks()
                if not low <= tick.get_loc() <= high
            }
    return hidden


def test_no_figure_needs_pyplot():
    modules = (
        "causes columns factor_effects learning life marginal ratio sobol specification style"
        " survival verdicts worlds"
    )
    code = "; ".join(f"import animat.figures.{name}" for name in modules.split())
    code += "; import sys; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_the_users_own_settings_neither_show_nor_change(drawings, monkeypatch):
    expected = style.png(drawings["lifespans"]())
    with matplotlib.rc_context({"axes.facecolor": "red", "font.size": 20.0}):
        before = dict(matplotlib.rcParams)
        got = style.png(drawings["lifespans"]())
        assert dict(matplotlib.rcParams) == before
    assert got == expected


def test_a_life_of_one_step_can_be_drawn(trace):
    row = trace(50).slice(0, 1)
    fig = life_figure(row, **MIND)
    assert style.png(fig, dpi=50).startswith(b"\x89PNG")
    assert any(line.get_xdata().size for ax in fig.axes for line in ax.lines)


def test_a_long_life_does_not_make_a_heavy_picture(trace, world):
    part = trace(4_000)
    long = pa.concat_tables([part] * 25)
    long = long.set_column(0, "step", pa.array(range(len(long))))
    fig = life_figure(long, **MIND, world=world("World", 5))
    assert len(style.svg(fig)) < 2_000_000


def test_a_dictionary_encoded_trace_is_drawn_alike(trace):
    plain = trace(600)
    encoded = plain
    for name in ("behaviour", "object", "event"):
        place = encoded.schema.get_field_index(name)
        encoded = encoded.set_column(place, name, pa.chunked_array(
            [chunk.dictionary_encode() for chunk in encoded.column(name).chunks]))  # fmt: skip
    assert style.svg(learning_figure(plain)) == style.svg(learning_figure(encoded))

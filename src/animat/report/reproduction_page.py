"""A reproduction as a directory: tables, figures, verdicts, settings and one page."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import tomli_w
from matplotlib.figure import Figure

from animat.experiments.reproduction import PAPERS_LIVES, Reproduction
from animat.figures.causes import causes_figure
from animat.figures.learning import learning_figure
from animat.figures.learning_curve import learning_curve_figure
from animat.figures.lifespans import Bar, Panel, lifespans_figure
from animat.figures.style import save
from animat.figures.survival import survival_figure
from animat.figures.worlds import worlds_figure
from animat.files.provenance import provenance
from animat.life.drawing import robot_drawing, world_drawing
from animat.life.likelihoods import afforded
from animat.life.scenario import bring_together
from animat.report import page
from animat.report.inputs import inputs_sections
from animat.report.readings_taken import CALIBRATED, ERRATA, readings
from animat.statistics.lives import cells
from animat.statistics.paper_claims import claims_json
from animat.statistics.survival import kaplan_meier

FIGURES: dict[str, tuple[str, str]] = {
    "figure2_worlds": (
        "Figure 2. World 1, abundant, and World 2, scarce, to scale, with a robot and the reach"
        " of its infrared sensors.",
        "The two worlds drawn to scale",
    ),
    "figure3_grasp": (
        "Figure 3. The last 500 steps of a learning robot, the one that did most in them: object"
        " type, nutrition, hunger, learning reward, grasp likelihood. Shaded: the robot eats; at"
        " other times the network holds its value.",
        "Five signals over the last 500 steps",
    ),
    "figure4_shelter": (
        "Figure 4. The same for shelter: object type, stamina, fatigue, learning reward, shelter"
        " likelihood.",
        "Five signals over the last 500 steps",
    ),
    "learning_curve": (
        "What the networks say of each object type, over the acts each has learnt from; mean and"
        " spread over robots.",
        "Likelihood against episodes for the three networks",
    ),
    "figure5_lifespans": (
        "Figure 5. Mean lifespans with 95 % intervals, bars paired by world: as many lives as the"
        " paper's, and all lives.",
        "Bars of mean lifespans",
    ),
    "survival": (
        "Survival curves (Kaplan-Meier) with 95 % bands. Lives that reach the cap are censored"
        " there.",
        "Share of lives still going on over steps",
    ),
    "causes": ("How the lives ended.", "Stacked bars of causes of death"),
}
"""Every figure by the name of its file: caption, and words in its place."""


def publish(result: Reproduction, directory: Path, tell: Callable[[], None]) -> None:
    """Write everything into `directory`, which must be there. `tell` is called per figure.

    Raises OSError or SettingsError if it cannot be written.
    """
    pq.write_table(result.lives, directory / "lives.parquet")
    pq.write_table(result.learnt.final, directory / "likelihoods.parquet")
    pq.write_table(result.learnt.curve, directory / "learning_curve.parquet")
    pq.write_table(result.learnt.trace, directory / "last_steps.parquet")
    (directory / "claims.json").write_text(claims_json(result.claims), encoding="utf-8")
    settings = result.settings.model_dump(mode="json", exclude_none=True)
    (directory / "settings.toml").write_text(tomli_w.dumps(settings), encoding="utf-8")
    made = provenance() | {"seed": result.seed, **result.size._asdict()}
    (directory / "how_made.json").write_text(json.dumps(made, indent=2) + "\n", encoding="utf-8")
    for world in result.worlds:
        world.save(directory / f"world_{world.name}.toml")
    pictures = []
    for name, figure in _figures(result):
        drawn, _ = save(figure, directory / name)
        caption, words = FIGURES[name]
        pictures.append(page.picture_file(drawn, caption, words))
        tell()
    page.write_page(
        directory / "report.html",
        "Motivation-driven learning of object affordances: a reproduction",
        [*_sections(result, pictures, made), *inputs_sections(directory)],
        lead=_lead(result),
    )
    tell()


def _figures(result: Reproduction) -> list[tuple[str, Figure]]:
    truth = _truth(result)
    types = [one.name for one in result.worlds[0].types]
    curves = {key: kaplan_meier(rows) for key, rows in cells(result.lives)}
    drawings = [
        world_drawing(world, title, pose)
        for world, title, pose in zip(
            result.worlds,
            ("World 1, abundant", "World 2, scarce"),
            _first_poses(result),
            strict=True,
        )
    ]
    panels = [
        Panel(title, [Bar(one.cell[0], one.cell[1], one.mean) for one in summaries])
        for title, summaries in (
            (f"{PAPERS_LIVES} lives a cell, as in the paper", result.papers),
            (f"{result.size.lives:,} lives a cell", result.summaries),
        )
    ]
    figure4 = learning_figure(
        result.learnt.trace,
        variable="stamina",
        drive="fatigue",
        behaviour="shelter",
        affordance="shelter",
        types=types,
    )
    return [
        ("figure2_worlds", worlds_figure(drawings, robot_drawing(result.settings.robot))),
        ("figure3_grasp", learning_figure(result.learnt.trace, types=types)),
        ("figure4_shelter", figure4),
        ("learning_curve", learning_curve_figure(result.learnt.curve, afforded=truth)),
        ("figure5_lifespans", lifespans_figure(panels)),
        ("survival", survival_figure(curves, log=True)),
        (
            "causes",
            causes_figure({" ".join(one.cell[::-1]): one.deaths for one in result.summaries}),
        ),
    ]


def _truth(result: Reproduction) -> dict[tuple[str, str], float]:
    mind = result.settings.mind.model_copy(update={"agent": "BLIND"})
    setting = bring_together(mind, result.worlds[0], result.settings.robot)
    truth = afforded(setting)
    return {
        (behaviour, kind.name): float(truth[b, t])
        for b, behaviour in enumerate(mind.behaviours)
        for t, kind in enumerate(result.worlds[0].types)
    }


def _first_poses(result: Reproduction) -> list[tuple[float, float, float]]:
    """Return where life 0 starts in either world."""
    poses = []
    for world in result.worlds:
        mind = result.settings.mind.model_copy(update={"agent": "BLIND"})
        setting = bring_together(mind, world, result.settings.robot)
        states, _ = setting.begin(result.seed, np.zeros(1, np.uint64))
        poses.append((float(states[0].x), float(states[0].y), float(states[0].heading)))
    return poses


def _lead(result: Reproduction) -> list[str]:
    verdicts = [claim.verdict for claim in result.claims]
    told = ", ".join(
        f"{verdicts.count(v)} {w}"
        for v, w in (("holds", "hold"), ("fails", "fail"), ("undecided", "are undecided"))
    )
    return [
        f"Of the paper's seven claims, {told} under the readings below:"
        f" {result.size.robots} robots that learn, then {result.size.lives:,} lives in each of the"
        f" four cells, up to {result.size.steps:,} steps each.",
        *([f"{result.failed:,} lives failed and are left out."] if result.failed else []),
    ]


def _sections(
    result: Reproduction, pictures: list[page.Picture], made: dict[str, object]
) -> list[page.Section]:
    tests = page.TableBlock(
        ("World", "Log-rank statistic", "p"),
        [
            (world, f"{test.statistic:.2f}", page.p_value(test.p))
            for world, test in result.tests.items()
        ],
        "BLIND against AF: do their lives end alike?",
    )
    taken = page.TableBlock(
        ("What the paper leaves open", "Setting", "Reading taken"),
        readings(result.settings.mind, result.settings.robot),
    )
    return [
        page.claims_section(result.claims),
        page.Section("The worlds", pictures=pictures[:1], paragraphs=[CALIBRATED]),
        page.Section("Experiment 1: can affordances be learnt?", pictures=pictures[1:4]),
        page.Section(
            "Experiment 2: does knowing affordances lengthen life?",
            pictures=pictures[4:],
            tables=[tests],
        ),
        page.cells_section(result.summaries, "All lives"),
        page.cells_section(result.papers, f"The first {PAPERS_LIVES} lives of each cell"),
        page.Section("The readings taken", tables=[taken]),
        page.Section("What the paper has wrong or leaves out", items=ERRATA),
        page.Section(
            "How this was made",
            paragraphs=[
                "settings.toml and how_made.json beside this page say how, experiment1 and"
                " experiment2 hold the results of both studies;"
                f" animat reproduce --settings settings.toml --seed {result.seed}"
                f" --lives {result.size.lives} --seeds {result.size.robots}"
                f" --steps {result.size.steps} makes the same numbers again."
            ],
            code=json.dumps(made, indent=2),
        ),
    ]

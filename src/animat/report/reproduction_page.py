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
from animat.figures.learning import learning_curve_figure, learning_figure
from animat.figures.style import save
from animat.figures.survival import Bar, Panel, lifespans_figure, survival_figure
from animat.figures.worlds import worlds_figure
from animat.files.provenance import provenance
from animat.life.drawing import robot_drawing, world_drawing
from animat.life.likelihoods import afforded
from animat.life.scenario import bring_together
from animat.report import page
from animat.report.inputs import inputs_of
from animat.report.readings_taken import readings
from animat.statistics.lives import cells
from animat.statistics.paper_claims import claims_json
from animat.statistics.survival import kaplan_meier

FIGURES = (
    "figure2_worlds",
    "figure3_grasp",
    "figure4_shelter",
    "learning_curve",
    "figure5_lifespans",
    "survival",
    "causes",
)
"""Every figure by the name of its file."""


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
    pictures = {}
    for name, figure in _figures(result):
        drawn, _ = save(figure, directory / name)
        pictures[name] = page.address_of(drawn)
        tell()
    page.write_page(
        directory / "report.html",
        "reproduction",
        result=result,
        size=result.size,
        verdicts=[claim.verdict for claim in result.claims],
        pictures=pictures,
        papers_lives=PAPERS_LIVES,
        readings=readings(result.settings.mind, result.settings.robot),
        made=json.dumps(made, indent=2),
        files=inputs_of(directory),
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
    drawn = (
        worlds_figure(drawings, robot_drawing(result.settings.robot)),
        learning_figure(result.learnt.trace, types=types),
        figure4,
        learning_curve_figure(result.learnt.curve, afforded=truth),
        lifespans_figure(panels),
        survival_figure(curves, log=True),
        causes_figure({" ".join(one.cell[::-1]): one.deaths for one in result.summaries}),
    )
    return [*zip(FIGURES, drawn, strict=True)]


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

"""What networks came to say of the objects, over the lives or the robots that learnt."""

from collections.abc import Mapping

import numpy as np
import pyarrow as pa

from animat.figures.learning_curve import learning_curve_figure
from animat.report.page import Picture, Section, TableBlock, interval, picture
from animat.statistics.estimates import mean
from animat.statistics.lives import column

PREFIX = "likelihood_"


def learnt_section(teachers: pa.Table | None, curves: Mapping[str, pa.Table]) -> Section | None:
    """What robots had learnt before the lives began, and how the networks of lives came to know.

    `teachers` has a row for each robot, with a column likelihood_NETWORK_OBJECT for each network
    and object type; `curves` are tables as in `learning_curve_figure`, by what they are of. None
    if there is nothing to tell.
    """
    tables = [_robots(teachers)] if teachers is not None and teachers.num_rows else []
    pictures = [_curve(name, table) for name, table in curves.items()]
    if not tables and not pictures:
        return None
    return Section("What the networks learnt", tables=tables, pictures=pictures)


def _robots(teachers: pa.Table) -> TableBlock:
    rows = []
    for name in teachers.column_names:
        if name.startswith(PREFIX):
            network, _, thing = name.removeprefix(PREFIX).rpartition("_")
            values = column(teachers, name).astype(np.float64)
            known = values[~np.isnan(values)]
            if len(known):
                rows.append((network, thing, interval(mean(known), ".2f")))
    return TableBlock(
        ("Network", "Object", "Mean likelihood"),
        rows,
        f"The {teachers.num_rows:,} robots whose networks AF has, when they had learnt.",
        title="Robots that taught",
    )


def _curve(name: str, table: pa.Table) -> Picture:
    return picture(
        learning_curve_figure(table),
        f"What the networks say of each object type, over the acts each has learnt from; mean and"
        f" the middle 90 % of lives ({name}).",
        f"Likelihood against episodes, {name}",
    )

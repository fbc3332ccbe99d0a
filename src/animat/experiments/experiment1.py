"""Experiment 1: can affordances be learnt? (paper, "First Experiment Set"; Figures 3 and 4)

Robots of the kind LEARNING live in World 1 for 300,000 steps without dying. Reported are what
their networks say of every object type at the end, how that came about over the episodes of each
network, and the last steps of one robot. The study itself is files/experiment1.toml.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from animat.life.likelihoods import afforded
from animat.life.scenario import bring_together
from animat.study.plan.columns import long_table
from animat.study.store.results import Results


class Learnt(NamedTuple):
    """What came of Experiment 1.

    `final` (seed, network, object, likelihood, afforded) and `curve` (seed, episode, network,
    object, likelihood) have a row for each network and object type, an episode being an act of the
    network's behaviour; `seed` is the number of the robot. `trace` holds the last steps of the
    robot `shown`, the first of those that ran most of the behaviours, and most often, in these
    steps. Robots that failed are left out.
    """

    final: pa.Table
    curve: pa.Table
    shown: int
    trace: pa.Table


def learnt(results: Results) -> Learnt:
    """Return what came of Experiment 1 from the results of its study."""
    whole = pc.field("error").is_null()
    lives = results.lives(where=whole)
    settings = results.study
    setting = bring_together(settings.mind, settings.world.world(), settings.robot)
    names = [
        f"likelihood_{behaviour}_{kind.name}"
        for behaviour in setting.mind.behaviours
        for kind in setting.world.types
    ]
    said = np.stack([lives[name].to_numpy() for name in names], axis=1)
    said = said.reshape(len(said), len(setting.mind.behaviours), len(setting.world.types))
    truth = np.broadcast_to(afforded(setting), said.shape)
    final = long_table(setting, said, {"seed": lives["life"].to_numpy()})
    curve = results.curves().drop_columns("case").rename_columns({"life": "seed"})
    traces = results.traces().drop_columns("case")
    shown = _busiest(traces, list(setting.mind.behaviours))
    trace = traces.filter(pc.field("life") == shown).drop_columns("life")
    return Learnt(
        final.append_column("afforded", pa.array(truth.ravel())),
        curve,
        shown,
        trace.unify_dictionaries(),
    )


def _busiest(traces: pa.Table, behaviours: list[str]) -> int:
    """Return the life that ended acts of the most behaviours, and the most acts, in its trace."""
    lives = np.unique(traces["life"].to_numpy())
    acts = traces.filter(pc.field("reward") != 0)
    life = acts["life"].to_numpy()
    done = np.array(acts["behaviour"].to_pylist(), object)
    counts = np.array([[np.sum((life == n) & (done == b)) for b in behaviours] for n in lives])
    return int(lives[np.argmax(traces.num_rows * (counts > 0).sum(axis=1) + counts.sum(axis=1))])

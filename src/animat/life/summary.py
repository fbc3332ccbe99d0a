"""What is counted of a life: a row of the table of lives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.mind.homeostasis import FAILURE, METABOLISM, SUCCESS
from animat.mind.mind import Mind
from animat.names import LIVES, spelled

if TYPE_CHECKING:
    from animat.life.scenario import Setting

CAUSES = {METABOLISM: "metabolism", SUCCESS: "success", FAILURE: "failure"}
SIDES = ("low", "high")

NAMES = ("world", "agent", "seed", "life")
"""The columns that tell which life a row is of; a life that failed has them too."""


def death_of(state: np.record, mind: Mind) -> str | None:
    """Return what a life died of in words, or None."""
    if not state.dead:
        return None
    variable = list(mind.resolved_variables())[state.death_variable]
    return f"{variable} {SIDES[state.death_side]}, {CAUSES[int(state.death_cause)]}"


def summary(
    setting: Setting, seed: int, lives: NDArray, states: NDArray[np.void]
) -> dict[str, pa.Array]:
    """Return the columns of a table of lives for L lives that ended in `states` [L].

    Counts are whole numbers; `mean_drive`, the physiological stability of (2010), is the mean over
    the life of the mean of the drives, lower is better; `censored` lives were alive at the cap.
    """
    mind = setting.mind
    dead = states["dead"]
    steps = states["step"]
    variables = list(mind.resolved_variables())
    columns = {
        "world": _constant(setting.world.name, len(states)),
        "agent": _constant(mind.agent, len(states)),
        "seed": pa.array(np.full(len(states), seed, np.uint64)),
        "life": pa.array(lives.astype(np.int64)),
        "lifespan": pa.array(steps),
        "censored": pa.array(~dead),
        "death_variable": _chosen(states["death_variable"], variables, dead),
        "death_side": _chosen(states["death_side"], SIDES, dead),
        "death_cause": _chosen(states["death_cause"] - METABOLISM, list(CAUSES.values()), dead),
        "encounters": pa.array(states["encounters"]),
        "acts": pa.array(states["acts"]),
        "successes": pa.array(states["successes"]),
        "failures": pa.array(states["acts"] - states["successes"]),
        "disregarded": pa.array(states["disregarded"]),
        "unreached": pa.array(states["unreached"]),
        "blocked": pa.array(states["blocked"]),
        "trainings": pa.array(states["trainings"]),
        "mean_drive": pa.array(states["drive_sum"] / np.maximum(steps, 1)),
    }
    for b, behaviour in enumerate(mind.behaviours):
        columns[f"acts_{behaviour}"] = pa.array(states["acts_by_behaviour"][:, b])
        columns[f"successes_{behaviour}"] = pa.array(states["successes_by_behaviour"][:, b])
    return {name: columns[name] for name in spelled(LIVES, behaviour=mind.behaviours)}


def without_failed(
    columns: Mapping[str, pa.Array], errors: Sequence[str | None], names: Sequence[str]
) -> dict[str, pa.Array]:
    """Return columns of L lives with one more, `error`, of `errors` [L].

    A life that failed, whose error is not None, keeps only what is in the columns of these names.
    """
    count = len(errors)
    if not any(errors):
        return {**columns, "error": pa.nulls(count, pa.string())}
    there = pa.array(np.arange(count), mask=np.array([bool(each) for each in errors], bool))
    masked = {
        name: values if name in names else values.take(there) for name, values in columns.items()
    }
    return {**masked, "error": pa.array(errors, pa.string())}


def _constant(text: str, count: int) -> pa.Array:
    return pa.DictionaryArray.from_arrays(pa.array(np.zeros(count, np.int32)), pa.array([text]))


def _chosen(codes: NDArray, names: list[str] | tuple[str, ...], there: NDArray) -> pa.Array:
    indices = pa.array(codes.astype(np.int32), mask=~there)
    return pa.DictionaryArray.from_arrays(indices, pa.array(names))

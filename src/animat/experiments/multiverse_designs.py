"""Studies made from the study of a multiverse: of another size, restricted, in full.

Each is a study like any other, so that it is simulated, stored and resumed in the same way.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any, NamedTuple

from animat.experiments.universes import CELL, label, readings_of, spread_factors
from animat.files.settings import validated
from animat.statistics.claims import CELLS
from animat.study.file.axes import axes, combinations, is_whole, left_out
from animat.study.file.factors import Range
from animat.study.file.keys import read_key
from animat.study.file.sampling import MOST_POINTS
from animat.study.file.study import Study

PORTION = 20_000
"""Cases of a portion of the full product, at most, those left out included."""

GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
"""Its multiples lie evenly in [0, 1)."""

FRESH = 1_000_003
"""Added to the seed of a study, and of its sample, where fresh random numbers are wanted."""


class Portion(NamedTuple):
    """A portion of the full product: its name, and the study of it."""

    name: str
    study: Study


def of_size(study: Study, universes: int) -> Study:
    """Return the study with so many points that about so many universes are not left out.

    Points are a power of two, as Sobol's sequence wants them.
    """
    counts = {}
    points = 8
    while points <= MOST_POINTS:
        counts[points] = count(with_points(study, points))
        if counts[points] > universes:
            break
        points *= 2
    near = min(counts, key=lambda points: abs(math.log((counts[points] or 0.5) / universes)))
    return with_points(study, near)


def count(study: Study) -> int:
    """Return how many universes of a study its rules do not leave out."""
    grid = {name: levels for name, levels in study.design.grid.items() if name != CELL}
    design = study.design.model_copy(update={"grid": grid})
    along = axes(design, study)
    return sum(left_out(design, along, one) is None for one in combinations(along))


def with_points(study: Study, points: int) -> Study:
    """Return the study with another number of points in its sample."""
    sample = study.design.sample
    assert sample is not None
    sample = sample.model_copy(update={"points": points})
    return study.model_copy(update={"design": study.design.model_copy(update={"sample": sample})})


def longer(study: Study, universes: int, steps: int) -> Study:
    """Return a study of the first universes of another, their lives cut at another step.

    The points of a sample begin like those of a larger one with the same seed.
    """
    late = study.model_copy(update={"steps": steps})
    return with_points(late, min(_points(of_size(late, universes)), _points(study)))


def _points(study: Study) -> int:
    assert study.design.sample is not None
    return study.design.sample.points


def fresh(study: Study, allowed: Mapping[str, Sequence[str]], universes: int) -> Study:
    """Return a study with other points and random numbers, in which some readings are restricted.

    `allowed` are the labels of the values that a reading may have, by its name.
    """
    factors = {reading.name: reading.factor for reading in readings_of(study)}
    data = tomllib.loads(study.to_toml())
    data["seed"] = study.seed + FRESH
    data["design"]["sample"]["seed"] += FRESH
    kept = {factors[name]: set(labels) for name, labels in allowed.items()}
    _restrict(data["design"], data["design"]["sample"]["over"], kept)
    return of_size(validated(data, Study), universes)


def portions(study: Study) -> Iterator[Portion]:
    """Yield the full product of all readings, in portions that a machine can plan at a time.

    In a portion the first readings have one value each. What is spread over a range in the
    sample, such as the seed of a layout, is drawn once for each portion.
    """
    readings = readings_of(study)
    fixed = 0
    while math.prod(len(r.values) for r in readings[fixed:]) * len(CELLS) > PORTION:
        fixed += 1
    whole = tomllib.loads(study.to_toml())
    ranges = {n: r for n, r in spread_factors(study).items() if isinstance(r, Range)}
    spread = whole["design"].pop("sample", {"over": {}})["over"]
    grid = whole["design"].pop("grid")
    for number, values in enumerate(product(*(r.labels for r in readings[:fixed])), start=1):
        data = {**whole, "design": {**whole["design"], "grid": {**grid, **spread}}}
        for name, one in ranges.items():
            share = (number * GOLDEN) % 1.0
            data["design"]["grid"][name] = [one.at(share, is_whole(read_key(name)))]
        kept = {r.factor: {value} for r, value in zip(readings, values, strict=False)}
        data["design"]["exclude"] = [dict(rule) for rule in whole["design"].get("exclude", [])]
        _restrict(data["design"], data["design"]["grid"], kept)
        portion = validated(data, Study)
        if count(portion):
            yield Portion(f"{number:06d}", portion)


def _restrict(
    design: dict[str, Any], factors: dict[str, Any], kept: Mapping[str, set[str]]
) -> None:
    """Keep only some values of some factors, and of every rule what it says of these."""
    for name, labels in kept.items():
        levels = factors[name]
        factors[name] = (
            {level: changes for level, changes in levels.items() if level in labels}
            if isinstance(levels, dict)
            else [value for value in levels if label(value) in labels]
        )
    rules = []
    for rule in design.get("exclude", []):
        when = {}
        for name, given in rule["when"].items():
            values = given if isinstance(given, list) else [given]
            when[name] = [v for v in values if name not in kept or label(v) in kept[name]]
        if all(when.values()):
            rules.append({**rule, "when": when})
    design["exclude"] = rules

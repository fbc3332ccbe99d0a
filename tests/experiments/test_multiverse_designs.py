from itertools import product

import numpy as np
import pytest

from animat.experiments import multiverse_designs as designs
from animat.experiments.multiverse_designs import (
    count,
    fresh,
    longer,
    of_size,
    portions,
    with_points,
)
from animat.experiments.universes import label, readings_of
from animat.files.settings import validated
from animat.statistics.readings import fewest_together
from animat.study.file.axes import axes, combinations, factors, left_out
from animat.study.file.cases import cases
from animat.study.file.study import Study

FEWEST = 20
"""Universes in which every two values are to meet."""


def universes(study):
    """The labels of all readings of the universes of a study, without its cells."""
    grid = {name: levels for name, levels in study.design.grid.items() if name != "cell"}
    design = study.design.model_copy(update={"grid": grid})
    along = axes(design, study)
    named = (
        factors(along, one) for one in combinations(along) if left_out(design, along, one) is None
    )
    return [tuple(label(one[r.factor]) for r in readings_of(study)) for one in named]


def codes(study):
    values = [reading.labels for reading in readings_of(study)]
    return np.array(
        [[v.index(one) for v, one in zip(values, row, strict=True)] for row in universes(study)]
    )


def test_the_default_has_about_2000_universes_and_every_pair_of_values_20_times(small):
    study = with_points(small, 4096)
    code = codes(study)
    assert 1_800 <= len(code) <= 2_200
    assert fewest_together(code) >= FEWEST
    # Of all pairs of values only those that a rule names never meet.
    readings = readings_of(study)
    never = []
    for one, other in product(range(len(readings)), repeat=2):
        if one < other:
            met = set(map(tuple, code[:, [one, other]].tolist()))
            sizes = (len(readings[place].values) for place in (one, other))
            never += [
                {readings[one].labels[a], readings[other].labels[b]}
                for a, b in product(*map(range, sizes))
                if (a, b) not in met
            ]
    assert sorted(map(sorted, never)) == sorted(
        map(
            sorted, [{"excess", "0.01"}, {"linear", "0.01"}, {"0", "clamp"}, {"absolute", "always"}]
        )
    )


def test_a_size_is_met_as_nearly_as_powers_of_two_allow(small):
    for wanted in (10, 30, 100):
        study = of_size(small, wanted)
        assert count(study) == len(cases(study)) / 4
        ratio = count(study) / wanted
        assert 0.6 < ratio < 1.6


def test_a_longer_study_begins_with_the_same_universes(small):
    late = longer(small, 4, 9_000)
    assert late.steps == 9_000
    few, many = universes(late), universes(small)
    assert len(few) < len(many)
    assert few == many[: len(few)]
    assert count(longer(small, 1_000, 9_000)) == count(small)


def test_fresh_universes_meet_the_conditions_and_share_no_luck(small):
    allowed = {"overflow": ("clamp",), "physiology": ("excess", "linear")}
    again = fresh(small, allowed, 20)
    assert {one[2] for one in universes(again)} == {"clamp"}
    assert {one[0] for one in universes(again)} == {"excess", "linear"}
    # Rules speak only of values that are left.
    assert len(again.design.exclude) == 3
    margin = again.design.exclude[0].when
    assert margin["mind.physiology"] == ["excess", "linear"]
    falling = fresh(small, {"physiology": ("decay",)}, 20)
    assert len(falling.design.exclude) == 2
    assert again.seed != small.seed
    assert again.design.sample.seed != small.design.sample.seed
    assert cases(again)[0].seed == again.seed
    old = {(case.settings.world.seed, case.settings.world.layout) for case in cases(small)}
    new = {(case.settings.world.seed, case.settings.world.layout) for case in cases(again)}
    assert not old & new


def test_nothing_restricted_is_the_same_multiverse_with_other_points(small):
    again = fresh(small, {}, count(small))
    assert readings_of(again) == readings_of(small)
    assert universes(again) != universes(small)


@pytest.fixture
def tiny(small) -> Study:
    data = small.model_dump(mode="json", exclude_none=True)
    over = data["design"]["sample"]["over"]
    kept = ("mind.physiology", "mind.lethal_margin", "mind.overflow", "objects", "worlds.rich.seed",
            "abundant world", "scarce world")  # fmt: skip
    data["design"]["sample"]["over"] = {name: over[name] for name in kept}
    data["design"]["exclude"] = data["design"]["exclude"][:1]
    return validated(data, Study)


@pytest.mark.parametrize("portion", [10_000, 200, 30])
def test_portions_are_the_full_product_each_universe_once(tiny, monkeypatch, portion):
    monkeypatch.setattr(designs, "PORTION", portion)
    parts = list(portions(tiny))
    rows = [one for part in parts for one in universes(part.study)]
    # Four physiologies, of which two have one margin, and four readings beside.
    assert len(rows) == len(set(rows)) == 6 * 2 * 2 * 4 * 3
    assert all(len(cases(part.study)) <= portion for part in parts)
    assert len({part.name for part in parts}) == len(parts)
    assert (len(parts) > 1) == (portion < 10_000)
    seeds = [part.study.design.grid["worlds.rich.seed"] for part in parts]
    assert len({seed for (seed,) in seeds}) == len(parts)
    assert parts[0].study.lives == tiny.lives


def test_the_full_product_of_what_ships_is_cut_into_portions(small):
    first = next(portions(small))
    assert count(first.study) * 4 <= designs.PORTION

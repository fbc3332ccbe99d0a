"""Points spread over a cube, held against what scipy says of their spread."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import qmc

from animat.files.settings import SettingsError
from animat.study.file.sampling import Sample


def sample(method: str, points: int, over: int = 3, seed: int = 0) -> Sample:
    factors = {f"f{number}": {"low": 0, "high": 1} for number in range(over)}
    return Sample(method=method, points=points, seed=seed, over=factors)  # pyright: ignore


@pytest.mark.parametrize("method", ["sobol", "latin_hypercube"])
def test_points_are_a_function_of_the_seed(method):
    one, again, other = (sample(method, 16, seed=seed).shares() for seed in (1, 1, 2))
    assert one.shape == (16, 3)
    assert (one == again).all()
    assert (one != other).any()
    assert ((one >= 0.0) & (one < 1.0)).all()


@pytest.mark.parametrize("method", ["sobol", "latin_hypercube"])
def test_every_sixteenth_of_every_factor_has_one_of_sixteen_points(method):
    shares = sample(method, 16, over=5, seed=3).shares()
    assert (np.sort((shares * 16).astype(int), axis=0) == np.arange(16)[:, None]).all()


@pytest.mark.parametrize("method", ["sobol", "latin_hypercube"])
def test_points_are_spread_more_evenly_than_by_chance(method):
    chance = [qmc.discrepancy(np.random.default_rng(i).random((64, 2))) for i in range(20)]
    assert qmc.discrepancy(sample(method, 64, over=2).shares()) < min(chance)


def test_sobol_points_fill_every_box_of_the_plane():
    """A net in base 2: each of the 16 boxes, however long or wide, has one of 16 points."""
    x, y = sample("sobol", 16, over=2, seed=5).shares().T
    for wide in (1, 2, 4, 8, 16):
        boxes = set(zip((x * wide).astype(int), (y * (16 // wide)).astype(int), strict=True))
        assert len(boxes) == 16


def test_sobol_points_come_in_powers_of_two():
    with pytest.raises(SettingsError, match="the nearest are 32 and 64"):
        sample("sobol", 60)
    assert sample("latin_hypercube", 60).shares().shape == (60, 3)


@pytest.mark.parametrize("points", [0, -1, 65_537, 1 << 40])
def test_there_are_points_and_not_too_many(points):
    with pytest.raises(SettingsError):
        sample("latin_hypercube", points)


def test_points_are_spread_over_something():
    with pytest.raises(SettingsError, match="at least 1 item"):
        sample("sobol", 4, over=0)

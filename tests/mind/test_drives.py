import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from animat.mind.drives import absolute, raise_drives, rectified, signed, strongest
from animat.mind.functions import unused_drives, unused_law
from animat.mind.homeostasis import metabolise
from animat.mind.mind import Mind
from animat.mind.parameters import parameters
from animat.numerics.compiled import compiled

AFFORDANCES = ("grasp", "shelter", "interact")
NUMBERS = st.floats(-2.0, 2.0)


@st.composite
def needs(draw):
    """Values, changes, set points and senses [V], and coefficients a and b [D, V]."""
    d, v = draw(st.integers(1, 6)), draw(st.integers(1, 6))
    rows = [draw(arrays.arrays(float, v, elements=NUMBERS)) for _ in range(3)]
    senses = draw(arrays.arrays(float, v, elements=st.sampled_from([1.0, -1.0])))
    tables = [draw(arrays.arrays(float, (d, v), elements=NUMBERS)) for _ in range(2)]
    return *rows, senses, *tables


@given(needs())
@pytest.mark.parametrize(
    ("function", "shaped"),
    [
        (signed, lambda error: error),
        (rectified, lambda error: np.clip(error, 0.0, None)),
        (absolute, np.abs),
    ],
)
def test_drives_are_equation_3_in_matrix_form(function, shaped, need):
    values, changes, set_points, senses, a, b = need
    out = np.full(len(a), np.nan)
    function(values, changes, set_points, senses, a, b, out)
    error = shaped(senses * (set_points - values))
    np.testing.assert_allclose(out, a @ error + b @ changes, atol=1e-12)


@pytest.mark.parametrize(
    ("error", "wanted"),
    [
        ("signed", [-0.05, 0.3, -0.05]),
        ("rectified", [0.0, 0.3, 0.0]),
        ("absolute", [0.05, 0.3, 0.05]),
    ],
)
def test_a_mind_takes_errors_past_the_set_point_as_it_is_told(error, wanted):
    record = parameters(Mind(error=error), AFFORDANCES)
    out = np.zeros(3)
    raise_drives(np.array([0.95, 0.5, 0.05]), np.zeros(3), record, out, unused_drives)
    np.testing.assert_allclose(out, wanted, atol=1e-15)


@pytest.mark.parametrize("physiology", ["excess", "decay", "relax", "linear"])
def test_a_drive_is_positive_where_an_act_that_serves_it_would_help(physiology):
    record = parameters(Mind(physiology=physiology), AFFORDANCES)
    out = np.zeros(3)
    needy = record.set_point - 0.05 * record.sense
    raise_drives(needy, np.zeros(3), record, out, unused_drives)
    np.testing.assert_allclose(out, 0.05)
    raise_drives(needy + np.diagonal(record.success), np.zeros(3), record, out, unused_drives)
    np.testing.assert_allclose(out, 0.05 - 0.2)


@pytest.mark.parametrize(("a", "b"), [(1.0, 0.0), (1.0, 50.0), (0.3, -800.0), (0.0, 1.0)])
@pytest.mark.parametrize(("low", "high", "rate"), [(0.0, 1.0, 1e-4), (-1.0, 3.0, 1e-3)])
def test_the_drive_of_a_decaying_variable_follows_equation_4_corrected(a, b, low, high, rate):
    zone = {"low": low, "high": high, "start": high, "set_point": 0.9, "rate": rate}
    mind = Mind(
        variables={"nutrition": zone},
        drives={
            "hunger": {"a": {"nutrition": a}, "b": {"nutrition": b}},
            "fatigue": {"a": {"stamina": 1.0}},
            "curiosity": {"a": {"restlessness": 1.0}},
        },
        death=False,
    )
    record = parameters(mind, AFFORDANCES)
    values = np.array(record.start)
    out = np.zeros(3)
    for step in range(1, 3001):
        before = values.copy()
        metabolise(values, record, unused_law)
        raise_drives(values, values - before, record, out, unused_drives)
        fading = (high - low) * math.exp(-rate * step)
        equation_4 = a * (0.9 - low) - (a + b * rate) * fading
        # A change over the step before is not quite dV/dt at its end.
        second_order = abs(b) * math.exp(rate) * rate**2 / 2 * fading
        assert out[0] == pytest.approx(equation_4, rel=0, abs=second_order + (1 + abs(b)) * 1e-12)
        if b * rate > 1e-3:
            as_printed = a * (0.9 - low) + a * fading + b * rate * math.exp(-rate * step)
            assert out[0] != pytest.approx(as_printed, abs=0.1 * fading)


def test_a_drive_function_of_ones_own_is_used():
    @compiled
    def deadband(values, changes, set_points, senses, a, b, out):
        for d in range(len(out)):
            error = senses[d] * (set_points[d] - values[d])
            out[d] = error if error > 0.1 else a[d, d] * b[d, d] * changes[d]

    record = parameters(Mind(drive_function=deadband.py_func), AFFORDANCES)
    out = np.full(3, np.nan)
    raise_drives(np.array([0.85, 0.5, 0.05]), np.zeros(3), record, out, deadband)
    np.testing.assert_allclose(out, [0.0, 0.3, 0.0])


@given(st.lists(st.integers(-3, 3), min_size=1, max_size=6))
def test_the_strongest_drive_is_the_first_of_equal_ones(drives):
    assert strongest(np.array(drives, float)) == np.argmax(drives)

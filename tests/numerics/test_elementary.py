import math
import os
import platform
import re
import subprocess
import sys

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from animat.numerics.compiled import compiled
from animat.numerics.elementary import exponential, logistic, sine_cosine

QUARTER = math.pi / 2
LARGEST = sys.float_info.max
SMALLEST_NORMAL = sys.float_info.min
N = 4_000 if settings.get_current_profile_name() == "nightly" else 2_000


@compiled
def sines_cosines(angles, out):
    for i in range(angles.size):
        out[i, 0], out[i, 1] = sine_cosine(angles[i])


@compiled
def exponentials(xs, out):
    for i in range(xs.size):
        out[i] = exponential(xs[i])


@compiled
def logistics(xs, out):
    for i in range(xs.size):
        out[i] = logistic(xs[i])


@pytest.fixture(autouse=True)
def high_precision():
    with mpmath.workprec(160):
        yield


def exact(function, xs):
    return [function(mpmath.mpf(float(x))) for x in xs]


def units_off(results, truths):
    """The greatest distance from the truth, in units in the last place of the truth."""
    pairs = zip(results, truths, strict=True)
    off = (float(abs(mpmath.mpf(float(r)) - t) / math.ulp(float(t))) for r, t in pairs)
    return max(off, default=0.0)


def evenly(low, high):
    return np.random.default_rng(1).uniform(low, high, N)


def every_magnitude(high):
    """Both signs, from the smallest floats to `high`, equally many at each order of magnitude."""
    random = np.random.default_rng(2)
    return np.copysign(high * 10 ** random.uniform(-320, 0, N), random.uniform(-1, 1, N))


def near_quarter_turns(largest, offset):
    """Floats within a few units of a multiple of a quarter turn, plus an offset in turns of it."""
    random = np.random.default_rng(3)
    count = int(largest / QUARTER) - 1
    multiples = (random.integers(-count, count + 1, N) + offset) * QUARTER
    return multiples * (1 + random.integers(-4, 5, N) * 2.0**-52)


ANGLES = {
    "heading": evenly(-math.pi, math.pi),
    "near": evenly(-7, 7),
    "far": evenly(-1e5, 1e5),
    "farthest": evenly(-1e6, 1e6),
    "magnitudes": every_magnitude(1e6),
    "roots": near_quarter_turns(8, 0),
    "first roots": near_quarter_turns(20, 0),
    "far roots": near_quarter_turns(1e6, 0),
    "seams": near_quarter_turns(8, 0.5),
    "far seams": near_quarter_turns(1e6, 0.5),
    # The float of this range that is nearest to a multiple of a quarter turn.
    "nearest": np.array([1, -1]) * 6411027962775774.0 * 2.0**-47,
    "limits": [7.0, -7.0, math.nextafter(7, 8), -math.nextafter(7, 8), 1e6, -1e6],
}


@pytest.mark.parametrize("name", ANGLES)
def test_sine_and_cosine_are_within_one_unit(name):
    angles = np.array(ANGLES[name])
    results = np.empty((len(angles), 2))
    sines_cosines(angles, results)
    assert units_off(results[:, 0], exact(mpmath.sin, angles)) < 1
    assert units_off(results[:, 1], exact(mpmath.cos, angles)) < 1


@given(st.floats(-1e6, 1e6))
def test_sine_and_cosine_are_within_one_unit_of_any_angle(angle):
    """Hypothesis likes zeros, subnormals, whole numbers and ends, and looks for more."""
    with mpmath.workprec(1300):
        assert units_off([sine_cosine(angle)[0]], exact(mpmath.sin, [angle])) < 1
        assert units_off([sine_cosine(angle)[1]], exact(mpmath.cos, [angle])) < 1


@given(st.floats(-1e6, 1e6))
def test_sine_and_cosine_are_symmetrical_and_on_the_circle(angle):
    sine, cosine = sine_cosine(angle)
    assert sine_cosine(-angle) == (-sine, cosine)
    assert max(abs(sine), abs(cosine)) <= 1
    assert abs(sine * sine + cosine * cosine - 1) < 4e-16


def test_sine_and_cosine_of_round_angles():
    assert sine_cosine(0.0) == (0.0, 1.0)
    assert math.copysign(1.0, sine_cosine(-0.0)[0]) == 1.0
    assert sine_cosine(5e-324) == (5e-324, 1.0)
    assert sine_cosine(-SMALLEST_NORMAL) == (-SMALLEST_NORMAL, 1.0)
    assert sine_cosine(math.pi)[1] == -1
    assert sine_cosine(QUARTER)[0] == 1
    assert sine_cosine(-QUARTER)[0] == -1


@pytest.mark.parametrize(
    "angle", [math.nan, math.inf, -math.inf, np.nextafter(1e6, 2e6), -1e7, 1e308, -LARGEST]
)
def test_sine_and_cosine_say_when_they_cannot(angle):
    sine, cosine = sine_cosine(float(angle))
    assert math.isnan(sine)
    assert math.isnan(cosine)


EXPONENTS = {
    "small": evenly(-1, 1),
    "normal": evenly(-708, 709.7827),
    "subnormal": evenly(-745.133, -708),
    "magnitudes": every_magnitude(700),
    "seams": (np.arange(-1074, 1024) + 0.5) * math.log(2),
    "powers of two": np.arange(-1074, 1024) * math.log(2),
}


@pytest.mark.parametrize("name", EXPONENTS)
def test_the_exponential_is_within_one_unit(name):
    xs = EXPONENTS[name]
    results = np.empty(len(xs))
    exponentials(xs, results)
    subnormal = results < SMALLEST_NORMAL
    truths = exact(mpmath.exp, xs)
    assert units_off(results, truths) < 1
    assert units_off(results[~subnormal], np.array(truths)[~subnormal]) < 0.75


@given(st.floats(allow_nan=False))
def test_the_exponential_and_the_logistic_are_near_for_any_float(x):
    """From the least subnormal to infinity, either way."""
    if abs(x) > 800:
        assert exponential(x) == (math.inf if x > 0 else 0)
        assert logistic(x) == (1 if x > 0 else 0)
    else:
        overflows = x > math.log(LARGEST)
        if not overflows:
            assert units_off([exponential(x)], exact(mpmath.exp, [x])) < 1
        assert (exponential(x) == math.inf) == overflows
        assert units_off([logistic(x)], exact(lambda y: 1 / (1 + mpmath.exp(-y)), [x])) < 3


def test_the_exponential_at_the_ends_of_the_range():
    most = math.log(LARGEST)
    least = -745.1332191019411
    assert 0.999 * LARGEST < exponential(most) <= LARGEST
    assert exponential(math.nextafter(most, math.inf)) == math.inf
    assert exponential(least) == 5e-324
    assert exponential(math.nextafter(least, -math.inf)) in (0, 5e-324)
    assert exponential(-745.14) == 0
    assert [exponential(x) for x in (1e308, math.inf)] == [math.inf, math.inf]
    assert [exponential(x) for x in (-1e308, -math.inf)] == [0, 0]
    assert math.isnan(exponential(math.nan))


def test_the_exponential_of_zero_and_next_to_it_is_one():
    assert [exponential(x) for x in (0.0, -0.0, 5e-324, -5e-324, 1e-17)] == [1.0] * 5


def test_the_exponential_never_falls():
    xs = np.sort(np.concatenate([*EXPONENTS.values(), np.linspace(0.34, 0.35, 10_000)]))
    results = np.empty(len(xs))
    exponentials(xs, results)
    assert np.all(np.diff(results) >= 0)


@pytest.mark.parametrize("name", EXPONENTS)
def test_the_logistic_is_within_three_units(name):
    xs = EXPONENTS[name]
    results = np.empty(len(xs))
    logistics(xs, results)
    assert units_off(results, exact(lambda x: 1 / (1 + mpmath.exp(-x)), xs)) < 3
    assert results.min() >= 0
    assert results.max() <= 1


@given(st.floats(-800, 800))
def test_the_logistic_and_its_mirror_add_up_to_one(x):
    assert abs(logistic(x) + logistic(-x) - 1) < 3e-16


def test_the_logistic_far_out():
    assert logistic(0.0) == 0.5
    assert [logistic(x) for x in (40.0, 1e308, math.inf)] == [1, 1, 1]
    assert [logistic(x) for x in (-746.0, -1e308, -math.inf)] == [0, 0, 0]
    assert math.isnan(logistic(math.nan))


# Every function over its range, on Python floats and on NumPy's, which warn of overflow.
SAMPLE = """
import hashlib, math, struct
import numpy as np
from animat.numerics.elementary import exponential, logistic, sine_cosine
random = np.random.default_rng(7)
special = [0.0, -0.0, 5e-324, 1e-310, math.inf, -math.inf, 1e308, -1e308, 709.783]
angles = [*random.uniform(-7, 7, 2000), *random.uniform(-1e6, 1e6, 2000), *special[:4]]
powers = [*random.uniform(-750, 712, 2000), *random.uniform(-2, 2, 2000), *special]
results = []
for kind in (float, np.float64):
    for angle in angles:
        results.extend(sine_cosine(kind(angle)))
    for power in powers:
        results += [exponential(kind(power)), logistic(kind(power))]
assert all(math.isnan(s) for s in sine_cosine(np.float64(math.inf)))
assert all(math.isnan(f(np.float64(math.nan))) for f in (exponential, logistic))
assert not any(math.isnan(r) for r in results)
print(hashlib.sha256(struct.pack(f"<{len(results)}d", *results)).hexdigest())
"""
# An x86-64 processor without fused multiply-add, and one with it; elsewhere what there is.
X86 = platform.machine() in ("x86_64", "AMD64")
PROCESSORS = ["nehalem", "haswell"] if X86 else ["generic"]


def in_a_process(code, **settings):
    command = [sys.executable, "-W", "error", "-c", code]
    environment = {**os.environ, **settings}
    ran = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


@pytest.mark.parametrize(
    "settings",
    [{"NUMBA_DISABLE_JIT": "1"}, *({"NUMBA_CPU_NAME": name} for name in PROCESSORS)],
    ids=lambda settings: "=".join(*settings.items()),
)
def test_bits_are_the_same_uncompiled_and_on_every_processor(settings, capsys):
    exec(SAMPLE, {})
    assert in_a_process(SAMPLE, **settings) == capsys.readouterr().out


ASSEMBLY = """
import numba
from animat.numerics.compiled import OPTIONS
from animat.numerics.elementary import exponential, logistic, sine_cosine
def product_and_sum(x):
    return x * x + 1.0
fused = numba.njit(**{**OPTIONS, "fastmath": True})(product_and_sum)
ours = [numba.njit(**OPTIONS)(one.py_func) for one in (sine_cosine, exponential, logistic)]
for function in (*ours, fused):
    function(0.3)
    print("=====", *function.inspect_asm().values())
"""
FUSED = re.compile(r"v?fn?m(add|sub)|fml[as]")
LIBRARY = re.compile(r"\b(sin|cos|sincos|exp|exp2|ldexp|floor|rint)\b")


def test_nothing_is_fused_and_no_library_is_called():
    target = {"NUMBA_CPU_NAME": "haswell"} if X86 else {}
    *ours, fast = in_a_process(ASSEMBLY, **target, NUMBA_DISABLE_JIT="0").split("=====")[1:]
    assert len(ours) == 3
    for assembly in ours:
        assert "mul" in assembly
        assert not FUSED.search(assembly)
        assert not LIBRARY.search(assembly)
    assert FUSED.search(fast), "the processor asked for has fused instructions to find"

"""Custom functions are tried before a run: indices outside their arrays are found there."""

from __future__ import annotations

import types

import numpy as np
import pytest

from animat.life.scenario import bring_together
from animat.mind import trial
from animat.mind.functions import SIGNATURES, FunctionError, checked_twin, resolve
from animat.mind.mind import Mind
from animat.numerics.compiled import compiled
from animat.numerics.snapshot import lasting_identity
from animat.world.world import World

LAST = {
    "drives": {"values": 3, "set_points": 3, "senses": 3, "a": 3, "b": 3, "out": 3},
    "selector": {"drives": 3, "likelihoods": 3, "serves": 3, "memory": 4},
    "estimator": {"features": 2, "weights": 9, "hidden": 2},
    "learner": {"features": 2, "weights": 9, "hidden": 2},
    "wander": {"readings": 8, "aheads": 8, "sides": 8, "memory": 4},
}
"""The arrays each role is given, and how long they are in the paper's mind."""

GIVES = {"selector": "return int({0})", "estimator": "return {0}", "wander": "return {0}, 1.0"}

world = World.abundant()


def mind_with(role, function):
    return {
        "law": lambda: Mind(variables={"nutrition": {"law": function, "kind": "deficit"}}),
        "drives": lambda: Mind(drive_function=function),
        "selector": lambda: Mind(selector=function),
        "estimator": lambda: Mind(learning={"estimator": function}),
        "learner": lambda: Mind(learning={"learner": function}),
        "wander": lambda: Mind(wander=function),
    }[role]()


def reads(folder, role, beyond=""):
    """Return the address of a function that reads the last elements of its arrays, or the next."""
    signature = SIGNATURES[role].partition(" -> ")[0].partition("(")[2]
    places = {name: length - (name != beyond) for name, length in LAST[role].items()}
    element = {"a": "a[{}, 2]", "b": "b[{}, 2]"}
    total = " + ".join(element.get(n, n + "[{}]").format(at) for n, at in places.items())
    gives = GIVES.get(role, "x = {0}\n    if x > 1e300:\n        raise ValueError")
    path = folder / f"mine{beyond}.py"
    path.write_text(f"def own({signature}:\n    {gives.format(total)}\n")
    return f"{path}:own"


@pytest.mark.parametrize(
    ("role", "array"),
    [
        ("drives", "out"),
        ("drives", "b"),
        ("selector", "serves"),
        ("estimator", "weights"),
        ("learner", "hidden"),
        ("wander", "memory"),
    ],
)
def test_an_index_outside_an_array_is_found(role, array, tmp_path):
    """The last elements are there, the next is not: arrays are as long as the mind has them."""
    bring_together(mind_with(role, reads(tmp_path, role)), world)
    with pytest.raises(FunctionError) as told:
        bring_together(mind_with(role, reads(tmp_path, role, array)), world)
    (line,) = str(told.value).splitlines()
    assert line.startswith(f"{role}: own leaves an array (index is out of bounds), given ")
    for name, length in LAST[role].items():
        assert f"{name} [{length}" in line


TABLE = np.arange(10.0)


def by_value(value, low, high, rate, factor):
    return TABLE[int(value * 10.0)] / 100.0


def by_luck(drives, likelihoods, serves, u, memory):
    return int(TABLE[int(u * 11.0)]) % 3


def by_time(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    memory[3] += 1.0
    memory[int(memory[3] / 50.0)] += 0.0
    return speed, speed


def by_reading(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    return TABLE[readings[7] // 100], 1.0


@compiled
def element(numbers, place):
    return numbers[place]


@compiled
def further(numbers):
    return element(numbers, 40)


def by_helper(features, weights, hidden):
    return further(features)


MODULE = types.ModuleType("neighbour")
vars(MODULE)["further"] = further


def by_module(features, weights, hidden):
    return MODULE.further(features)


@pytest.mark.parametrize(
    ("role", "function"),
    [
        ("law", by_value),
        ("selector", by_luck),
        ("wander", by_time),
        ("wander", by_reading),
        ("estimator", by_helper),
        ("estimator", by_module),
    ],
)
def test_an_index_is_found_that_few_inputs_lead_to(role, function):
    with pytest.raises(FunctionError, match=f"^{role}: {function.__name__} leaves an array"):
        bring_together(mind_with(role, function), world)


def within(value, low, high, rate, factor):
    return TABLE[min(int(value * 10.0), 9)] / 100.0


def in_reach(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    memory[int(u_a * 4.0)] = TABLE[-1]
    return TABLE[readings[7] // 128], 1.0


def doubtful(drives, likelihoods, serves, u, memory):
    if u > 0.5:
        raise ValueError("not today")
    return 0


@pytest.mark.parametrize(
    ("role", "function"), [("law", within), ("wander", in_reach), ("selector", doubtful)]
)
def test_what_stays_within_its_arrays_passes(role, function):
    """To raise is no mistake: the life in which a function does fails, and no other."""
    bring_together(mind_with(role, function), world)


def test_a_function_is_tried_once_for_a_mind(monkeypatch):
    calls = []
    monkeypatch.setattr(trial, "_passed", set())
    own = trial._try
    monkeypatch.setattr(trial, "_try", lambda *each: calls.append(1) or own(*each))
    functions = mind_with("law", within).functions()
    for _ in range(3):
        bring_together(mind_with("law", within), world, functions=functions)
    assert len(calls) == 1
    other = Mind(physiology="linear", variables={"nutrition": {"law": within, "kind": "deficit"}})
    bring_together(other, world, functions=functions)
    assert len(calls) == 2


def walks(drives, likelihoods, serves, u, memory):
    likelihoods.flat[0] = 1.0
    return 0


def iterates(drives, likelihoods, serves, u, memory):
    for each in np.nditer(likelihoods):
        each[()] = 0.0
    return 0


@pytest.mark.parametrize("function", [walks, iterates])
def test_what_could_write_past_the_compiler_is_refused(function):
    with pytest.raises(FunctionError, match="uses flat or nditer"):
        resolve("selector", function)


@compiled
def again(value):
    return again(value - 1.0) if value > 0.0 else value


def endless(value, low, high, rate, factor):
    return again(value)


def test_a_function_that_calls_itself_is_refused():
    with pytest.raises(FunctionError, match="does not compile: again calls itself, for which"):
        resolve("law", endless)


def test_the_twin_that_checks_computes_the_same_under_a_name_of_its_own():
    function = resolve("estimator", by_helper)
    twin = resolve("estimator", by_helper, check=True)
    assert twin is not function
    assert checked_twin(twin) is twin
    assert lasting_identity(twin) == lasting_identity(function)
    law, other = resolve("law", within), resolve("law", within, check=True)
    for value in (0.0, 0.31, 1.0):
        assert law(value, 0.0, 1.0, 0.1, 0.9) == other(value, 0.0, 1.0, 0.1, 0.9)
    assert getattr(other, "_uuid") == f"checked {getattr(law, '_uuid')}"  # noqa: B009

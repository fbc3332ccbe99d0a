import functools
import inspect
from pathlib import Path

import numba
import numpy as np
import pytest

from animat.mind.drives import signed
from animat.mind.functions import (
    ARGUMENTS,
    BUILT_IN,
    SIGNATURES,
    FunctionError,
    Functions,
    resolve,
)
from animat.mind.mind import Mind

LAW = SIGNATURES["law"]


def my_law(value, low, high, rate, factor):
    return low + (value - low) * factor * factor


def my_drives(values, changes, set_points, senses, a, b, out):
    for d in range(len(out)):
        out[d] = a[d, 0] * (set_points[0] - values[0])


def my_selector(drives, likelihoods, serves, u, memory):
    return len(serves) - 1


def my_estimator(features, weights, hidden):
    return weights[0] * features[0]


def my_learner(features, weights, hidden, target, rate, cycles, biases):
    for w in range(len(weights)):
        weights[w] += rate * (target - weights[w]) * cycles


def my_wander(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    memory[0] += u_a
    return float(turn), speed


OWN = {
    "law": my_law,
    "drives": my_drives,
    "selector": my_selector,
    "estimator": my_estimator,
    "learner": my_learner,
    "wander": my_wander,
}


def mind_with(role, function):
    return {
        "law": lambda: Mind(variables={"nutrition": {"law": function, "kind": "deficit"}}),
        "drives": lambda: Mind(drive_function=function),
        "selector": lambda: Mind(selector=function),
        "estimator": lambda: Mind(learning={"estimator": function}),
        "learner": lambda: Mind(learning={"learner": function}),
        "wander": lambda: Mind(wander=function),
    }[role]()


def test_every_role_is_told_of_and_has_a_stand_in():
    assert set(SIGNATURES) == set(ARGUMENTS) == set(OWN) == set(Functions._fields)
    for role, stand_in in BUILT_IN._asdict().items():
        given = inspect.signature(getattr(stand_in, "py_func", stand_in)).parameters
        assert f"({', '.join(given)})" in SIGNATURES[role]
        assert len(ARGUMENTS[role]) == len(given)


def test_a_mind_of_built_in_functions_needs_none_of_ones_own():
    assert Mind().functions() == BUILT_IN
    assert Mind(agent="RANDOM", selector="winner_take_all").functions() == BUILT_IN


@pytest.mark.parametrize("role", OWN)
def test_a_function_of_ones_own_takes_the_place_of_one_of_ours(role):
    resolved = mind_with(role, OWN[role]).functions()
    for other, function in resolved._asdict().items():
        if other == role:
            assert getattr(function, "py_func", function).__code__ is OWN[role].__code__
        else:
            assert function is getattr(BUILT_IN, other)


@pytest.mark.parametrize("role", OWN)
def test_a_function_of_ones_own_comes_from_a_file(role, tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(inspect.getsource(OWN[role]) + "\nanother = 1\n")
    function = getattr(mind_with(role, f"{path}:{OWN[role].__name__}").functions(), role)
    assert function.__name__ == OWN[role].__name__
    assert getattr(function, "py_func", function).__code__.co_filename == str(path)


def test_what_comes_from_a_file_computes_what_the_file_says(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text("K = 3.0\ndef law(value, low, high, rate, factor):\n    return K * value\n")
    law = resolve("law", f"{path}:law")
    assert law(0.5, 0.0, 1.0, 0.1, 0.9) == 1.5
    path.write_text("K = 4.0\ndef law(value, low, high, rate, factor):\n    return K * value\n")
    assert resolve("law", f"{path}:law")(0.5, 0.0, 1.0, 0.1, 0.9) == 2.0


def test_a_function_already_compiled_is_welcome():
    law = resolve("law", numba.njit(my_law))
    assert law(0.5, 0.0, 1.0, 0.1, 0.5) == 0.125
    out = np.zeros(2)
    rows = np.ones(2), np.zeros(2), np.full(2, 1.5), np.ones(2)
    resolve("drives", signed)(*rows, np.eye(2), np.eye(2), out)
    np.testing.assert_array_equal(out, 0.5)


def test_names_of_arguments_are_ones_own_affair():
    def halve(v, a, b, r, f=0.5):
        return v / 2

    assert resolve("law", halve)(1.0, 0.0, 1.0, 0.1, 0.9) == 0.5


@pytest.mark.parametrize("role", OWN)
def test_a_function_of_the_wrong_signature_is_told_the_right_one(role):
    def alone(value):
        return value

    with pytest.raises(FunctionError) as told:
        mind_with(role, alone).functions()
    assert str(told.value) == (
        f"{role}: alone(value) has other arguments; wanted {SIGNATURES[role]}"
    )


def test_arguments_that_are_not_given_one_by_one_are_refused():
    def gathers(*arguments):
        return arguments[0]

    def named(value, low, high, rate, *, factor):
        return value

    for function in (gathers, named):
        with pytest.raises(FunctionError, match="has other arguments; wanted law"):
            resolve("law", function)


@pytest.mark.parametrize("thing", [len, functools.partial(my_law), type("Law", (), {})])
def test_what_is_no_python_function_is_refused(thing):
    with pytest.raises(FunctionError, match="is not a Python function; wanted law"):
        resolve("law", thing)


@pytest.mark.parametrize(
    ("content", "address", "told"),
    [
        (None, "{path}:law", 'law = "{path}:law": no such built-in and no such file;'),
        (None, "gone.py", 'law = "gone.py": no such built-in and no such file in {here};'),
        ("law = 1", "{path}:law", '{path} has no function "law"; wanted'),
        ("other = len", "{path}:law", '{path} has no function "law"; wanted'),
        ("def law(:", "{path}:law", "{path} does not run: SyntaxError: "),
        ("import nowhere_at_all", "{path}:law", "does not run: ModuleNotFoundError: No module"),
        ("1 / 0", "{path}:law", "{path} does not run: ZeroDivisionError: division by zero"),
        ("raise SystemExit('no\\nmore')", "{path}:law", "does not run: SystemExit: no more"),
    ],
)
def test_a_file_that_will_not_do_says_why(tmp_path, content, address, told):
    path = tmp_path / "mine.py"
    if content is not None:
        path.write_text(content)
    with pytest.raises(FunctionError) as error:
        resolve("law", address.format(path=path))
    message = str(error.value)
    assert message.startswith("law")
    assert told.format(path=path, here=Path.cwd()) in message
    assert "\n" not in message
    if "does not run" not in message:
        assert LAW in message


def test_a_file_that_is_not_python_is_refused(tmp_path):
    path = tmp_path / "mine.txt"
    path.write_text("")
    with pytest.raises(FunctionError, match="is not a Python file"):
        resolve("law", f"{path}:law")


def helper(value):
    return value


def unknown_helper(value, low, high, rate, factor):
    return helper(value)


def undefined_name(value, low, high, rate, factor):
    return value + missing  # noqa: F821


def new_array(value, low, high, rate, factor):
    return np.zeros(3)[0] + value


def new_list(value, low, high, rate, factor):
    return [value][0]


def opens_a_file(value, low, high, rate, factor):
    with open("notes") as notes:  # noqa: PTH123
        return float(notes.read())


@pytest.mark.parametrize(
    ("function", "reason"),
    [
        (unknown_helper, "Untyped global name 'helper'"),
        (undefined_name, "name 'missing' is not defined"),
        (new_array, "it makes a new array, list or other object"),
        (new_list, "it makes a new array, list or other object"),
        (opens_a_file, "context manager"),
    ],
)
def test_a_function_that_does_not_compile_says_why_on_one_line(function, reason):
    with pytest.raises(FunctionError) as told:
        resolve("law", function)
    message = str(told.value)
    assert message.startswith(f"law: {function.__name__} does not compile: ")
    assert reason in message
    assert message.endswith(f"; wanted {LAW}")
    assert "\n" not in message


@pytest.mark.parametrize(
    ("role", "source"),
    [
        ("law", "def own(value, low, high, rate, factor):\n    if value > 0: return value"),
        ("law", "def own(value, low, high, rate, factor):\n    return value > 0"),
        ("law", "def own(value, low, high, rate, factor):\n    yield value"),
        ("estimator", "def own(features, weights, hidden):\n    return 'likely'"),
        ("selector", "def own(drives, likelihoods, serves, u, memory):\n    return u"),
        ("drives", "def own(values, changes, set_points, senses, a, b, out):\n    return values"),
        (
            "learner",
            "def own(features, weights, hidden, target, rate, cycles, biases):\n    return 0.5",
        ),
        (
            "wander",
            "def own(readings, aheads, sides, memory, u_a, u_b, speed, turn):\n"
            "    return speed, turn, speed",
        ),
        (
            "wander",
            "def own(readings, aheads, sides, memory, u_a, u_b, speed, turn):\n    return speed",
        ),
    ],
)
def test_a_function_that_returns_the_wrong_thing_is_told_what_to_return(tmp_path, role, source):
    path = tmp_path / "mine.py"
    path.write_text(source)
    with pytest.raises(FunctionError) as told:
        resolve(role, f"{path}:own")
    message = str(told.value)
    assert message.startswith(f"{role}: own returns ")
    assert message.endswith(f"; wanted {SIGNATURES[role]}")


def test_uncompiled_a_function_is_taken_as_it_is(monkeypatch):
    monkeypatch.setattr("numba.core.config.DISABLE_JIT", True)
    assert resolve("law", new_list) is new_list

"""How functions of a step are written: numbers, arrays handed in, loops, and nothing else.

The compiled code is looked at in tests/life/test_machine_code.py. Here it is the source, which
tells sooner and says where: no list, dict or set, no text, no exception, no function within a
function, and nothing taken from the module around but numbers and compiled functions.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import math
import pkgutil
import textwrap
from collections.abc import Iterator
from linecache import getline
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numpy as np
import pytest
from numba.core.extending import _Intrinsic

import animat
from animat.numerics.compiled import COMPILING_LAYERS, compiled
from animat.numerics.linked import Linked

STATEMENTS = (
    *(ast.FunctionDef, ast.arguments, ast.arg, ast.Return, ast.Expr, ast.Pass),
    *(ast.Assign, ast.AugAssign, ast.AnnAssign, ast.If, ast.For, ast.While, ast.Break),
    ast.Continue,
)
EXPRESSIONS = (
    *(ast.Name, ast.Attribute, ast.Subscript, ast.Constant, ast.Tuple, ast.Call, ast.keyword),
    *(ast.BinOp, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.IfExp, ast.expr_context),
    *(ast.operator, ast.unaryop, ast.boolop, ast.cmpop),
)
"""What the source of a compiled function is made of. Everything else is refused."""

BUILT_INS = {"range", "len", "min", "max", "abs", "round", "int", "float", "bool"}
METHODS = {"view"}
"""What may be called of a number: to take its bits for another number."""

EXACT: dict[str, set[str]] = {
    "math": {"sqrt", "floor", "isnan", "isfinite", "isinf", "pi", "inf", "nan"},
    "numpy": {"uint64", "int64", "float64", "float32", "inf", "nan"},
}
"""What may be taken from these modules: numbers, types of numbers, and functions that IEEE 754
rounds in one way only."""

INEXACT = {
    *("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "arcsin", "arccos", "arctan"),
    *("arctan2", "sinh", "cosh", "tanh", "exp", "exp2", "expm1", "log", "log2", "log10", "log1p"),
    *("pow", "power", "float_power", "hypot", "cbrt", "gamma", "lgamma", "erf", "erfc", "random"),
}
"""What systems and processors round differently, or draw."""

PLAIN = (bool, int, float, np.generic)


def python_function(value: Any) -> FunctionType | None:
    """Return the source function of a compiled one, also where nothing is compiled."""
    function = value.function if isinstance(value, Linked) else getattr(value, "py_func", value)
    if isinstance(function, FunctionType) and _decorated(function):
        return function
    return None


def _decorated(function: FunctionType) -> bool:
    code = function.__code__
    line = getline(code.co_filename, code.co_firstlineno).strip()
    return line in ("@compiled", "@kernel") or line.startswith("@linked(")


def compiled_functions() -> dict[str, FunctionType]:
    """Return every compiled function of the package by module and name."""
    found = {}
    for layer in COMPILING_LAYERS:
        package = importlib.import_module(f"animat.{layer}")
        for info in pkgutil.walk_packages(package.__path__, f"animat.{layer}."):
            module = importlib.import_module(info.name)
            for name, value in vars(module).items():
                function = python_function(value)
                if function and function.__module__ == info.name:
                    found[f"{info.name}.{name}"] = function
    return found


def faults(function: FunctionType) -> list[str]:
    """Return what a compiled function is made of that it may not be, with its line."""
    lines, first = inspect.getsourcelines(function)
    (definition,) = ast.parse(textwrap.dedent("".join(lines))).body
    assert isinstance(definition, ast.FunctionDef)
    return [
        f"line {first + getattr(node, 'lineno', 1) - 1}: {what}"
        for node, what in _faults(definition, function.__globals__)
    ]


def _faults(definition: ast.FunctionDef, around: dict[str, Any]) -> Iterator[tuple[ast.AST, str]]:
    body = definition.body
    if ast.get_docstring(definition) is not None:
        body = body[1:]
    local = {arg.arg for arg in ast.walk(definition.args) if isinstance(arg, ast.arg)}
    nodes = [node for statement in body for node in ast.walk(statement) if node is not None]
    local |= {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
    annotations = {
        id(part) for n in nodes if isinstance(n, ast.AnnAssign) for part in ast.walk(n.annotation)
    }
    arguments = definition.args
    if arguments.defaults or arguments.kwonlyargs or arguments.vararg or arguments.kwarg:
        yield definition, "arguments that are more than names"
    for node in nodes:
        if id(node) in annotations:
            continue
        if isinstance(node, ast.FunctionDef) or not isinstance(node, (*STATEMENTS, *EXPRESSIONS)):
            yield node, type(node).__name__
        elif isinstance(node, ast.Constant) and not isinstance(node.value, bool | int | float):
            yield node, f"the constant {node.value!r}"
        elif isinstance(node, ast.Name) and node.id not in local:
            if not _is_allowed(node.id, around):
                yield node, f"takes {node.id} from around it"
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            module = None if node.value.id in local else around.get(node.value.id)
            if isinstance(module, ModuleType) and not _may_be_taken(module, node.attr):
                yield node, f"takes {node.value.id}.{node.attr}"
        elif isinstance(node, ast.Call):
            yield from _faults_of_call(node)
        elif isinstance(node, ast.BinOp) and not _is_arithmetic(node):
            yield node, "a power or product of the library's"


def _is_arithmetic(node: ast.BinOp) -> bool:
    """Tell whether an operator is an instruction, or several: x**2 is x * x."""
    if isinstance(node.op, ast.Pow):
        return isinstance(node.right, ast.Constant) and isinstance(node.right.value, int)
    return not isinstance(node.op, ast.MatMult)


def _faults_of_call(node: ast.Call) -> Iterator[tuple[ast.AST, str]]:
    if any(isinstance(arg, ast.Starred) for arg in node.args) or node.keywords:
        yield node, "arguments that are not one after the other"
    called = node.func
    if isinstance(called, ast.Attribute) and not isinstance(called.value, ast.Name):
        if called.attr not in METHODS:
            yield node, f"calls the method {called.attr}"
    elif not isinstance(called, ast.Attribute | ast.Name):
        yield node, "calls what is no name"


def _is_allowed(name: str, around: dict[str, Any]) -> bool:
    if name not in around:
        return name in BUILT_INS
    value = around[name]
    if isinstance(value, tuple):
        return all(isinstance(one, PLAIN) for one in value)
    if isinstance(value, type):  # a named tuple is its values, one after the other
        return issubclass(value, tuple) and hasattr(value, "_fields")
    if isinstance(value, _Intrinsic):  # of ours: layout.py and linked.py
        return value._defn.__module__.startswith("animat.numerics.")
    return isinstance(value, (ModuleType, *PLAIN)) or python_function(value) is not None


def _may_be_taken(module: ModuleType, name: str) -> bool:
    if module.__name__ in EXACT:
        return name in EXACT[module.__name__]
    return _is_allowed(name, {name: getattr(module, name, None)})


FUNCTIONS = compiled_functions()


def test_there_is_something_to_look_at():
    layers = {name.split(".")[1] for name in FUNCTIONS}
    assert layers == set(COMPILING_LAYERS)
    for name in ("life.step.step", "life.kernels.advance", "numerics.elementary.exponential"):
        assert f"animat.{name}" in FUNCTIONS
    assert len(FUNCTIONS) > 80


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_compiled_function_is_made_of_numbers_and_loops(name):
    assert faults(FUNCTIONS[name]) == []


def library_calls(source: str) -> list[str]:
    """Return what a module takes of INEXACT from the libraries, compiled or not."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Attribute) and node.attr in INEXACT:
            if ast.unparse(node.value) in ("math", "np", "numpy", "cmath"):
                found.append(ast.unparse(node))
        elif isinstance(node, ast.ImportFrom) and node.module in ("math", "numpy", "random"):
            found += [alias.name for alias in node.names if alias.name in INEXACT]
        elif isinstance(node, ast.Import):
            found += [alias.name for alias in node.names if alias.name == "random"]
    return found


@pytest.mark.parametrize("layer", COMPILING_LAYERS)
def test_what_a_life_is_made_of_takes_no_inexact_function_from_a_library(layer):
    """Nor where worlds, robots and minds are made ready, which nothing compiles."""
    modules = sorted((Path(animat.__file__).parent / layer).rglob("*.py"))
    assert modules
    for path in modules:
        assert library_calls(path.read_text(encoding="utf-8")) == [], path.name


def test_an_inexact_function_is_found():
    for line in ("math.cos(1)", "x = np.exp", "from math import sin", "import random"):
        assert len(library_calls(line)) == 1, line
    for line in ("math.sqrt(2)", "streams.random(1)", "from math import sqrt, pi", "np.round(x)"):
        assert library_calls(line) == [], line


ARRAY = np.arange(3.0)
WORDS = ("one", "two")
TABLE = {1: 2.0}
PARTS = (1.0, 2, True)


def plain(x):
    return x


@compiled
def twice(x: float) -> float:
    """A docstring is no text of the step's."""
    here: float = 2.0 * x if x > 0.0 else -x
    for part in PARTS:
        here += part
    while not (here < 3.0 or math.isnan(here)):
        here -= math.sqrt(here) + min(1.0, np.int64(3).view(np.float64))
    return here


@compiled
def harmless(state, n, custom):
    pair = (n, twice(1.0))
    state.values[n] += pair[1] ** 2
    a, b = pair
    if a in (1, 2):
        return custom(a, b)
    return len(state.values)


def test_what_a_step_may_do_is_not_found():
    assert faults(python_function(twice)) == []
    assert faults(python_function(harmless)) == []


OFFENDERS: list[FunctionType] = []


def planted(function: FunctionType) -> FunctionType:
    """Mark an offender; it is never compiled."""
    OFFENDERS.append(function)
    return function


@planted
def makes_a_list(x):
    return [x]


@planted
def makes_a_dict(x):
    return {x: x}


@planted
def makes_a_set(x):
    return {x}


@planted
def comprehends(x):
    return sum(n for n in range(x))


@planted
def tries(x):
    try:
        return x
    finally:
        pass


@planted
def raises(x):
    raise ValueError


@planted
def asserts(x):
    assert x


@planted
def opens(x):
    with x:
        pass


@planted
def hides_a_function(x):
    return max(x, lambda y: y)


@planted
def nests(x):
    def inner(y):
        return y

    return inner(x)


@planted
def takes_over(x):
    global WORDS  # noqa: PLW0603
    WORDS = x


@planted
def writes(x):
    return f"{x}"


@planted
def says(x):
    return "x"


@planted
def reads_an_array(n):
    return ARRAY[n]


@planted
def reads_words(n):
    return WORDS[n]


@planted
def reads_a_table(n):
    return TABLE[n]


@planted
def calls_plain_python(x):
    return plain(x)


@planted
def calls_a_library_s_sine(x):
    return math.sin(x)


@planted
def calls_numpy(x):
    return np.exp(x)


@planted
def allocates(x):
    return np.zeros(x)


@planted
def raises_to_a_power(x, y):
    return x**y


@planted
def copies(x):
    return x.values[0].copy()


@planted
def unpacks(x):
    return max(*x)


@planted
def names_arguments(x):
    return max(x, default=1)


@planted
def has_a_default(x, y=1):
    return x + y


@planted
def yields(x):
    yield x


@planted
def slices(x):
    return x[1:3]


@planted
def prints(x):
    print(x)  # noqa: T201


@pytest.mark.parametrize("function", OFFENDERS, ids=lambda function: function.__name__)
def test_what_no_step_may_do_is_found(function):
    found = faults(function)
    assert found
    line = int(found[0].split(":")[0].removeprefix("line "))
    first = function.__code__.co_firstlineno
    assert first < line <= first + 5

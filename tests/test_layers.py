"""Who may know whom: the layers of the package, held against every import in it.

`mind` knows neither `robot` nor `world`, so that a mind can move into another body; `life` brings
the three together; `statistics` and `figures` know tables, not the engines that made them. No two
modules import each other. An import inside a function or under TYPE_CHECKING counts like any other.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter
from itertools import product
from pathlib import Path
from typing import NamedTuple

import pytest

import animat

ROOT = Path(animat.__file__).parent

GROUND = {"errors", "files", "names", "version"}
"""What every layer may know but `numerics`, which needs errors alone."""

MODEL = GROUND | {"numerics", "world", "robot", "mind", "life"}

KNOWS: dict[str, set[str]] = {
    "errors": set(),
    "version": set(),
    "progress": set(),
    "files": {"errors"},
    "names": {"files"},
    "numerics": {"errors"},
    "world": GROUND | {"numerics"},
    "robot": GROUND | {"numerics", "world"},
    "mind": GROUND | {"numerics"},
    "statistics": GROUND,
    "figures": GROUND | {"statistics"},
    "life": (MODEL - {"life"}) | {"statistics", "figures"},
    "recording": MODEL,
    "study": MODEL | {"recording", "progress"},
    "experiments": MODEL | {"study", "statistics", "progress"},
    "report": MODEL | {"study", "statistics", "figures", "experiments", "progress"},
    "study_run": GROUND | {"study", "report", "progress"},
    "cli": MODEL
    | {"recording", "statistics", "figures", "study", "experiments", "report", "progress"},
    "__main__": {"cli"},
    "": set(),
}

KNOWS_LATE = {"": set(KNOWS), "mind": {"figures"}}
"""What may only be imported inside a function, or for the type checker: `import animat` fetches
a name when it is asked for, and networks are drawn by a figure."""

LAYERS = sorted(set(KNOWS) - {"", "__main__"})

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)


class Import(NamedTuple):
    """An import of a module of the package; `late` if it does not run with the module itself."""

    line: int
    layer: str
    late: bool


def layer_of(module: str) -> str:
    """Return 'world' for animat.world.raster, '' for animat itself."""
    return [*module.split("."), ""][1]


def imports(tree: ast.AST, package: str, late: bool = False) -> Iterator[Import]:
    """Yield every import of the package's own modules in a module that lies in `package`."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Import):
            named = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            named = _imported_from(node, package)
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(
            ("import_module", "__import__")
        ):
            named = [str(arg.value) for arg in node.args if isinstance(arg, ast.Constant)]
            named = [name for name in named if name]
        else:
            named = []
        for name in named:
            if name.split(".")[0] == "animat":
                yield Import(getattr(node, "lineno", 0), layer_of(name), late)
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            yield from imports(ast.Module(node.body, []), package, late=True)
            yield from imports(ast.Module(node.orelse, []), package, late)
        else:
            yield from imports(node, package, late or isinstance(node, FUNCTIONS))


def _imported_from(node: ast.ImportFrom, package: str) -> list[str]:
    base = node.module or ""
    if node.level:
        above = package.split(".")[: len(package.split(".")) - (node.level - 1)]
        base = ".".join([*above, *([node.module] if node.module else [])])
    if base == "animat":
        # A layer or a name that the package itself offers.
        return [f"animat.{a.name}" if a.name in KNOWS else "animat" for a in node.names]
    return [base]


def violations(source: str, module: str, package: str) -> list[str]:
    """Return a line for every import in the source of `module` that its layer does not allow."""
    layer = layer_of(module)
    if layer not in KNOWS:
        return [f"{module}: belongs to no layer; say in KNOWS what it may know"]
    early = KNOWS[layer] | {layer}
    late = early | KNOWS_LATE.get(layer, set())
    return [
        f"{module}:{found.line}: {layer or 'animat'} may not know {found.layer or 'animat'}"
        + (" but inside a function" if found.layer in late else "")
        for found in imports(ast.parse(source), package)
        if found.layer not in (late if found.late else early)
    ]


def modules() -> list[Path]:
    return sorted(ROOT.rglob("*.py"))


def test_there_is_something_to_look_at():
    layers = {path.relative_to(ROOT).parts[0].removesuffix(".py") for path in modules()}
    assert layers - {"__init__"} == set(KNOWS) - {""}


@pytest.mark.parametrize("path", modules(), ids=lambda path: str(path.relative_to(ROOT)))
def test_every_import_obeys_the_layers(path):
    parts = ["animat", *path.relative_to(ROOT).with_suffix("").parts]
    package = ".".join(parts[:-1])
    module = package if parts[-1] == "__init__" else ".".join(parts)
    assert violations(path.read_text(encoding="utf-8"), module, package) == []


FORMS = {
    "import": "import animat.{other}",
    "from": "from animat.{other} import something",
    "deeper": "from animat.{other}.deep.er import something",
    "beside others": "import os, animat.{other}.deep as d",
    "package": "from animat import {other}",
    "relative": "from ..{other} import something",
    "relative module": "from ..{other}.deep import something",
    "relative package": "from .. import {other}",
    "by name": "import importlib\nimportlib.import_module('animat.{other}.deep')",
}

PLACES = {
    "at the top": "{line}",
    "in a class": "class A:\n    {line}",
    "if it can": "try:\n    {line}\nexcept ImportError:\n    pass",
    "in a function": "def f():\n    {line}",
    "in a method": "class A:\n    def f(self):\n        if self:\n            {line}",
    "in a coroutine": "async def f():\n    {line}",
    "for the type checker": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    {line}",
    "for all but the type checker": "if TYPE_CHECKING:\n    pass\nelse:\n    {line}",
}


def planted(layer: str, line: str, place: str) -> list[str]:
    """The violations of a module of a layer that has `line` at `place`."""
    indent = place[: place.index("{line}")].rsplit("\n", 1)[-1]
    source = place.format(line=line.replace("\n", "\n" + indent))
    return violations(source, f"animat.{layer}.planted", f"animat.{layer}")


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("place", PLACES)
def test_every_rule_trips(form, place):
    """What is allowed passes and what is not is found, for every pair of layers."""
    late = ("in a function", "in a method", "in a coroutine", "for the type checker")
    for layer, other in product(LAYERS, LAYERS):
        allowed = (
            KNOWS[layer] | {layer} | (KNOWS_LATE.get(layer, set()) if place in late else set())
        )
        found = planted(layer, FORMS[form].format(other=other), PLACES[place])
        assert bool(found) == (other not in allowed), (layer, other)
        if found:
            assert f"{layer} may not know {other}" in found[0]


def test_no_layer_knows_the_package_that_stands_on_it():
    for layer in LAYERS:
        for line in ("import animat", "from animat import World", "from .. import World"):
            assert violations(line, f"animat.{layer}.planted", f"animat.{layer}")


def test_the_package_itself_loads_nothing_at_once():
    assert violations("from animat.world.world import World", "animat", "animat")
    assert violations("from .world import world", "animat", "animat")
    for late in ("def f():\n    {}", "if TYPE_CHECKING:\n    {}"):
        assert not violations(late.format("from .world import world"), "animat", "animat")
    for early in ("class A:\n    {}", "if TYPE_CHECKING:\n    pass\nelse:\n    {}"):
        assert violations(early.format("from .world import world"), "animat", "animat")


def test_a_module_of_no_layer_is_found():
    (line,) = violations("", "animat.soul.planted", "animat.soul")
    assert "belongs to no layer" in line


def test_a_mind_can_move_into_another_body():
    """The rules themselves, in the words they were given in."""
    assert KNOWS["mind"] - GROUND == {"numerics"}
    assert KNOWS["numerics"] == {"errors"}
    assert "robot" in KNOWS["life"]
    assert KNOWS["statistics"] == GROUND
    assert not KNOWS["figures"] & {"numerics", "world", "robot", "mind", "life", "study"}


def test_no_layer_stands_on_itself():
    order: list[str] = []
    while len(order) < len(LAYERS):
        free = [layer for layer in LAYERS if layer not in order and KNOWS[layer] <= set(order)]
        assert free
        order += free


def test_no_part_of_a_layer_stands_on_itself():
    """What `store` is built of knows nothing of `store`, and so on, for all packages in layers."""
    stands_on: dict[tuple[str, ...], set[tuple[str, ...]]] = {}
    for path in modules():
        here = path.relative_to(ROOT).parts[:2]
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                there = tuple((node.module or "").split(".")[1:3])
                if there[:1] == here[:1] and ROOT.joinpath(*there).is_dir() and there != here:
                    stands_on.setdefault(here, set()).add(there)
    assert ("study", "store") in stands_on
    TopologicalSorter(stands_on).prepare()


def test_no_module_stands_on_itself():
    """No two import each other, at once or late, nor in a ring of several."""
    names = {}
    for path in modules():
        parts = path.relative_to(ROOT.parent).with_suffix("").parts
        names[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    stands_on = {}
    for name, path in names.items():
        found = set()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                for alias in node.names:
                    inner = f"{node.module}.{alias.name}"
                    found.add(inner if inner in names else node.module)
        stands_on[name] = (found & set(names)) - {name, "animat"}
    assert stands_on["animat.life.step"]
    del stands_on["animat"]  # which fetches what it is asked for
    TopologicalSorter(stands_on).prepare()

"""A function file has its neighbours for itself."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.mind.loading import imported_files, load

FORMS = {
    "import util": "util.K",
    "import util as other": "other.K",
    "from util import K": "K",
    "from util import *": "K",
    "from .util import K": "K",
    "from . import util": "util.K",
    "import pkg.deep.far": "pkg.deep.far.K",
    "import pkg.deep.far as far": "far.K",
    "from pkg import deep": "deep.K",
    "from pkg.deep import far": "far.K",
    "from pkg.deep.far import K": "K",
    "from pkg.deep import up": "up",
    "import spaced.util": "spaced.util.K",
    "from .spaced import util": "util.K",
    "util = __import__('util')": "util.K",
}


def written(folder: Path, own: str, k: float) -> Path:
    """Write a function file and all its neighbours, which hold `k`."""
    files = {
        "own.py": own,
        "util.py": f"K = {k}\n",
        "statistics.py": f"K = {k}\n",
        "pkg/__init__.py": "from . import deep\n",
        "pkg/deep/__init__.py": "from ..own import K\nfrom .far import K as up\nimport util\n",
        "pkg/deep/far.py": "import util\nfrom pkg.own import K\nfrom util import K\n",
        "pkg/own.py": f"K = {k}\n",
        "spaced/util.py": f"K = {k}\n",
    }
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder / "own.py"


def value(path: Path) -> Any:
    return load(path).law()


NEIGHBOURS = ("own", "util", "pkg", "pkg.own", "pkg.deep", "spaced", "spaced.util", "a", "b")


@pytest.fixture(autouse=True)
def _nothing_is_left_behind():
    def now():
        return list(sys.path), [sys.modules.get(name) for name in NEIGHBOURS]

    before = now()
    yield
    assert now() == before


@pytest.mark.parametrize(("line", "asked"), FORMS.items(), ids=FORMS)
def test_every_form_of_import_finds_the_neighbours_of_its_own_file(tmp_path, line, asked):
    own = f"{line}\ndef law():\n    return {asked}\n"
    paths = {k: written(tmp_path / str(k), own, k) for k in (1.0, 2.0)}
    for k in (1.0, 2.0, 1.0):
        assert value(paths[k]) == k
    # Of the same length and within a second, so that only what is in it tells.
    written(tmp_path / "1.0", own, 3.0)
    assert value(paths[1.0]) == 3.0
    assert value(paths[2.0]) == 2.0


@given(order=st.permutations([1.0, 2.0, 1.0, 2.0]))
def test_two_files_of_two_folders_never_share_a_neighbour(tmp_path_factory, order):
    folder = tmp_path_factory.mktemp("two")
    own = "import util\ndef law():\n    return util.K\n"
    paths = {k: written(folder / str(k), own, k) for k in (1.0, 2.0)}
    assert [value(paths[k]) for k in order] == order


def test_a_neighbour_wins_over_python_s_own_module_and_for_the_file_alone(tmp_path):
    own = (
        "import statistics, fractions\ndef law():\n    return statistics.K, fractions.Fraction(1)\n"
    )
    assert value(written(tmp_path, own, 7.0)) == (7.0, 1)
    import statistics

    assert not hasattr(statistics, "K")


def test_a_folder_of_the_name_of_an_installed_package_does_not_hide_it(tmp_path):
    for name in ("scipy", "animat"):
        (tmp_path / name).mkdir()
    (tmp_path / "animat" / "__init__.py").write_text("")
    own = "import scipy, animat.numerics.compiled\ndef law():\n    return scipy.__version__\n"
    assert value(written(tmp_path, own, 1.0))


def test_a_file_within_a_package_can_import_from_all_of_it(tmp_path):
    written(tmp_path, "", 4.0)
    (tmp_path / "pkg" / "deep" / "util.py").write_text("K = 4.0\n")
    own = "from ..own import K\nfrom pkg.deep.far import K as L\nfrom . import far\n"
    path = tmp_path / "pkg" / "deep" / "law.py"
    path.write_text(f"{own}def law():\n    return K, L, far.K\n")
    assert value(path) == (4.0, 4.0, 4.0)
    assert tmp_path / "pkg" / "own.py" in imported_files(path)


@pytest.mark.parametrize(
    "line",
    ["import missing", "from . import missing", "from .missing import K", "from .. import util",
     "import pkg.missing", "from util import missing"],
)  # fmt: skip
def test_what_is_not_there_is_an_import_error(tmp_path, line):
    with pytest.raises(ImportError):
        load(written(tmp_path, line, 1.0))


def test_neighbours_that_import_one_another_are_run_once(tmp_path):
    path = written(tmp_path, "import a, b\ndef law():\n    return a.b is b, b.a is a\n", 1.0)
    (tmp_path / "a.py").write_text("import b\n")
    (tmp_path / "b.py").write_text("import a\n")
    assert value(path) == (True, True)


def test_the_files_that_a_function_file_imports_are_known(tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    (tmp_path / "lib" / "away").mkdir(parents=True)
    for name in ("__init__", "params", "base", "unused"):
        (tmp_path / "lib" / "away" / f"{name}.py").write_text("K = 1\n")
    (tmp_path / "lib" / "away" / "params.py").write_text("from .base import K\n")
    own = "import math, numpy\nfrom away.params import K\nimport pkg\nfrom spaced import util\n"
    path = written(tmp_path / "here", own, 1.0)
    monkeypatch.syspath_prepend(tmp_path / "lib")
    load(path)
    found = {str(file.relative_to(tmp_path)) for file in imported_files(path)}
    away = [f"lib/away/{name}.py" for name in ("__init__", "params", "base")]
    near = ["util.py", "pkg/__init__.py", "pkg/deep/__init__.py", "pkg/deep/far.py", "pkg/own.py"]
    assert found == {*away, *(f"here/{name}" for name in [*near, "spaced/util.py"])}
    for name in ("away", "away.params", "away.base"):
        del sys.modules[name]
    monkeypatch.undo()

"""What starting up costs: nothing heavy is imported before it is needed."""

from __future__ import annotations

import importlib
import subprocess
import sys

import pytest

import animat

HEAVY = {"numba", "llvmlite", "scipy", "matplotlib", "pyarrow", "jinja2", "dask", "distributed"}


def loaded_by(code: str) -> set[str]:
    """The top-level packages that a fresh Python has loaded after running `code`."""
    report = "\nimport sys\nprint('\\n' + ' '.join({name.split('.')[0] for name in sys.modules}))"
    run = subprocess.run(
        [sys.executable, "-c", code + report], capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    return set(run.stdout.splitlines()[-1].split())


def test_importing_animat_loads_nothing_heavy():
    loaded = loaded_by("import animat; dir(animat)")
    assert "animat" in loaded
    assert not loaded & (HEAVY | {"numpy", "pydantic"})


def test_help_loads_nothing_heavy():
    loaded = loaded_by(
        "import sys\n"
        "from animat.cli import main\n"
        "sys.argv = ['animat', '--help']\n"
        "try:\n    main()\nexcept SystemExit as end:\n    assert not end.code, end.code"
    )
    assert "typer" in loaded
    assert not loaded & HEAVY


def test_what_is_needed_is_then_loaded():
    """The check sees what is there."""
    assert loaded_by("import animat; animat.World") & {"numpy", "pydantic"}


@pytest.mark.parametrize("name", animat.__all__)
def test_every_public_name_is_there(name):
    value = getattr(animat, name)
    home = getattr(value, "__module__", "animat.")
    assert home.startswith("animat.")
    if hasattr(value, "__name__"):
        assert getattr(importlib.import_module(home), name) is value


def test_an_unknown_name_is_refused():
    with pytest.raises(AttributeError, match="no attribute 'Wrld'"):
        animat.Wrld  # noqa: B018  # pyright: ignore[reportAttributeAccessIssue]


LIVING = """
from numba.core import event

compiled = []

class Compilations(event.Listener):
    def on_start(self, event):
        compiled.append(event.data["dispatcher"].__name__)
    def on_end(self, event):
        pass

with event.install_listener("numba:compile", Compilations()):
    import animat
    world = animat.World.random({"TS": 1, "CL": 1}, seed=1, spares=1)
    life = animat.live(animat.Mind(agent="LEARNING"), world, steps=300, record="all")
    life.networks.likelihoods(world.types[0].features)
    knowing = animat.Mind(agent="AF", networks=life.networks)
    animat.live_many(knowing, world, lives=2, steps=300)
    animat.live(animat.Mind(), animat.World.abundant(), steps=300)
print("compiled:", *compiled)
"""


def test_a_second_start_compiles_nothing():
    for _ in range(2):
        run = subprocess.run(
            [sys.executable, "-c", LIVING], capture_output=True, text=True, check=False
        )
        assert run.returncode == 0, run.stderr
    assert run.stdout == "compiled:\n"

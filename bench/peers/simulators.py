"""The simulators that are measured, and how each gets a Python that has it."""

from __future__ import annotations

import os
import subprocess
import sys
import venv
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).parent

LIMIT = 1800
"""Seconds by the clock after which a measurement is given up."""


class Peer(NamedTuple):
    """A simulator: its adapter, what to install, the robots at once that are tried."""

    name: str
    adapter: str
    packages: tuple[str, ...]
    robots: tuple[int, ...]
    leaves_out: str
    installed: bool = False
    """Whether the Python that runs this has it."""


PEERS = (
    Peer(
        "animat, rays",
        "with_animat:wander_linear",
        ("animat", "numba", "numpy"),
        (1, 100),
        "nothing; needs and drives run as well, acts do not",
        installed=True,
    ),
    Peer(
        "animat, michel1996",
        "with_animat:wander_michel1996",
        ("animat", "numba", "numpy"),
        (1, 100),
        "nothing; fifteen probes to a sensor in place of one ray; needs and drives run as well",
        installed=True,
    ),
    Peer(
        "animat, a life",
        "with_animat:live",
        ("animat", "numba", "numpy"),
        (1, 100),
        "nothing; as before, and it goes to objects and acts on them, when it does not look round",
        installed=True,
    ),
    Peer(
        "Numba loop",
        "with_numba:start",
        ("numba", "numpy"),
        (1, 100),
        "needs; the same numbers on every machine",
        installed=True,
    ),
    Peer(
        "NumPy loop",
        "with_numpy:start",
        ("numpy",),
        (1, 10, 100, 1000, 10_000),
        "needs",
        installed=True,
    ),
    Peer(
        "kheperax",
        "with_kheperax:start",
        ("kheperax", "jax", "jaxlib", "numpy"),
        (1, 100, 1000),
        "needs; where sensors sit; going on after a touch: such a robot stays where it is",
    ),
    Peer(
        "pymunk",
        "with_pymunk:start",
        ("pymunk",),
        (1,),
        "needs; noise; knowing that it is blocked: it slides along",
    ),
    Peer(
        "Mesa",
        "with_mesa:start",
        ("mesa", "numpy", "scipy"),
        (1,),
        "needs; rays: a sensor sees the nearest thing in its sector; noise of sensors",
    ),
    Peer(
        "VMAS",
        "with_vmas:start",
        ("vmas", "torch", "numpy"),
        (1, 100, 1000, 10_000),
        "needs; where sensors sit and look: eight even rays from the centre",
    ),
    Peer(
        "ir-sim",
        "with_irsim:start",
        ("ir-sim", "numpy", "shapely"),
        (1,),
        "needs; where sensors sit and look: eight even rays from the centre; going on after a "
        "touch",
    ),
)


class PeerError(Exception):
    """A simulator could not be installed or measured."""


def python_of(peer: Peer, folder: Path) -> str:
    """Return the Python that has a simulator, installing it if need be. Raises PeerError."""
    if peer.installed:
        return sys.executable
    place = folder / peer.packages[0]
    python = place / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    wanted = "\n".join(pins(peer.packages))
    done = place / "installed.txt"
    if done.is_file() and done.read_text(encoding="utf-8") == wanted:
        return str(python)
    print(f"installing {' '.join(pins(peer.packages))} in {place}", file=sys.stderr, flush=True)
    venv.create(place, clear=True, with_pip=True)
    output([str(python), "-m", "pip", "install", "--quiet", *pins(peer.packages)])
    done.write_text(wanted, encoding="utf-8")
    return str(python)


def pins(packages: Sequence[str]) -> list[str]:
    """Return the lines of requirements.txt that pin these packages."""
    lines = (HERE / "requirements.txt").read_text(encoding="utf-8").splitlines()
    pinned = {line.partition("==")[0]: line for line in lines if "==" in line}
    return [pinned[name] for name in packages]


def output(command: list[str]) -> str:
    """Run a command and return what it says. Raises PeerError with the last line of its errors."""
    threads = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    try:
        run = subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            timeout=LIMIT,
            env={**os.environ, **threads, "MPLBACKEND": "Agg"},
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise PeerError(str(error)) from error
    if run.returncode:
        lines = run.stderr.strip().splitlines() or [f"exit code {run.returncode}"]
        errors = [line for line in lines if line.startswith("ERROR")]
        raise PeerError((errors or lines)[-1])
    return run.stdout

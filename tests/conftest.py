"""Tests are the same wherever they are run, on a busy machine too, and share what they compile.

Hypothesis tries few examples in every run, the same ones in CI, so that it fails for a change only;
with `--hypothesis-profile=nightly` many. And Ctrl-C is taken as at a terminal, also where a shell
has started the tests in the background and had them pay no heed to it.
"""

from __future__ import annotations

import fcntl
import math
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from .experiments.lived import lived  # noqa: F401
from .experiments.published import published, reproduced  # noqa: F401

# A process that reads bytecode starts in a third of the time, and there are many, whatever the
# shell says.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

settings.register_profile(
    "default", deadline=None, max_examples=12, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("ci", settings.get_profile("default"), derandomize=True, max_examples=15)
settings.register_profile("nightly", settings.get_profile("default"), max_examples=500)
settings.load_profile("ci" if os.environ.get("CI") else "default")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


LOST = """
def walk(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    memory[0] += 1.0
    seldom = turn == 2 or turn == 3
    if turn == 1 or u_a < 0.0005 or (u_a < 0.002 and not seldom):
        if turn != 3:
            raise ValueError("lost")
        return float(speed), (speed - speed) / (turn - turn)
    return float(speed), speed - float(int(u_b * 3.0))
"""


@pytest.fixture(scope="session")
def lost() -> str:
    """A file own.py with a controller that fails: now and then; always, if `turn_speed` is 1; but
    seldom if it is 2; and if it is 3, as seldom, with what is no number.

    A kernel takes seconds to compile, and is shared by all that have the same file under the same
    name.
    """
    return LOST


@pytest.fixture(scope="session")
def compiled() -> None:
    """Have the kernels of a life compiled, so that no command tells that it compiles them."""
    from animat.life.life import live
    from animat.mind.mind import Mind
    from animat.world.world import World

    world = World.random({"TS": 1, "CL": 1}, seed=1)
    for record in (None, "all"):
        live(Mind(), world, steps=1, record=record)


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have figures made but not drawn, where they are not the point, as drawing takes seconds."""
    from animat.figures import style

    blank = style.new_figure(1, 1)
    drawn = {"svg": style.svg(blank), "png": style.png(blank)}
    monkeypatch.setattr(style, "_render", lambda fig, kind, *_, **__: drawn[kind])


@pytest.fixture
def commanded(compiled: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Be in an empty directory, where no command tells of its progress before its end."""
    from animat import progress

    monkeypatch.setattr(progress, "LINE_EVERY", math.inf)
    monkeypatch.chdir(tmp_path)


SHARED = ("lived", "published")
"""Fixtures that take long and are used in several folders."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with what is long, so that workers do not wait for it in the end; and let those follow
    one another that share much, so that one worker has it.
    """

    def place(item: pytest.Item) -> int:
        if item.get_closest_marker("long"):
            return 0
        used = [name in getattr(item, "fixturenames", ()) for name in SHARED]
        return 1 + (used.index(True) if any(used) else len(SHARED))

    items.sort(key=place)


def compile_once() -> None:
    """Let one of several workers compile a kernel, and the others wait and read what it kept."""
    from numba.core.caching import FunctionCache
    from numba.core.compiler_lock import global_compiler_lock
    from numba.core.dispatcher import Dispatcher

    from animat.numerics.linked import Linked

    @contextmanager
    def one_at_a_time(file: Any) -> Iterator[None]:
        # The lock among threads comes first, so that none holds this one and waits for that.
        with global_compiler_lock, Path(f"{file._index_path}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            yield

    alone, linked_alone = Dispatcher.compile, Linked._kernel

    def compile_or_wait(self: Any, signature: Any) -> Any:
        if not isinstance(self._cache, FunctionCache):
            return alone(self, signature)
        self._cache._impl.locator.ensure_cache_path()
        with one_at_a_time(self._cache._cache_file):
            return alone(self, signature)

    def link_or_wait(self: Any, counts: Any, functions: Any) -> Any:
        with one_at_a_time(self._file()):
            return linked_alone(self, counts, functions)

    Dispatcher.compile = compile_or_wait
    Linked._kernel = link_or_wait


if os.environ.get("PYTEST_XDIST_WORKER"):
    compile_once()

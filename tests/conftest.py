"""Tests are the same wherever they are run, on a busy machine too, and share what they compile.

Hypothesis tries few examples in every run, the same ones in CI, so that it fails for a change only;
with `--hypothesis-profile=nightly` many. And Ctrl-C is taken as at a terminal, also where a shell
has started the tests in the background and had them pay no heed to it.
"""

from __future__ import annotations

import fcntl
import os
import signal
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, settings

settings.register_profile(
    "default", deadline=None, max_examples=30, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("ci", settings.get_profile("default"), derandomize=True)
settings.register_profile("nightly", settings.get_profile("default"), max_examples=500)
settings.load_profile("ci" if os.environ.get("CI") else "default")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def compile_once() -> None:
    """Let one of several workers compile a kernel, and the others wait and read what it kept."""
    from numba.core.caching import FunctionCache
    from numba.core.compiler_lock import global_compiler_lock
    from numba.core.dispatcher import Dispatcher

    alone = Dispatcher.compile

    def compile_or_wait(self: Any, signature: Any) -> Any:
        if not isinstance(self._cache, FunctionCache):
            return alone(self, signature)
        self._cache._impl.locator.ensure_cache_path()
        name = f"{self._cache._impl.filename_base}.lock"
        # The lock among threads comes first, so that none holds this one and waits for that.
        with global_compiler_lock, (Path(self._cache.cache_path) / name).open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            return alone(self, signature)

    Dispatcher.compile = compile_or_wait


if os.environ.get("PYTEST_XDIST_WORKER"):
    compile_once()

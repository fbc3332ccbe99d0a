"""Threads for compiled code: results, errors and interruptions come out of it."""

from __future__ import annotations

import os
import signal
import threading
from concurrent.futures import CancelledError

import numba
import numpy as np
import pytest

from animat.numerics import threads as module
from animat.numerics.threads import KernelThreads, attempt


@numba.njit(nogil=True)
def until_told(flag):
    """Come back once flag[0] is set by somebody else."""
    place = 0
    while flag[0] == 0.0:
        place = (place + 1) % 3
        flag[1 + place] += 1.0


@pytest.fixture
def stuck(monkeypatch):
    """A kernel that does not return before the end of the test, and interrupts when it is at it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    monkeypatch.setattr(module, "PATIENCE", 0.0)
    flag = np.zeros(4)
    until_told(np.ones(4))

    def kernel():
        os.kill(os.getpid(), signal.SIGINT)
        until_told(flag)

    yield kernel
    flag[0] = 1.0
    for thread in threading.enumerate():
        if thread.name == "animat":
            thread.join()
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_results_and_errors_come_back(count):
    with KernelThreads(count) as pool:
        assert list(pool.map(pow, range(20), [2] * 20)) == [n * n for n in range(20)]
        failing = pool.submit(int, "x")
        assert pool.submit(dict, a=1).result() == {"a": 1}
        with pytest.raises(ValueError, match="invalid literal"):
            failing.result()
        ending = pool.submit(next, iter(()))
        assert isinstance(ending.exception(), StopIteration)
    assert "animat" not in {thread.name for thread in threading.enumerate()}


def test_an_error_of_the_caller_cancels_what_has_not_begun():
    begun, go_on = threading.Event(), threading.Event()

    def first():
        begun.set()
        go_on.wait()

    pool = KernelThreads(1)
    one, waiting = pool.submit(first), pool.submit(int)
    begun.wait()
    # What is under way comes to its end only once what waits is cancelled.
    waiting.add_done_callback(lambda _: go_on.set())
    pool.__exit__(KeyError, KeyError(), None)
    one.result()
    with pytest.raises(CancelledError):
        waiting.result()


def test_an_interruption_comes_out_of_a_kernel_that_never_returns(stuck):
    with pytest.raises(KeyboardInterrupt):
        attempt(stuck)


def test_what_is_raised_is_handed_back():
    def raises(error):
        raise error

    assert attempt(lambda: 3) == (3, None)
    for error in (ValueError("no"), MemoryError(), StopIteration()):
        assert attempt(lambda error=error: raises(error)) == (None, error)


def test_uncompiled_code_stays_in_the_thread_of_its_debugger(monkeypatch):
    monkeypatch.setattr(module.config, "DISABLE_JIT", True)
    assert attempt(threading.current_thread) == (threading.main_thread(), None)

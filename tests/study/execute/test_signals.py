"""Ctrl-C once and twice."""

from __future__ import annotations

import os
import signal
import threading

import pytest

from animat.study.execute.signals import ASKED, interruptible


@pytest.fixture(autouse=True)
def heeded():
    """Heed SIGINT, though these tests may run where it is ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupt():
    os.kill(os.getpid(), signal.SIGINT)


def test_once_asks_and_twice_stops(capsys):
    stop = threading.Event()
    with interruptible(stop) as asked:
        assert not asked.is_set()
        interrupt()
        assert asked.is_set()
        assert not stop.is_set()
        assert capsys.readouterr().err == ASKED
        with pytest.raises(KeyboardInterrupt):
            interrupt()
    assert stop.is_set()


def test_afterwards_it_is_as_before():
    with interruptible(threading.Event()):
        pass
    with pytest.raises(KeyboardInterrupt):
        interrupt()


def test_who_cares_for_it_or_ignores_it_goes_on_doing_so():
    called = []
    for handler in (lambda *_: called.append(1), signal.SIG_IGN):
        signal.signal(signal.SIGINT, handler)
        with interruptible(threading.Event()) as asked:
            interrupt()
        assert not asked.is_set()
        assert signal.getsignal(signal.SIGINT) is handler
    assert called == [1]


def test_another_thread_leaves_it_alone():
    found = []

    def within():
        with interruptible(threading.Event()):
            found.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=within)
    thread.start()
    thread.join()
    assert found == [signal.default_int_handler]

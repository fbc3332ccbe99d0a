"""The lock of a results directory: one holder at a time, and a dead one is no holder."""

import os
import signal
import socket
import subprocess
import sys
from contextlib import contextmanager

import pytest

from animat.files import lock as module
from animat.files.lock import HeldError, hold, holder

HOLDING = """
import sys
from pathlib import Path
from animat.files.lock import hold
with hold(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""


@contextmanager
def other_process(lock):
    """Another process that holds the lock until its input ends."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDING, str(lock)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "held\n"
    try:
        yield process
    finally:
        process.communicate()


def test_a_directory_is_held_and_let_go(tmp_path):
    lock = tmp_path / "lock"
    assert holder(lock) == (None, False)
    with hold(lock) as before:
        assert before is None
        who, held = holder(lock)
        assert held
        assert who is not None
        assert (who.pid, who.host) == (os.getpid(), socket.gethostname())
    assert holder(lock) == (None, False)
    with hold(lock) as before:
        assert before is None


def test_the_second_is_told_who_holds_it(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.05)
    lock = tmp_path / "lock"
    with other_process(lock) as first:
        who, held = holder(lock)
        assert held
        with pytest.raises(HeldError) as refused, hold(lock):
            pytest.fail("two hold it")
        assert str(refused.value).startswith(
            f"{tmp_path}: is held by process {first.pid} on {socket.gethostname()}, since 20"
        )
        assert str(who) in str(refused.value)
        assert holder(lock) == (who, True)
    with hold(lock) as before:
        assert before is None


def test_a_dead_holder_is_recognised_as_dead(tmp_path):
    lock = tmp_path / "lock"
    with other_process(lock) as first:
        first.send_signal(signal.SIGKILL)
        first.wait()
    who, held = holder(lock)
    assert not held
    with hold(lock) as before:
        assert before == who
        assert before is not None
        assert before.pid == first.pid
    assert holder(lock) == (None, False)


def test_who_only_looks_keeps_nobody_out(tmp_path, monkeypatch):
    """One look lasts for as long as the lock is not asked for in vain; then it ends."""
    lock = tmp_path / "lock"
    lock.touch()
    look = os.open(lock, os.O_RDONLY)
    module.fcntl.flock(look, module.fcntl.LOCK_SH)
    monkeypatch.setattr(module.time, "sleep", lambda _: os.close(look))
    with hold(lock):
        assert holder(lock)[1]


@pytest.mark.parametrize(
    "words", ["", "{", '{"pid": 1}', "[1, 2]", "null", "\x00" * 9, "7", "[" * 4096]
)
def test_torn_words_are_nobodys(tmp_path, words, monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.0)
    lock = tmp_path / "lock"
    lock.write_text(words)
    assert holder(lock) == (None, False)
    with hold(lock) as before:
        assert before is None
        lock.write_text(words)
        with pytest.raises(HeldError, match="is held by another process"), hold(lock):
            pytest.fail("two hold it")


def test_an_error_lets_go(tmp_path):
    lock = tmp_path / "lock"
    with pytest.raises(ZeroDivisionError), hold(lock):
        raise ZeroDivisionError
    assert holder(lock) == (None, False)


def test_a_place_that_cannot_be_written_is_told():
    with pytest.raises(OSError, match="lock"), hold(module.Path("/proc/none/lock")):
        pytest.fail("it is held")

"""What is told of long work: plain lines to a file, bars on a terminal."""

import io
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from types import SimpleNamespace

import pytest

from animat import progress
from animat.progress import LINE_EVERY, in_words, telling


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(progress, "time", clock)
    return clock


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_finished_task_is_one_line(capsys, clock):
    with telling() as tell:
        tell("Lives", 400, 1_000)
        clock.now += 1.0
        tell("Lives", 600, 1_000)
    out, err = capsys.readouterr()
    assert err == "Lives: 1,000 of 1,000, 1 s\n"
    assert out == ""


def test_long_work_is_told_now_and_then_with_the_time_left(capsys, clock):
    with telling() as tell:
        for _ in range(20):
            tell("Lives", 5, 1_000)
            clock.now += 1.0
        tell("Lives", 900, 1_000)
    lines = capsys.readouterr().err.splitlines()
    assert lines == [
        "Lives: 30 of 1,000, about 3 min left",
        "Lives: 55 of 1,000, about 3 min left",
        "Lives: 80 of 1,000, about 3 min left",
        "Lives: 1,000 of 1,000, 20 s",
    ]
    assert LINE_EVERY == 5.0


def test_tasks_are_told_apart(capsys, clock):
    with telling() as tell:
        tell("One", 1, 2)
        tell("Two", 2, 2)
        tell("One", 1, 2)
    assert capsys.readouterr().err == "Two: 2 of 2, 0 s\nOne: 2 of 2, 0 s\n"


def test_nobody_can_tell_what_is_left_before_anything_is_done(capsys, clock):
    with telling() as tell:
        tell("Lives", 0, 10)
        clock.now += 6.0
        tell("Lives", 0, 10)
    assert capsys.readouterr().err == "Lives: 0 of 10\n"


def test_what_was_done_before_is_no_part_of_the_speed(capsys, clock):
    with telling() as tell:
        tell("Lives", 900, 1_000)
        clock.now += 10.0
        tell("Lives", 20, 1_000)
    assert capsys.readouterr().err == "Lives: 920 of 1,000, about 40 s left\n"


def test_a_note_stands_in_the_place_of_the_time_left(capsys, clock):
    with telling() as tell:
        tell("Lives", 0, 10, "nobody knows")
        clock.now += 6.0
        tell("Lives", 5, 10, "2 of 4 cases")
        tell("Lives", 5, 10, "4 of 4 cases")
    assert capsys.readouterr().err == "Lives: 5 of 10, 2 of 4 cases\nLives: 10 of 10, 6 s\n"


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.2, "0 s"),
        (99.4, "99 s"),
        (99.6, "2 min"),
        (3_600.0, "60 min"),
        (5_970.0, "1 h 40 min"),
        (7_500.0, "2 h 5 min"),
        (47.9 * 3_600, "47 h 54 min"),
        (72.2 * 3_600, "3 days"),
    ],
)
def test_durations_are_said_as_people_say_them(seconds, words):
    assert in_words(seconds) == words


class Slow(int):
    """A number that lets other threads run while it is added."""

    def __radd__(self, other: int) -> int:
        time.sleep(0.001)
        return int(self) + other


def test_threads_may_tell_at_once(capsys):
    with telling() as tell, ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda _: tell("Lives", Slow(1), 50), range(50)))
    assert capsys.readouterr().err.startswith("Lives: 50 of 50")


def test_a_terminal_gets_bars(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("TERM", "xterm")
    with telling() as tell, ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda _: tell("Lives", 1, 100), range(100)))
        tell("Statistics", 1, 3)
        tell("Noted", 1, 3, "two to go")
    shown = terminal.getvalue()
    assert "Lives" in shown
    assert "100/100" in shown
    assert "1/3" in shown
    assert "left" in shown
    assert "two to go" in shown


def test_bars_go_away_with_an_error(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("TERM", "xterm")

    def interrupted():
        with telling() as tell:
            tell("Lives", 1, 3)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    # The cursor is shown again.
    assert terminal.getvalue().rstrip().endswith("\x1b[?25h")


class Widget(nullcontext):
    def clear_output(self, wait):
        pass


@pytest.fixture
def shown(monkeypatch):
    """What a notebook is given to show."""
    shown = []
    shell = SimpleNamespace(kernel=None)
    modules = {
        "IPython": SimpleNamespace(get_ipython=lambda: shell),
        "IPython.display": SimpleNamespace(display=shown.append),
        "ipywidgets": SimpleNamespace(Output=Widget),
    }
    for name, module in modules.items():
        monkeypatch.setitem(sys.modules, name, module)
    return shown


def test_bars_are_shown_in_a_notebook_and_nothing_is_printed(shown, monkeypatch, capsys):
    monkeypatch.setattr(progress, "find_spec", lambda name: name)
    with telling() as tell:
        tell("Lives", 400, 1_000)
        tell("Lives", 600, 1_000)
    assert any(isinstance(each, Widget) for each in shown)
    assert "Lives" in str([getattr(each, "html", "") for each in shown])
    assert capsys.readouterr() == ("", "")


def test_a_notebook_that_cannot_show_bars_is_told_in_lines(shown, monkeypatch, capsys):
    monkeypatch.setattr(progress, "find_spec", lambda name: None)
    with telling() as tell:
        tell("Lives", 1_000, 1_000)
    assert capsys.readouterr().err == "Lives: 1,000 of 1,000, 0 s\n"
    assert not shown

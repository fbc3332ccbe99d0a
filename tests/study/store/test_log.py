"""The log: a line for each event, torn lines passed over, no clock that goes back."""

import json
from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.study.store import log as module
from animat.study.store.log import entries, logging_to

EVENTS = [("start", {"threads": 2}), ("part", {"number": 0, "lives": 8}), ("end", {"done": True})]


def written(path, events=EVENTS):
    with logging_to(path) as log:
        for event, facts in events:
            log(event, **facts)


def told(path):
    return [(e.pop("event"), e) for e in entries(path) if [e.pop(k) for k in ("at", "seconds")]]


def test_what_is_taken_down_is_read_back(tmp_path):
    path = tmp_path / "log"
    written(path)
    written(path, [("start", {"threads": 1})])
    assert told(path) == [*EVENTS, ("start", {"threads": 1})]
    lines = path.read_text().splitlines()
    assert len(lines) == 4
    assert all(json.loads(line)["event"] for line in lines)


def test_no_log_is_an_empty_one(tmp_path):
    assert list(entries(tmp_path / "none")) == []


@given(cut=st.integers(0, 300))
def test_a_torn_line_is_passed_over_and_the_next_one_is_whole(tmp_path_factory, cut):
    path = tmp_path_factory.mktemp("log") / "log"
    written(path)
    whole = path.read_bytes()
    path.write_bytes(whole[:cut])
    kept = [line for line in whole[:cut].split(b"\n") if line.endswith(b"}")]
    written(path, [("again", {})])
    assert told(path) == [*EVENTS[: len(kept)], ("again", {})]


@pytest.mark.parametrize(
    "line", [b"\xff\xfe", b"null", b"7", b"[]", b"{}", b'{"event"', b"[" * 9_000]
)
def test_what_is_no_event_is_passed_over(tmp_path, line):
    path = tmp_path / "log"
    path.write_bytes(line + b"\n")
    written(path)
    assert told(path) == EVENTS


def test_a_clock_that_goes_back_makes_no_time_run_backwards(tmp_path, monkeypatch):
    class Clock:
        now_is = datetime(2020, 1, 1, tzinfo=UTC)

        @classmethod
        def now(cls, zone):
            cls.now_is -= timedelta(hours=1)
            return cls.now_is

    monkeypatch.setattr(module, "datetime", Clock)
    path = tmp_path / "log"
    written(path)
    seconds = [entry["seconds"] for entry in entries(path)]
    assert seconds == sorted(seconds)
    assert seconds[0] >= 0.0

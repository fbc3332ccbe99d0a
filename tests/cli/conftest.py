"""The command line, called in an empty directory."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import NamedTuple

import pytest

from animat.cli import main


class Said(NamedTuple):
    """How a command ended and what it printed."""

    code: int
    out: str
    err: str


@pytest.fixture
def animat(commanded, monkeypatch, capsys) -> Callable[..., Said]:

    def run(*arguments: str) -> Said:
        monkeypatch.setattr(sys, "argv", ["animat", *arguments])
        with pytest.raises(SystemExit) as end:
            main()
        out, err = capsys.readouterr()
        assert isinstance(end.value.code, int)
        assert "Traceback" not in err
        return Said(end.value.code, out, err)

    return run

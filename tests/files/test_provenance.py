"""How a result was made."""

import json
import os
import platform
import sys
from datetime import UTC, datetime
from importlib.metadata import version

import numpy as np

from animat.files import provenance as module
from animat.files.provenance import provenance


def test_it_tells_time_command_versions_and_machine(monkeypatch):
    monkeypatch.setattr(sys, "argv", ["/somewhere/animat", "reproduce", "--out", "my results"])
    before = datetime.now(UTC).replace(microsecond=0)
    made = json.loads(json.dumps(provenance()))
    assert before <= datetime.fromisoformat(made["made"]) <= datetime.now(UTC)
    assert made["command"] == "animat reproduce --out 'my results'"
    assert made["versions"]["numpy"] == np.__version__
    assert made["versions"]["python"] == platform.python_version()
    assert made["versions"]["llvmlite"] == version("llvmlite")
    assert made["machine"]["cores"] == os.cpu_count()
    assert made["machine"]["processor"]


def test_what_is_not_installed_is_said_to_be_so(monkeypatch):
    monkeypatch.setattr(module, "PACKAGES", ("numpy", "no-such-package-at-all"))
    versions = provenance()["versions"]
    assert versions == {
        "python": platform.python_version(),
        "numpy": np.__version__,
        "no-such-package-at-all": "not installed",
    }

"""Measure everything: steps, threads, starting up, calls, parts of a step, and custom functions.

    python bench/all.py [--markdown] [--json FILE]

Each is a process of its own, a program that can be run alone; each says its machine, versions and
command. Takes some minutes. Measure on a machine that does nothing else, or look at the load that
each tells. How fast others do the same work is measured by `bench/peers/run.py`.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import figures

PROGRAMS = ("speed", "threads", "startup", "calls", "parts", "functions")


def main() -> None:
    """Run every program, and put what they found into one file where asked."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--only", nargs="+", choices=PROGRAMS, default=PROGRAMS)
    figures.add_output(parser)
    options = parser.parse_args()
    found = {}
    for name in options.only:
        print(f"{'## ' if options.markdown else ''}bench/{name}.py\n", flush=True)
        with tempfile.TemporaryDirectory() as folder:
            said = Path(folder) / "said.json"
            command = [sys.executable, str(Path(__file__).with_name(f"{name}.py"))]
            command += ["--json", str(said)]
            command += ["--markdown"] * options.markdown + ["--tiny", "--repeat=1"] * options.tiny
            subprocess.run(command, check=True)
            found[name] = json.loads(said.read_text(encoding="utf-8"))
    figures.closed(found, options.json)


if __name__ == "__main__":
    main()

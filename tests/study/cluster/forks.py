"""A process that has imported what schedulers and workers need, and forks one when it is asked.

    python forks.py

On its input a line of JSON asks for a process, [arguments of dask, folder, environment], or waits
for the end of one, its id; on its output the id answers. All end with it, and it with its input.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path


class Fork:
    """A process that was forked, as `subprocess` has one."""

    def __init__(self, forks: Forks, pid: int) -> None:
        self.forks, self.pid = forks, pid

    def kill(self) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.pid, signal.SIGKILL)

    def wait(self) -> None:
        assert self.forks.ask(self.pid) == self.pid


class Forks:
    """The process that forks others."""

    def __init__(self, environment: Mapping[str, str]) -> None:
        self.process = subprocess.Popen(
            [sys.executable, __file__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=environment,
            text=True,
        )

    def ask(self, what: list | int) -> int:
        """Ask it for something, and return its answer."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(json.dumps(what) + "\n")
        self.process.stdin.flush()
        return int(self.process.stdout.readline())

    def start(self, arguments: list[str], cwd: Path, environment: Mapping[str, str]) -> Fork:
        """Start `dask` in a folder."""
        return Fork(self, self.ask([arguments, str(cwd), dict(environment)]))

    def end(self) -> None:
        """End it, and all it has forked."""
        self.process.communicate()


def main() -> None:
    import dask.config
    from distributed.cli import dask_scheduler, dask_worker

    import animat.study.execute.shard  # noqa: F401
    from animat import Mind, World, live

    live(Mind(), World.abundant(), steps=1)
    roles = {"scheduler": dask_scheduler.main, "worker": dask_worker.main}
    children = set()
    for line in sys.stdin:
        asked = json.loads(line)
        if isinstance(asked, int):
            os.waitpid(asked, 0)
            children.remove(asked)
        else:
            (role, *arguments), folder, environment = asked
            if not (asked := os.fork()):
                nothing = os.open(os.devnull, os.O_RDWR)
                for stream in range(3):
                    os.dup2(nothing, stream)
                os.chdir(folder)
                os.environ.clear()
                os.environ.update(environment)
                dask.config.refresh(paths=[environment["DASK_CONFIG"]])
                roles[role](arguments)
            children.add(asked)
        sys.stdout.write(f"{asked}\n")
        sys.stdout.flush()
    for child in children:
        with contextlib.suppress(ProcessLookupError):
            os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


if __name__ == "__main__":
    main()

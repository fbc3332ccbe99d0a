"""Jobs of a batch system that are workers of a Dask scheduler, which runs here.

What a job is like, dask-jobqueue's own configuration says. Scheduler, workers and client speak TLS:
with the certificates of Dask's configuration, else with some that are made for this run alone.
"""

from __future__ import annotations

import importlib
import os
import shlex
import shutil
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import dask.config
from distributed.core import Status
from distributed.security import Security

from animat.files.settings import SettingsError
from animat.study.cluster.worker import ClusterError


class Batch:
    """So many jobs, kept up: where one has ended, another is asked for."""

    def __init__(self, cluster: Any, jobs: int) -> None:
        """Take a cluster of dask-jobqueue."""
        self.cluster = cluster
        self._jobs = jobs

    async def keep(self) -> None:
        """See that there are as many jobs as wanted. Raises ClusterError if they are refused."""
        self.cluster.scale(jobs=self._jobs)
        refused = None
        for job in list(self.cluster.workers.values()):
            try:
                await job
            except (OSError, RuntimeError, ValueError) as error:
                refused = error
                job.status = Status.failed  # a cluster cannot be closed with a job in between
        if refused is not None:
            told = str(refused).rpartition("stderr:")[2]
            raise ClusterError(f"no job can be had: {' '.join(told.split())}") from refused


@contextmanager
def batch(name: str, kind: str, jobs: int) -> Iterator[Batch]:
    """Yield a batch system, by its name and dask-jobqueue's class; no job is asked for yet.

    Raises SettingsError where it is not there, or not configured.
    """
    made = getattr(_jobqueue(), kind)
    command = shlex.split(made.job_cls.submit_command)[0]
    if shutil.which(command) is None:
        raise SettingsError(f"--cluster {name}: there is no command {command} here")
    options = _options(name)
    with _security(f"jobqueue.{name}") as security:
        try:
            cluster = made(**options, security=security)
        except (OSError, RuntimeError, TypeError, ValueError) as error:
            raise SettingsError(f"--cluster {name}: {' '.join(str(error).split())}") from error
        try:
            yield Batch(cluster, jobs)
        finally:
            cluster.close()


def _jobqueue() -> Any:
    """Return dask-jobqueue, which takes Ctrl-C to itself when it is imported, and may not."""
    before = signal.getsignal(signal.SIGINT)
    try:
        return importlib.import_module("dask_jobqueue")
    finally:
        signal.signal(signal.SIGINT, before)


def _options(name: str) -> dict[str, Any]:
    """Return what of a cluster is not as dask-jobqueue would have it."""
    configured = f"jobqueue.{name}"
    lacking = [key for key in ("cores", "memory") if dask.config.get(f"{configured}.{key}") is None]
    if lacking:
        raise SettingsError(
            f"--cluster {name}: dask-jobqueue is not told how much {' and '.join(lacking)} a job"
            f" has: set {' and '.join(f'{configured}.{key}' for key in lacking)} in"
            f" {Path(dask.config.PATH) / 'jobqueue.yaml'}"
        )
    # Nobody is shown pages that nobody asked for.
    scheduler = {"dashboard_address": "127.0.0.1:0"}
    options: dict[str, Any] = {
        "scheduler_options": scheduler | (dask.config.get(f"{configured}.scheduler-options") or {})
    }
    if dask.config.get(f"{configured}.processes") is None:
        # A kernel lets other threads run, so that one process can use all cores of a job.
        options["processes"] = 1
    return options


@contextmanager
def _security(configured: str) -> Iterator[Security]:
    """Yield the certificates of Dask's configuration, or some in files that jobs can read."""
    security = Security()
    if security.tls_scheduler_cert is not None:
        yield security
        return
    key = f"{configured}.shared-temp-directory"
    folder = os.path.expandvars(dask.config.get(key) or Path.cwd())
    if any(letter.isspace() for letter in folder):
        raise SettingsError(f"{folder}: has a blank, which a job cannot do with; set {key}")
    made = Security.temporary()
    with TemporaryDirectory(prefix=".animat-", dir=Path(folder).expanduser()) as private:
        files = {"cert": Path(private) / "cert.pem", "key": Path(private) / "key.pem"}
        files["cert"].write_text(str(made.tls_client_cert))
        files["key"].write_text(str(made.tls_client_key))
        roles = {
            f"tls_{role}_{what}": str(path)
            for role in ("scheduler", "worker", "client")
            for what, path in files.items()
        }
        yield Security(require_encryption=True, tls_ca_file=str(files["cert"]), **roles)

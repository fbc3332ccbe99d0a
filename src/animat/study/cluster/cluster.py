"""The workers of a cluster, reached through Dask.

A cluster is the address of a Dask scheduler, or the name of a batch system; for the latter a
scheduler is started here, and jobs that are its workers. docs/cluster.md says how both are set up.
"""

from __future__ import annotations

import asyncio
import logging
import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from importlib.metadata import version
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from animat.files.settings import SettingsError, nearest
from animat.files.validation_errors import plain
from animat.study.cluster.worker import ClusterError
from animat.study.execute.run import Workers
from animat.study.plan.plan import Plan

if TYPE_CHECKING:
    from distributed import Client
    from distributed.security import Security

BATCH_SYSTEMS = {
    "slurm": "SLURMCluster",
    "pbs": "PBSCluster",
    "sge": "SGECluster",
    "lsf": "LSFCluster",
    "htcondor": "HTCondorCluster",
    "oar": "OARCluster",
    "moab": "MoabCluster",
}
"""The batch systems that can be named, and dask-jobqueue's class for each."""

ADDRESS = re.compile(r"(tcp|tls)://(\[[0-9A-Fa-f:.]+\]|[\w.-]+):(?P<port>\d{1,5})", re.ASCII)

LAST_PORT = 65535

NEEDED = ("distributed", "dask_jobqueue", "cryptography")
"""What the extra installs."""

CONNECTING = 10.0
"""Seconds to wait for a scheduler."""

NOISY = (
    *("distributed", "distributed.client", "distributed.gc"),
    *("tornado", "tornado.application", "asyncio"),
)
"""Loggers of what is told here in other words, or helps nobody."""


class ClusterWorkers(Workers):
    """Workers of which there are now more and now fewer."""

    @property
    def count(self) -> int:
        """How many parts can be lived at a time; one, which has to wait, where nobody is there."""
        remote: Any = self.executor
        return max(1, remote.threads)


@contextmanager
def cluster(
    where: str, plan: Plan, say: Callable[[str], None], jobs: int | None = None
) -> Iterator[Workers]:
    """Yield those workers of a cluster that can live a plan.

    `where` is an address or a batch system, which is asked for so many jobs, one unless told. `say`
    tells the user something in a line.

    Raises:
        SettingsError: there can be no such cluster, or Dask is not installed or not configured.
        ClusterError: nobody answers, nobody can live this study, or the cluster has gone.
    """
    _check(where, jobs)
    with _quiet(), ExitStack() as stack:
        from animat.study.cluster.admission import Roster
        from animat.study.cluster.batch_system import batch
        from animat.study.cluster.dask_runner import Remote

        try:
            queue = None
            if where in BATCH_SYSTEMS:
                queue = stack.enter_context(batch(where, BATCH_SYSTEMS[where], jobs or 1))
            client = stack.enter_context(_client(where if queue is None else queue.cluster))
            roster = Roster(client, plan.inputs, say)
            remote = stack.enter_context(Remote(client, roster, queue))
        except (ClusterError, OSError) as error:
            raise ClusterError(f"{where}: {error}") from error
        try:
            yield ClusterWorkers(remote, 1, None)
        except ClusterError as error:
            raise ClusterError(
                f"{where}: {error}; what is finished is kept, and the same command goes on with it"
            ) from error


def _check(where: str, jobs: int | None) -> None:
    found = ADDRESS.fullmatch(where)
    if where not in BATCH_SYSTEMS:
        if found is None or int(found["port"]) > LAST_PORT:
            raise SettingsError(
                f"--cluster {plain(where)}: must be tcp://HOST:PORT or tls://HOST:PORT, the address"
                f" of a Dask scheduler, or a batch system{nearest(where, BATCH_SYSTEMS)}"
            )
        if jobs is not None:
            raise SettingsError("--jobs: only a batch system has jobs; start more workers instead")
    if any(find_spec(name) is None for name in NEEDED):
        raise SettingsError('--cluster needs more packages: pip install "animat[cluster]"')


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep what Dask says of itself from the user."""
    levels = {name: logging.getLogger(name).level for name in NOISY}
    with warnings.catch_warnings():
        import distributed  # noqa: F401  # sets the levels

        warnings.filterwarnings("ignore", module=r"(dask|distributed|dask_jobqueue)\b")
        for name in NOISY:
            logging.getLogger(name).setLevel(logging.CRITICAL)
        try:
            yield
        finally:
            for name, level in levels.items():
                logging.getLogger(name).setLevel(level)


@contextmanager
def _client(where: Any) -> Iterator[Client]:
    from distributed import Client
    from distributed.security import Security

    security = None
    if isinstance(where, str):
        security = Security()
        _see_scheduler(where, security)
    with Client(where, timeout=CONNECTING, security=security, set_as_default=False) as client:
        yield client


def _see_scheduler(address: str, security: Security) -> None:
    """See that a scheduler of this Dask is at an address. A client would wait for ever for some."""
    try:
        arguments = security.get_connection_args("client")
    except OSError as error:
        files = filter(None, security.get_tls_config_for_role("client").values())
        raise SettingsError(
            f"--cluster {address}: what Dask's configuration has for TLS cannot be used:"
            f" {', '.join(files)}: {error.strerror or error}"
        ) from error
    if address.startswith("tls:") and arguments.get("ssl_context") is None:
        raise SettingsError(
            f"--cluster {address}: Dask's configuration has no certificates for TLS; set"
            " distributed.comm.tls.ca-file, .client.cert and .client.key"
        )
    try:
        asking = asyncio.wait_for(_kind_and_version(address, arguments), CONNECTING + 1.0)
        kind, there = asyncio.run(asking)
    except (OSError, TimeoutError) as error:
        raise ClusterError(
            f"no Dask scheduler answers: {str(error) or 'no word comes back'}"
        ) from error
    except Exception as error:  # what somebody else answers can be read as anything
        raise ClusterError(f"what answers there is no Dask scheduler: {error}") from error
    if kind != "Scheduler":
        raise ClusterError(f"what answers there is no Dask scheduler but a {kind}")
    if there != (here := version("distributed")):
        raise ClusterError(f"the scheduler has distributed {there} and not {here}")


async def _kind_and_version(address: str, arguments: dict[str, Any]) -> tuple[str, str]:
    """Return what a server of Dask says it is, and its version of distributed."""
    from distributed.core import rpc

    async with rpc(address, timeout=CONNECTING, connection_args=arguments) as server:
        said: Any = await server.identity()
        has: Any = await server.versions()
        return said["type"], has["packages"]["distributed"]

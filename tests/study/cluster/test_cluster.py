"""Studies on a cluster: real schedulers and workers, all on the loopback of this machine."""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from importlib.metadata import version
from pathlib import Path
from typing import Any

import dask.config
import pytest
from distributed import Client
from distributed.security import Security

import animat
from animat import progress
from animat.cli import main
from animat.files.settings import SettingsError
from animat.study.cluster import admission as roster
from animat.study.cluster import cluster as module
from animat.study.cluster import dask_runner as remote
from animat.study.cluster.cluster import cluster
from animat.study.cluster.worker import ClusterError, begun
from animat.study.execute import run as running
from animat.study.execute.run import run, threads
from animat.study.execute.signals import interruptible
from animat.study.plan.plan import forget

from .forks import Forks
from .patience import LONGEST, PATIENT

pytestmark = pytest.mark.long

SOURCE = Path(animat.__file__).parents[1]

IMMORTAL = """
name = "immortal"
lives = 400
steps = 100_000
[mind.variables]
nutrition = { lethal = false }
stamina = { lethal = false }
restlessness = { lethal = false }
"""
"""Dozens of parts that take a moment each."""

ENDLESS = IMMORTAL.replace("100_000", "1_000_000_000")


def silent(*_, **__):
    pass


def until(there: Callable[[], Any]) -> Any:
    """Wait for something, and return it."""
    longest = time.monotonic() + LONGEST
    while not (found := there()):
        assert time.monotonic() < longest
        time.sleep(0.02)
    return found


@pytest.fixture
def beside() -> Iterator[Callable[[Callable[[], None]], None]]:
    """Do something in another thread; what it raises is raised here, who may wait for it."""
    helpers: list[threading.Thread] = []
    wrong: list[BaseException] = []

    def fail(*_: Any) -> None:
        raise wrong[0]

    def start(do: Callable[[], None]) -> None:
        def guarded() -> None:
            try:
                do()
            except BaseException as error:
                wrong.append(error)
                os.kill(os.getpid(), signal.SIGUSR1)

        helpers.append(threading.Thread(target=guarded))
        helpers[-1].start()

    before = signal.signal(signal.SIGUSR1, fail)
    yield start
    for helper in helpers:
        helper.join()
    signal.signal(signal.SIGUSR1, before)


@pytest.fixture(autouse=True)
def patient(monkeypatch) -> None:
    """Look who is there more often than users need, and wait longer for an answer."""
    monkeypatch.setattr(remote, "LOOK_EVERY", 0.1)
    monkeypatch.setattr(remote, "BRIEFLY", LONGEST)
    monkeypatch.setattr(module, "CONNECTING", LONGEST)
    monkeypatch.setattr(roster, "AT_FIRST", LONGEST)
    monkeypatch.setattr(roster, "PATIENCE", LONGEST)


class Machines:
    """Schedulers and workers, each a process of its own.

    Those that have this animat are forked where it is loaded.
    """

    def __init__(self, folder: Path, forks: Forks) -> None:
        self.folder, self.forks = folder, forks
        self.processes: list[Any] = []
        self.environment = {**os.environ, "DASK_CONFIG": str(folder), "PYTHONPATH": str(SOURCE)}

    def start(self, arguments: list[str], source: Path, cwd: Path | None = None) -> Any:
        arguments = [*arguments, "--dashboard-address", "127.0.0.1:0"]
        cwd = cwd or self.folder
        if source == SOURCE:
            process = self.forks.start(arguments, cwd, self.environment)
        else:
            process = subprocess.Popen(
                [sys.executable, "-m", "dask", *arguments],
                env=self.environment | {"PYTHONPATH": str(source)},
                cwd=cwd,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        self.processes.append(process)
        return process

    def scheduler(self, protocol: str = "tcp", source: Path = SOURCE) -> str:
        """Start a scheduler, the last process until another is started; return its address."""
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = str(free.getsockname()[1])
        where = ["--host", "127.0.0.1", "--port", port, "--protocol", protocol]
        self.start(["scheduler", *where], source)
        address = f"{protocol}://127.0.0.1:{port}"
        until(lambda: self.answers(int(port)))
        return address

    @staticmethod
    def answers(port: int) -> bool:
        with socket.socket() as tried:
            return tried.connect_ex(("127.0.0.1", port)) == 0

    def worker(self, address: str, cwd: Path | None = None, source: Path = SOURCE) -> Any:
        """Start a worker of one thread."""
        alone = ["--nthreads", "1", "--no-nanny", "--host", "127.0.0.1"]
        return self.start(["worker", address, *alone], source, cwd)

    def end(self, *processes: Any) -> None:
        ended = processes or tuple(self.processes)
        for process in ended:
            process.kill()
        for process in ended:
            process.wait()
            self.processes.remove(process)


@pytest.fixture(scope="module")
def forks() -> Iterator[Forks]:
    forks = Forks({**os.environ, "PYTHONPATH": str(SOURCE)})
    yield forks
    forks.end()


@pytest.fixture(scope="module")
def machines(tmp_path_factory, forks) -> Iterator[Machines]:
    machines = Machines(tmp_path_factory.mktemp("machines"), forks)
    yield machines
    machines.end()


@pytest.fixture(scope="module")
def plain(machines) -> str:
    """A scheduler without workers."""
    return machines.scheduler()


@pytest.fixture(scope="module")
def secure(tmp_path_factory, forks) -> Iterator[Machines]:
    """A scheduler and two workers that speak TLS, as Dask's configuration says."""
    machines = Machines(tmp_path_factory.mktemp("secure"), forks)
    made = Security.temporary()
    files = {}
    for name in ("tls_ca_file", "tls_client_cert", "tls_client_key"):
        files[name] = machines.folder / f"{name}.pem"
        files[name].write_text(str(getattr(made, name)))
    own = {"cert": str(files["tls_client_cert"]), "key": str(files["tls_client_key"])}
    tls = {"ca-file": str(files["tls_ca_file"]), "client": own, "worker": own, "scheduler": own}
    configuration = {"distributed": {"comm": {"tls": tls}}}
    (machines.folder / "tls.yaml").write_text(json.dumps(configuration))
    machines.address = machines.scheduler("tls")
    for _ in range(2):
        machines.worker(machines.address)
    own_too = {f"distributed.comm.tls.client.{key}": path for key, path in own.items()}
    with dask.config.set({"distributed.comm.tls.ca-file": tls["ca-file"]} | own_too):
        yield machines
    machines.end()


@pytest.fixture(scope="module")
def larger(faults, tmp_path_factory) -> tuple[Any, dict[str, str]]:
    """A study of some dozens of parts, and what threads write of it."""
    plan = faults.plan(faults.LARGER)
    directory = tmp_path_factory.mktemp("larger")
    faults.go_on(plan, directory)
    return plan, faults.told_of(directory)


@contextmanager
def watching(address: str) -> Iterator[Client]:
    """Look at a cluster from beside."""
    with Client(address, set_as_default=False, timeout=LONGEST) as client:
        yield client


def at_work(client: Client) -> list[str]:
    """The keys of what workers are at."""
    return [key for keys in client.run(begun).values() for key in keys]


def lived_on(address, plan, directory, tell=silent, said=None):
    with cluster(address, plan, ([] if said is None else said).append) as workers:
        return run(plan, directory, workers, tell)


def once(do: Callable[[], None]) -> Callable[..., None]:
    """Tell of progress by doing something when the first part is finished."""
    left = [do]

    def tell(task, done, total, note=""):
        if done and left:
            left.pop()()

    return tell


class TestSameBytes:
    def test_a_cluster_writes_what_threads_write(self, secure, small, finished, faults, tmp_path):
        assert lived_on(secure.address, small, tmp_path).complete
        assert faults.told_of(tmp_path) == faults.told_of(finished)

    def test_from_the_command_line_and_without_a_word_of_dask(self, secure, faults, finished):
        file = secure.folder / "small.toml"
        file.write_text(faults.SMALL)
        ran = subprocess.run(
            [sys.executable, "-c", PATIENT, "run", "small.toml", "--cluster", secure.address],
            cwd=secure.folder,
            env=secure.environment,
            capture_output=True,
            text=True,
            check=False,
        )
        assert ran.returncode == 0, ran.stderr
        assert ran.stdout.splitlines()[0].startswith("small: 2 cases, 16 lives")
        assert faults.told_of(secure.folder / "results" / "small") == faults.told_of(finished)
        told = ("Robots that learn: ", "Lives: ")
        assert all(line.startswith(told) for line in ran.stderr.splitlines()), ran.stderr

    def test_a_worker_may_die(self, secure, larger, faults, tmp_path):
        plan, whole = larger
        dies = secure.worker(secure.address)

        def kill() -> None:
            dies.kill()
            until(lambda: workers.count == 2)

        with cluster(secure.address, plan, silent) as workers:
            until(lambda: workers.count == 3)
            assert run(plan, tmp_path, workers, once(kill)).complete
        assert faults.told_of(tmp_path) == whole


class TestRefused:
    def test_a_worker_that_has_something_else_gets_nothing_to_do(
        self, machines, plain, larger, faults, tmp_path
    ):
        plan, whole = larger
        other = tmp_path / "other"
        shutil.copytree(SOURCE / "animat", other / "animat")
        engine = other / "animat" / "life" / "engine.py"
        engine.write_text("ENGINE = 99\n")
        none = tmp_path / "none"
        (none / "animat").mkdir(parents=True)
        (none / "animat" / "__init__.py").touch()
        good = machines.worker(plain)
        bad, said = [], []

        def come_later() -> None:
            bad.extend(machines.worker(plain, source=source) for source in (other, none))
            until(lambda: len([line for line in said if "is refused" in line]) == 2)

        assert lived_on(plain, plan, tmp_path / "a", once(come_later), said).complete
        assert faults.told_of(tmp_path / "a") == whole
        machines.end(good)
        refused = sorted(line.partition("is refused: ")[2] for line in said if "refused" in line)
        assert refused[0].startswith("it has another animat, or none (")
        assert "No module named 'animat.study'" in refused[0]
        assert refused[1].startswith("it has engine 99 and not ")
        assert refused[1].endswith(", other source files of animat")
        said.clear()
        with pytest.raises(ClusterError, match=f"{plain}: no worker .* can live this study"):
            lived_on(plain, plan, tmp_path / "b", said=said)
        machines.end(*bad)
        assert len(said) == 2
        assert not (tmp_path / "b").exists()

    def test_a_worker_that_has_other_files(self, machines, plain, faults, tmp_path, monkeypatch):
        here, there = tmp_path / "here", tmp_path / "there"
        here.mkdir()
        there.mkdir()
        monkeypatch.chdir(here)
        text = faults.SMALL + '[world]\nlayout = "mine.toml"\n'
        for number, folder in enumerate((here, here, there)):
            world = animat.World.random(counts={"TS": 2, "CL": number + 1}, seed=number)
            world.save(folder / "mine.toml")
        plan = faults.plan(text)
        worker = machines.worker(plain, cwd=there)

        def refused() -> str:
            said = []
            with pytest.raises(ClusterError), cluster(plain, plan, said.append) as workers:
                run(plan, tmp_path / "none", workers, silent)
            return said[-1].partition("is refused: ")[2]

        assert refused() == f"it has another mine.toml in {there}"
        (there / "mine.toml").unlink()
        assert refused() == f"it has no file mine.toml in {there}"
        found = []
        for number in range(2):
            # The same text is of other lives now, which also the worker must notice.
            animat.World.random(counts={"TS": 2}, seed=number).save(here / "mine.toml")
            shutil.copy(here / "mine.toml", there / "mine.toml")
            forget()
            plan = faults.plan(text)
            assert lived_on(plain, plan, tmp_path / f"far{number}").complete
            with threads(2) as workers:
                run(plan, tmp_path / f"near{number}", workers, silent)
            found.append(faults.told_of(tmp_path / f"far{number}"))
            assert found[-1] == faults.told_of(tmp_path / f"near{number}")
        machines.end(worker)
        assert found[0]["lives/part-000000.parquet"] != found[1]["lives/part-000000.parquet"]


class TestTheEnd:
    @pytest.fixture
    def interrupting(self, secure, beside, monkeypatch) -> Iterator[Callable[[int], list[str]]]:
        """Press Ctrl-C so many times once the workers are at something; tell at what they were."""
        keys: list[str] = []
        asked = []

        @contextmanager
        def watched(stop):
            with interruptible(stop) as event:
                asked.append(event)
                yield event

        def press(times: int) -> list[str]:
            def wait() -> None:
                keys.extend(until(lambda: at_work(client)))
                for _ in range(times):
                    os.kill(os.getpid(), signal.SIGINT)
                    asked[0].wait()

            beside(wait)
            return keys

        monkeypatch.setattr(running, "interruptible", watched)
        with watching(secure.address) as client:
            yield press
            until(lambda: not at_work(client))

    def test_the_first_interruption_finishes_what_workers_are_at(
        self, secure, interrupting, faults, tmp_path
    ):
        plan = faults.plan(IMMORTAL)
        keys = interrupting(1)
        outcome = lived_on(secure.address, plan, tmp_path)
        finished = len(list((tmp_path / "lives").glob("part-*")))
        assert not outcome.complete
        assert 1 <= len(keys) <= finished < plan.numbering["lives"].parts

    def test_the_second_stops_at_once_and_so_do_the_workers(
        self, secure, interrupting, faults, tmp_path
    ):
        keys = interrupting(2)
        with pytest.raises(KeyboardInterrupt):
            lived_on(secure.address, faults.plan(ENDLESS), tmp_path)
        assert keys
        assert not list((tmp_path / "lives").glob("part-*"))

    def test_a_scheduler_that_goes_away(
        self, machines, larger, faults, tmp_path, monkeypatch, capfd
    ):
        """As a user meets it, whose command ends and can be given again."""
        plan, whole = larger
        address = machines.scheduler()
        scheduler = machines.processes[-1]
        worker = machines.worker(address)
        with watching(address) as client:
            client.wait_for_workers(1, LONGEST)
        (tmp_path / "larger.toml").write_text(faults.LARGER)
        monkeypatch.chdir(tmp_path)
        command = ["animat", "run", "larger.toml", "--out", "results", "--cluster", address]
        monkeypatch.setattr(sys, "argv", command)
        monkeypatch.setattr(progress, "telling", lambda: nullcontext(once(scheduler.kill)))
        with pytest.raises(SystemExit) as end:
            main()
        machines.end(worker)
        assert end.value.code == 1
        assert capfd.readouterr().err == (
            f"animat: {address}: the scheduler has gone away; what is finished is kept, and the"
            " same command goes on with it\n"
        )
        directory = tmp_path / "results"
        parts = len(list((directory / "lives").glob("part-*")))
        assert parts < plan.numbering["lives"].parts
        assert parts or list((directory / "teachers").glob("part-*"))
        faults.go_on(plan, directory)
        assert faults.told_of(directory) == whole

    def test_a_scheduler_that_has_another_animat(self, machines, small, tmp_path):
        (tmp_path / "animat").mkdir()
        (tmp_path / "animat" / "__init__.py").touch()
        address = machines.scheduler(source=tmp_path)
        wanted = f"{address}: the scheduler has another animat, or none \\(No module"
        with pytest.raises(ClusterError, match=wanted):
            lived_on(address, small, tmp_path / "results")
        machines.end(machines.processes[-1])
        assert not (tmp_path / "results").exists()

    def test_a_scheduler_that_has_another_dask(self, plain, small, monkeypatch):
        there = version("distributed")
        monkeypatch.setattr("animat.study.cluster.cluster.version", lambda name: "1.0")
        wanted = f"{plain}: the scheduler has distributed {there} and not 1.0$"
        with pytest.raises(ClusterError, match=wanted), cluster(plain, small, silent):
            pass

    def test_a_part_that_kills_its_workers(self, machines, plain, beside, faults, tmp_path):
        worker = machines.worker(plain)

        def kill() -> None:
            until(lambda: at_work(client))
            worker.kill()

        def allow(dask_scheduler: Any, failures: int) -> int:
            before, dask_scheduler.allowed_failures = dask_scheduler.allowed_failures, failures
            return before

        with watching(plain) as client:
            client.wait_for_workers(1, LONGEST)
            before = client.run_on_scheduler(allow, failures=0)
            beside(kill)
            with pytest.raises(ClusterError, match="1 workers died one after another"):
                lived_on(plain, faults.plan(ENDLESS), tmp_path)
            client.run_on_scheduler(allow, failures=before)
        machines.end(worker)


class TestNotThere:
    @pytest.fixture(autouse=True)
    def soon(self, patient, monkeypatch):
        """Give up soon on those who never answer."""
        monkeypatch.setattr(module, "CONNECTING", 1.0)

    @pytest.fixture
    def fails(self, small, tmp_path):
        """What is said of an address at which no study can be lived."""

        def fails(address: str) -> str:
            with pytest.raises((ClusterError, SettingsError)) as error:
                lived_on(address, small, tmp_path / "results")
            assert not (tmp_path / "results").exists()
            (line,) = str(error.value).splitlines()
            return line

        return fails

    def test_nobody(self, fails):
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        assert f"tcp://127.0.0.1:{port}: no Dask scheduler answers: " in fails(
            f"tcp://127.0.0.1:{port}"
        )

    @pytest.mark.parametrize("answer", [b"", b"HTTP/1.1 400 Bad Request\r\nServer: other\r\n\r\n"])
    def test_somebody_else(self, fails, answer):
        with socket.create_server(("127.0.0.1", 0)) as server:

            def serve() -> None:
                connection, _ = server.accept()
                connection.sendall(answer)
                while connection.recv(4096):
                    pass
                connection.close()

            thread = threading.Thread(target=serve)
            thread.start()
            assert "Dask scheduler" in fails(f"tcp://127.0.0.1:{server.getsockname()[1]}")
            thread.join()

    def test_a_worker(self, fails, secure, monkeypatch):
        monkeypatch.setattr(module, "CONNECTING", LONGEST)
        with watching(secure.address) as client:
            address = min(until(client.nthreads))
        assert fails(address) == f"{address}: what answers there is no Dask scheduler but a Worker"

    def test_one_who_speaks_tls(self, fails, secure):
        assert "no Dask scheduler answers" in fails(secure.address.replace("tls", "tcp"))

    def test_no_certificates(self, fails):
        with dask.config.set({"distributed.comm.tls.ca-file": None}):
            assert "Dask's configuration has no certificates" in fails("tls://127.0.0.1:1")

    def test_certificates_that_are_not_there(self, fails):
        names = ("ca-file", "client.cert", "client.key")
        nowhere = {f"distributed.comm.tls.{name}": "/nowhere.pem" for name in names}
        with dask.config.set(nowhere):
            assert "/nowhere.pem" in fails("tls://127.0.0.1:1")


WRONG = [
    "localhost:8786",
    "http://localhost:8786",
    "tcp://",
    "tcp://a b:1",
    "tcp://a:b",
    "",
    "tcp://localhost:65536",
    "slrum",
]


@pytest.mark.parametrize("where", WRONG)
def test_what_is_no_cluster_is_refused(where, small):
    wanted = "must be tcp://HOST:PORT or tls://HOST:PORT"
    with pytest.raises(SettingsError, match=wanted), cluster(where, small, silent):
        pass


def test_a_misspelt_batch_system(small):
    with (
        pytest.raises(SettingsError, match='did you mean "slurm"'),
        cluster("slrum", small, silent),
    ):
        pass


def test_only_batch_systems_have_jobs(small):
    with pytest.raises(SettingsError, match="--jobs"), cluster("tcp://a:1", small, silent, 2):
        pass


@pytest.mark.parametrize("name", module.NEEDED)
def test_the_extra_that_is_not_installed(name, small, monkeypatch):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(SettingsError) as error, cluster("tcp://127.0.0.1:1", small, silent):
        pass
    assert str(error.value) == '--cluster needs more packages: pip install "animat[cluster]"'

"""Studies on a batch system, played by two shell scripts that start and end jobs here."""

from __future__ import annotations

import importlib
import json
import os
import shlex
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import dask.config
import pytest
from distributed.security import Security

import animat
from animat.files.settings import SettingsError
from animat.study.cluster import cluster as module
from animat.study.cluster import dask_runner as remote
from animat.study.cluster.batch_system import batch
from animat.study.cluster.cluster import BATCH_SYSTEMS, cluster
from animat.study.cluster.worker import ClusterError
from animat.study.execute.run import run

from .patience import LONGEST, PATIENT

pytestmark = pytest.mark.long

SBATCH = """#!/bin/sh
cp "$1" job.sh
setsid sh job.sh > job.log 2>&1 &
echo $! >> submitted
echo "Submitted batch job $!"
"""

SCANCEL = """#!/bin/sh
echo "$1" >> cancelled
kill -9 -- "-$1"
"""

REFUSES = """#!/bin/sh
echo "sbatch: error: invalid partition: nope" >&2
exit 1
"""

JOBS = {
    "cores": 2,
    "memory": "1GiB",
    "death-timeout": LONGEST,
    "scheduler-options": {"host": "127.0.0.1"},
    "worker-extra-args": [
        *("--no-nanny", "--host", "127.0.0.1"),
        *("--dashboard-address", "127.0.0.1:0"),
    ],
}


def command(path: Path, script: str) -> None:
    path.write_text(script)
    path.chmod(0o755)


def listed(path: Path) -> list[int]:
    return [int(line) for line in path.read_text().split()] if path.exists() else []


@pytest.fixture(scope="module")
def jobqueue(tmp_path_factory) -> None:
    """dask-jobqueue, imported, which writes a file and takes Ctrl-C to itself."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dask.config, "PATH", str(tmp_path_factory.mktemp("dask")))
        before = signal.getsignal(signal.SIGINT)
        importlib.import_module("dask_jobqueue")
        signal.signal(signal.SIGINT, before)


@pytest.fixture
def slurm(jobqueue, tmp_path, monkeypatch) -> Iterator[Path]:
    """A folder in which Slurm is there and configured."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(remote, "LOOK_EVERY", 0.1)
    monkeypatch.setattr(module, "CONNECTING", LONGEST)
    monkeypatch.setattr(dask.config, "PATH", str(tmp_path / "dask"))
    (tmp_path / "bin").mkdir()
    command(tmp_path / "bin" / "sbatch", SBATCH)
    command(tmp_path / "bin" / "scancel", SCANCEL)
    monkeypatch.setenv("PATH", str(tmp_path / "bin"), prepend=os.pathsep)
    with dask.config.set({f"jobqueue.slurm.{key}": value for key, value in JOBS.items()}):
        yield tmp_path
    for job in listed(tmp_path / "submitted"):
        with suppress(ProcessLookupError):
            os.killpg(job, signal.SIGKILL)


def silent(*_, **__):
    pass


def test_a_study_is_lived_by_jobs(slurm, faults, finished):
    """As a user would do it, whose configuration is a file."""
    (slurm / "dask").mkdir()
    (slurm / "dask" / "jobqueue.yaml").write_text(json.dumps({"jobqueue": {"slurm": JOBS}}))
    (slurm / "small.toml").write_text(faults.SMALL)
    ran = subprocess.run(
        [sys.executable, "-c", PATIENT, *shlex.split("run small.toml --cluster slurm --jobs 2")],
        env={
            **os.environ,
            "DASK_CONFIG": str(slurm / "dask"),
            "PYTHONPATH": str(Path(animat.__file__).parents[1]),
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.returncode == 0, ran.stderr
    assert faults.told_of(slurm / "results" / "small") == faults.told_of(finished)
    first, *others = ran.stderr.splitlines()
    assert first == "animat: no worker is there; waiting for one"
    told = ("Robots that learn: ", "Lives: ")
    assert all(line.startswith(told) for line in others), ran.stderr
    jobs = listed(slurm / "submitted")
    assert len(jobs) == 2
    assert sorted(listed(slurm / "cancelled")) == sorted(jobs)
    script = (slurm / "job.sh").read_text()
    assert "#SBATCH --cpus-per-task=2" in script
    assert "--nthreads 2 " in script
    assert " tls://127.0.0.1:" in script
    assert not list(slurm.glob(".animat-*"))


def test_another_job_is_asked_for_where_one_has_ended(slurm, faults):
    def end(task, done, total, note=""):
        jobs = listed(slurm / "submitted")
        if done and len(jobs) == 1:
            os.killpg(jobs[0], signal.SIGKILL)

    plan, said = faults.plan(faults.LARGER), []
    with (
        dask.config.set({"distributed.deploy.lost-worker-timeout": "100ms"}),
        cluster("slurm", plan, said.append) as workers,
    ):
        assert run(plan, slurm / "results", workers, end).complete
    assert said == 2 * ["no worker is there; waiting for one"]
    first, second = listed(slurm / "submitted")
    assert set(listed(slurm / "cancelled")) == {first, second}


def test_jobs_that_are_refused_end_the_run_in_a_line(slurm, small, capfd):
    command(slurm / "bin" / "sbatch", REFUSES)
    with pytest.raises(ClusterError) as error, cluster("slurm", small, silent, 2) as workers:
        run(small, slurm / "results", workers, silent)
    assert str(error.value) == (
        "slurm: no job can be had: sbatch: error: invalid partition: nope; what is finished is"
        " kept, and the same command goes on with it"
    )
    assert capfd.readouterr().err == ""
    assert not list(slurm.glob(".animat-*"))


@pytest.mark.parametrize("name", BATCH_SYSTEMS)
def test_without_its_commands_a_batch_system_is_refused(name, slurm, small, monkeypatch):
    monkeypatch.setenv("PATH", str(slurm))
    wanted = f"--cluster {name}: there is no command [a-z_]+ here"
    with pytest.raises(SettingsError, match=wanted), cluster(name, small, silent):
        pass


@pytest.mark.parametrize(
    ("lacking", "told"), [(["cores"], "cores"), (["cores", "memory"], "memory")]
)
def test_what_the_configuration_lacks_is_told(lacking, told, slurm, small):
    with (
        dask.config.set({f"jobqueue.slurm.{key}": None for key in lacking}),
        pytest.raises(SettingsError) as error,
        cluster("slurm", small, silent),
    ):
        pass
    (line,) = error.value.problems
    assert line.startswith("--cluster slurm: dask-jobqueue is not told how much ")
    assert all(f"jobqueue.slurm.{key}" in line for key in lacking)
    assert str(slurm / "dask" / "jobqueue.yaml") in line


def test_a_blank_in_the_folder_of_certificates(slurm, small, monkeypatch):
    (slurm / "my results").mkdir()
    monkeypatch.chdir(slurm / "my results")
    wanted = "has a blank, .*; set jobqueue.slurm.shared-temp-directory"
    with pytest.raises(SettingsError, match=wanted), cluster("slurm", small, silent):
        pass
    folder = {"jobqueue.slurm.shared-temp-directory": str(slurm)}
    with dask.config.set(folder), cluster("slurm", small, silent):
        (private,) = slurm.glob(".animat-*")
        assert private.stat().st_mode & 0o777 == 0o700
    assert not private.exists()


def test_jobs_have_the_certificates_of_the_configuration(slurm):
    made = Security.temporary()
    paths = {"cert": slurm / "cert.pem", "key": slurm / "key.pem", "ca": slurm / "ca.pem"}
    paths["ca"].write_text(str(made.tls_ca_file))
    paths["cert"].write_text(str(made.tls_worker_cert))
    paths["key"].write_text(str(made.tls_worker_key))
    tls = {"ca-file": str(paths["ca"])}
    for role in ("scheduler", "worker", "client"):
        tls |= {f"{role}.cert": str(paths["cert"]), f"{role}.key": str(paths["key"])}
    with (
        dask.config.set({f"distributed.comm.tls.{key}": path for key, path in tls.items()}),
        batch("slurm", BATCH_SYSTEMS["slurm"], 1) as queue,
    ):
        script = queue.cluster.job_script()
    for key, option in {"ca": "ca-file", "cert": "cert", "key": "key"}.items():
        assert f"--tls-{option} {paths[key]}" in script
    assert not list(slurm.glob(".animat-*"))


def test_ctrl_c_is_left_alone(slurm, monkeypatch):
    """dask-jobqueue takes it when it is imported for the first time."""
    for name in [name for name in sys.modules if name.startswith("dask_jobqueue")]:
        monkeypatch.delitem(sys.modules, name)
    before = signal.getsignal(signal.SIGINT)
    with batch("slurm", BATCH_SYSTEMS["slurm"], 1):
        assert signal.getsignal(signal.SIGINT) is before
    assert "dask_jobqueue.runner" in sys.modules

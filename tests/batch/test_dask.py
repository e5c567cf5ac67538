"""The same tasks on a Dask cluster: a scheduler and workers as processes of their own."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import time

import pytest
from batch_runs import (
    SECONDS,
    children,
    command,
    compared,
    environment,
    outputs,
    run,
    slowed,
    started,
    statuses,
    torus_obj,
)
from repository import ROOT

pytest.importorskip("distributed")


def free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


class Cluster:
    """A scheduler at a port, and workers of one thread each. options : of both, such as their certificates"""

    def __init__(self, folder, marks=None, protocol="tcp", options=()):
        self._folder, self._environment, self._port, self._processes = folder, environment(marks), free_port(), []
        self.address, self._options = f"{protocol}://127.0.0.1:{self._port}", options

    def start(self, workers):
        options = ["--host", "127.0.0.1", "--port", str(self._port), "--no-dashboard"]
        self.scheduler = self._start(
            "dask_scheduler", *options, "--scheduler-file", str(self._folder / "scheduler.json")
        )
        self.workers = [
            self._start("dask_worker", self.address, "--nthreads", "1", "--no-dashboard") for _ in range(workers)
        ]

    def _start(self, program, *arguments):
        process = subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.{program}", *arguments, *self._options],
            cwd=self._folder,
            env=self._environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        self._processes.append(process)
        return process

    def kill(self, *processes):
        """With the processes that a nanny started."""
        for process in processes:
            for child in children(process.pid):
                os.kill(child, signal.SIGKILL)
            process.kill()
            process.wait()

    def stop(self):
        self.kill(*(process for process in self._processes if process.poll() is None))


@pytest.fixture
def cluster(tmp_path):
    made = Cluster(tmp_path, tmp_path)
    yield made
    made.stop()


def test_same_bits_as_here(cluster, meshes, undisturbed, recipe, tmp_path):
    """By a scheduler file; and what fails costs its asset."""
    cluster.start(2)
    end = time.monotonic() + SECONDS
    while not (tmp_path / "scheduler.json").exists():
        assert time.monotonic() < end
        time.sleep(0.1)
    arguments = ("--recipe", recipe, "--dask", tmp_path / "scheduler.json", "--time", 6)
    result = run(meshes, "--out", tmp_path / "out", *arguments)
    assert result.returncode == 0, result.stderr
    assert outputs(tmp_path / "out") == undisturbed
    bad = [torus_obj(tmp_path / f"{kind}.obj") for kind in ("abort", "hang", "good")]
    result = run(*bad, "--out", tmp_path / "bad", *arguments)
    assert result.returncode == 1, result.stderr
    assert statuses(tmp_path / "bad") == {"abort.obj": "crashed", "hang.obj": "time", "good.obj": "done"}


def test_a_worker_is_lost(cluster, meshes, undisturbed, recipe, tmp_path):
    cluster.start(2)
    source, out = slowed(meshes, tmp_path / "source"), tmp_path / "out"
    process = subprocess.Popen(command(source, "--out", out, "--recipe", recipe, "--dask", cluster.address))
    started(process, out)
    cluster.kill(cluster.workers[0])
    assert process.wait(SECONDS) == 0
    assert compared(outputs(out)) == compared(undisturbed)


def test_the_scheduler_is_killed_and_restarted(cluster, meshes, undisturbed, recipe, tmp_path):
    cluster.start(1)
    source, out = slowed(meshes, tmp_path / "source"), tmp_path / "out"
    process = subprocess.Popen(command(source, "--out", out, "--recipe", recipe, "--dask", cluster.address))
    started(process, out)
    cluster.kill(cluster.scheduler, *cluster.workers)
    cluster.start(1)
    assert process.wait(SECONDS) == 0
    assert compared(outputs(out)) == compared(undisturbed)


def test_interrupted(cluster, recipe, tmp_path):
    """What hangs on a worker ends with the run: the worker does the next one, within the limits of that."""
    cluster.start(1)
    torus_obj(tmp_path / "hang.obj")
    arguments = (tmp_path / "hang.obj", "--out", tmp_path / "out", "--recipe", recipe, "--dask", cluster.address)
    process, end = subprocess.Popen(command(*arguments)), time.monotonic() + SECONDS
    while not [work for worker in children(cluster.workers[0].pid) for work in children(worker)]:
        assert time.monotonic() < end
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    assert process.wait(SECONDS) == 130
    assert run(*arguments, "--time", 1).returncode == 1
    assert statuses(tmp_path / "out") == {"hang.obj": "time"}


def test_no_scheduler(meshes, tmp_path):
    result = run(meshes, "--out", tmp_path / "out", "--dask", "tcp://127.0.0.1:1")
    assert result.returncode == 2
    assert result.stderr.splitlines()[-1].startswith("holomorph: --dask: no scheduler answers at tcp://127.0.0.1:1")
    assert not (tmp_path / "out").exists()


@pytest.fixture
def secured(tmp_path):
    """A cluster that only those reach who have a certificate, made as the documentation says."""
    page = (ROOT / "docs" / "batch" / "cluster.md").read_text(encoding="utf-8")
    for line in page.splitlines():
        if line.startswith("openssl "):
            subprocess.run(line.split(), cwd=tmp_path, check=True, capture_output=True)
    options = ["--tls-ca-file", "ca.pem", "--tls-cert", "cert.pem", "--tls-key", "key.pem"]
    made = Cluster(tmp_path, protocol="tls", options=options)
    made.start(1)
    yield made
    made.stop()


@pytest.mark.skipif(shutil.which("openssl") is None, reason="no openssl")
def test_tls(secured, meshes, undisturbed, recipe, tmp_path):
    """With the certificate, by the variables that the documentation names, it works; without it does not."""
    arguments = ("--out", tmp_path / "out", "--recipe", recipe, "--dask", secured.address)
    refused = run(meshes, *arguments)
    assert refused.returncode == 2 and "no scheduler answers" in refused.stderr.splitlines()[-1]
    names = {"CA_FILE": "ca.pem", "CLIENT__CERT": "cert.pem", "CLIENT__KEY": "key.pem"}
    found = {f"DASK_DISTRIBUTED__COMM__TLS__{name}": str(tmp_path / file) for name, file in names.items()}
    done = subprocess.run(command(meshes, *arguments), env=os.environ | found, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert outputs(tmp_path / "out") == undisturbed

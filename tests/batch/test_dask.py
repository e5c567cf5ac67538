"""The same tasks on a Dask cluster: a scheduler and workers as processes of their own."""

import os
import signal
import socket
import subprocess
import sys
import time

import pytest
from conftest import (
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

pytest.importorskip("distributed")


def free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


class Cluster:
    """A scheduler at a port, and workers of one thread each."""

    def __init__(self, folder, marks=None):
        self._folder, self._environment, self._port, self._processes = folder, environment(marks), free_port(), []
        self.address = f"tcp://127.0.0.1:{self._port}"

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
            [sys.executable, "-m", f"distributed.cli.{program}", *arguments],
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


def test_no_scheduler(meshes, tmp_path):
    result = run(meshes, "--out", tmp_path / "out", "--dask", "tcp://127.0.0.1:1")
    assert result.returncode == 2
    assert result.stderr.splitlines()[-1].startswith("holomorph: --dask: no scheduler answers at tcp://127.0.0.1:1")
    assert not (tmp_path / "out").exists()

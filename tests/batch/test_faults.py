"""Whatever happens to an asset, a worker or the run: every asset is done once or reported, nothing is half-written, and
what comes out is, bit for bit, what comes out where nothing happens."""

import os
import random
import resource
import signal
import subprocess
import time
from pathlib import Path

import pytest
from batch_runs import (
    SECONDS,
    command,
    compared,
    environment,
    library,
    outputs,
    run,
    slowed,
    started,
    statuses,
    torus_obj,
)

INTERRUPTIONS = 10
LIMIT_FILE = 8_000  # bytes, less than a mesh file of the library has


@pytest.fixture
def faulty(tmp_path):
    """Good meshes, and room for bad ones."""
    return library(tmp_path / "faulty", 4)


def test_each_fault_costs_one_asset(faulty, recipe, tmp_path):
    for kind in ("abort", "hang", "bomb", "lost"):
        torus_obj(faulty / f"{kind}_1.obj")
    (faulty / "broken_1.obj").write_text("v 0 0 0\nf 1 2 3\n")
    arguments = (faulty, "--out", tmp_path / "out", "--recipe", recipe, "--workers", 2, "--time", 8, "--memory", "600M")
    marks = tmp_path / "marks"
    marks.mkdir()
    result = run(*arguments, marks=marks)
    assert result.returncode == 1, result.stderr
    found = statuses(tmp_path / "out")
    assert {name: status for name, status in found.items() if status != "done"} == {
        "abort_1.obj": "crashed",
        "bomb_1.obj": "memory",
        "broken_1.obj": "refused",
        "hang_1.obj": "time",
    }
    assert len(found) == 9
    assert "abort_1.obj: crashed: its process was ended by SIGABRT" in result.stderr
    assert "hang_1.obj: time: not done after 8 s" in result.stderr
    assert "more than 600 MB, the memory limit, are needed" in result.stderr
    again = run(*arguments)  # a failure is a result: without --retry nothing is done, and nothing is planted any more
    assert again.returncode == 1
    assert statuses(tmp_path / "out") == found
    assert run(*arguments, "--retry").returncode == 1  # for the broken one
    assert {name for name, status in statuses(tmp_path / "out").items() if status != "done"} == {"broken_1.obj"}


def test_a_mesh_beyond_the_memory_limit(recipe, tmp_path):
    """Nothing planted: the library itself runs out of memory, with one sentence."""
    large, small = torus_obj(tmp_path / "large.obj", 1000, 150), torus_obj(tmp_path / "small.obj")
    result = run(large, small, "--out", tmp_path / "out", "--recipe", recipe, "--workers", 1, "--memory", "90M")
    assert statuses(tmp_path / "out") == {"large.obj": "memory", "small.obj": "done"}, result.stderr


def full_file_limit():
    resource.setrlimit(resource.RLIMIT_FSIZE, (LIMIT_FILE, LIMIT_FILE))


def test_no_space_stops_the_run_and_the_same_command_goes_on(meshes, undisturbed, recipe, tmp_path):
    arguments = (meshes, "--out", tmp_path / "out", "--recipe", recipe, "--workers", 2)
    result = run(*arguments, preexec_fn=full_file_limit)
    assert result.returncode == 4
    assert len(result.stderr.splitlines()) == 1 and "the same command continues" in result.stderr
    assert outputs(tmp_path / "out").items() <= undisturbed.items()
    assert run(*arguments).returncode == 0
    assert outputs(tmp_path / "out") == undisturbed


@pytest.fixture
def small_disk(tmp_path):
    """A file system of its own with little space."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=120k", "tmpfs", str(disk)], capture_output=True)
    if mounted.returncode:
        pytest.skip("file systems cannot be mounted here")
    yield disk
    subprocess.run(["umount", str(disk)], check=True)


def test_full_disk(meshes, undisturbed, recipe, small_disk):
    arguments = (meshes, "--out", small_disk / "out", "--recipe", recipe, "--workers", 2)
    assert run(*arguments).returncode == 4
    kept = outputs(small_disk / "out")
    assert 0 < len(kept) < len(undisturbed) and kept.items() <= undisturbed.items()
    subprocess.run(["mount", "-o", "remount,size=20m", str(small_disk)], check=True)
    assert run(*arguments).returncode == 0
    assert outputs(small_disk / "out") == undisturbed


def test_workers_killed_in_the_middle(meshes, undisturbed, recipe, tmp_path):
    source, out = slowed(meshes, tmp_path / "source"), tmp_path / "out"
    process = subprocess.Popen(
        command(source, "--out", out, "--recipe", recipe, "--workers", 2), env=environment(tmp_path)
    )
    for worker in started(process, out):
        os.kill(worker, signal.SIGKILL)
    assert process.wait(SECONDS) == 0
    assert compared(outputs(out)) == compared(undisturbed)


def test_the_run_itself_killed(meshes, undisturbed, recipe, tmp_path):
    """Its workers end with it, and the same command goes on."""
    source, out = slowed(meshes, tmp_path / "source"), tmp_path / "out"
    arguments = (source, "--out", out, "--recipe", recipe, "--workers", 2)
    process = subprocess.Popen(command(*arguments), env=environment(tmp_path))
    workers = started(process, out)
    process.kill()
    process.wait()
    end = time.monotonic() + SECONDS
    while any(is_running(worker) for worker in workers):
        assert time.monotonic() < end, "workers go on without the run"
        time.sleep(0.02)
    assert run(*arguments, marks=tmp_path).returncode == 0
    assert compared(outputs(out)) == compared(undisturbed)


def is_running(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def test_interrupted_ten_times_and_resumed(meshes, undisturbed, recipe, tmp_path):
    source, out = slowed(meshes, tmp_path / "source"), tmp_path / "out"
    arguments = (source, "--out", out, "--recipe", recipe, "--workers", 2)
    begin = time.monotonic()
    assert run("--help").returncode == 0
    start = time.monotonic() - begin  # seconds that Python takes on this machine, as busy as it is
    chance, interrupted = random.Random(22), 0
    for _ in range(INTERRUPTIONS):
        process = subprocess.Popen(command(*arguments), env=environment(tmp_path), stderr=subprocess.PIPE, text=True)
        time.sleep(start * chance.uniform(0.7, 2.5))
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=SECONDS)
        # Python itself ends by the signal where it has not begun yet.
        assert process.returncode in (130, -signal.SIGINT, 1, 0), said
        interrupted += process.returncode == 130
        if (out / ".work").exists():
            assert compared(outputs(out)).items() <= compared(undisturbed).items()
    assert interrupted
    assert run(*arguments, marks=tmp_path).returncode == 0
    assert compared(outputs(out)) == compared(undisturbed)
    assert (out / "summary.csv").read_text().count("\n") == 1 + 8

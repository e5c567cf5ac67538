"""How a batch ends where the system gives it little: by one sentence and a status, and the same command goes on."""

import os
import resource
import subprocess
import sys

import pytest
from batch_runs import SECONDS, command, library, outputs, run, statuses, torus_obj
from repository import SUPPORT

MACHINE = 6


def limited(kind, limit):
    """Sets a limit in the child process."""
    return lambda: resource.setrlimit(kind, (limit, limit))


def finished(out, recipe, meshes, undisturbed):
    """Whether the same command goes on to what is there when nothing is short."""
    done = run(meshes, "--out", out, "--recipe", recipe, "--workers", 2)
    return done.returncode == 0 and outputs(out) == undisturbed


def test_full_standard_output(meshes, undisturbed, recipe, tmp_path):
    """The line is lost, no result is."""
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            command(meshes, "--out", tmp_path / "out", "--recipe", recipe),
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
        )
    assert done.returncode == 4 and "standard output: No space left" in done.stderr
    assert outputs(tmp_path / "out") == undisturbed and (tmp_path / "out" / "index.html").exists()


@pytest.mark.parametrize("numbers", [(1,), (2,), (0, 1, 2)])
def test_closed_files(numbers, meshes, undisturbed, recipe, tmp_path):
    """The processes that work do not take their numbers for the connection to this one."""
    done = subprocess.run(
        command(meshes, "--out", tmp_path / "out", "--recipe", recipe, "--workers", 2),
        preexec_fn=lambda: [os.close(number) for number in numbers],
        timeout=SECONDS,
    )
    assert done.returncode == (4 if 1 in numbers else 0)
    assert outputs(tmp_path / "out") == undisturbed


def test_few_file_numbers(meshes, undisturbed, recipe, tmp_path):
    """Enough for two processes that work, too few for sixteen."""
    arguments = meshes, "--out", tmp_path / "out", "--recipe", recipe, "--workers"
    limit = limited(resource.RLIMIT_NOFILE, 14)
    done = run(*arguments, 16, preexec_fn=limit)
    assert done.returncode == MACHINE, done.stderr
    assert len(done.stderr.splitlines()) == 1 and "Too many open files" in done.stderr
    assert outputs(tmp_path / "out").items() <= undisturbed.items()
    assert run(*arguments, 2, preexec_fn=limit).returncode == 0
    assert outputs(tmp_path / "out") == undisturbed


@pytest.mark.parametrize("number", range(4, 16))
def test_hardly_any_file_number(number, recipe, tmp_path):
    """One sentence at least, whatever it is that fails first; never a traceback, and no asset is said to be broken."""
    source = library(tmp_path / "source", 2)
    limit = limited(resource.RLIMIT_NOFILE, number)
    done = run(source, "--out", tmp_path / "out", "--recipe", recipe, "--workers", 1, preexec_fn=limit)
    if done.returncode not in (0, 1):
        assert done.returncode in (2, 4, MACHINE), done.stderr
        assert done.stderr.splitlines()[-1].startswith("holomorph: ") and "Traceback" not in done.stderr
    assert run(source, "--out", tmp_path / "out", "--recipe", recipe, "--retry").returncode == 0


@pytest.mark.parametrize("megabytes", [100, 330, 500, 1200])
def test_little_memory(megabytes, meshes, undisturbed, recipe, tmp_path):
    """No process that works waits for memory: each asset is done, or lacks memory, or the run says so."""
    out = tmp_path / "out"
    done = run(
        *(meshes, "--out", out, "--recipe", recipe, "--workers", 1),
        preexec_fn=limited(resource.RLIMIT_AS, megabytes << 20),
    )
    assert "Traceback" not in done.stderr
    if megabytes < 320:
        assert done.returncode == 1 and not out.exists() and "ulimit -v" in done.stderr
    elif done.returncode < 2:
        assert set(statuses(out).values()) <= {"done", "memory"}
        assert len(statuses(out)) == 8
    else:
        assert done.returncode == MACHINE
    assert run(meshes, "--out", out, "--recipe", recipe, "--retry").returncode == 0
    assert outputs(out) == undisturbed


INTERRUPTING = SUPPORT / "interrupting"
MOMENTS = ["holomorph.batch.command", "holomorph.batch.overview", "cpython._PySys_ClearAuditHooks"]


@pytest.mark.parametrize("when", MOMENTS)
def test_interrupted_at_the_start_and_the_end(when, meshes, undisturbed, recipe, tmp_path):
    paths = os.pathsep.join([str(INTERRUPTING), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        command(meshes, "--out", tmp_path / "out", "--recipe", recipe, "--workers", 2),
        env=os.environ | {"HOLOMORPH_TEST_INTERRUPT": when, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
        timeout=SECONDS,
    )
    is_done = when == MOMENTS[-1]
    assert done.returncode == (0 if is_done else 130), done.stderr
    assert len(done.stderr.splitlines()) == (0 if is_done else 1)
    assert (tmp_path / "out").exists() == is_done


def test_a_source_that_is_gone_when_its_turn_comes(recipe, tmp_path):
    """It costs itself alone. Planted: another task takes it away."""
    source = tmp_path / "source"
    source.mkdir()
    for name in ("a", "b"):
        torus_obj(source / f"{name}.obj")
    program = (
        "import os, sys; from holomorph.batch import command\n"
        "tasks = command.Plan.tasks\n"
        f"command.Plan.tasks = lambda plan: os.path.exists({str(source / 'b.obj')!r}) and "
        f"os.unlink({str(source / 'b.obj')!r}) or tasks(plan)\n"
        "sys.exit(command.main(sys.argv[1:]))"
    )
    arguments = [source, "--out", tmp_path / "out", "--recipe", recipe]
    done = subprocess.run([sys.executable, "-c", program, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 1, done.stderr
    assert statuses(tmp_path / "out") == {"a.obj": "done", "b.obj": "refused"}

"""Faults: requests for memory and threads that are refused, interrupts at any time, cancelling at any call, processes.

Each run ends in a result or an error, and the next one has the right bits. Child processes make the faults.
"""

import os
import subprocess
import sys
from pathlib import Path

import families
import holomorph
import pytest
from computed_bits import TINY, TORUS, bits_of_levels, bits_of_structure, bits_of_tiling
from holomorph import Cancelled
from repository import SUPPORT

LIBRARY = os.environ.get("HOLOMORPH_FAILING_REQUESTS")  # made by tests/native, named by scripts/test
linux = pytest.mark.skipif(sys.platform != "linux", reason="signals, processes and the loader of Linux")
needs_library = pytest.mark.skipif(not LIBRARY, reason="no library that lets requests fail")


# ---- requests that are refused ---------------------------------------------------------------------------------------

REFUSED = """
import ctypes, os, sys
import holomorph
from computed_bits import TINY

library = ctypes.CDLL(os.environ["HOLOMORPH_FAILING_REQUESTS"])
compute, mesh, options = TINY[sys.argv[1]]
options = {"folder": sys.argv[2]} if sys.argv[1] == "file" else options
expected, refusals, granted, done = compute(mesh, options), 0, 0, False
while not done:
    library.fail_memory_after(granted)
    try:
        result = compute(mesh, options)
    except (holomorph.Error, MemoryError):
        refusals, result = refusals + 1, expected
    done = library.memory_requests_left() >= 0
    library.fail_memory_after(-1)
    assert result == expected, f"after {granted} requests"
    assert compute(mesh, options) == expected, f"after the failure of request {granted}"
    granted += 1 + granted // 12
print(refusals, granted)
"""


def ended(arguments, **variables):
    """The words that a process of its own prints."""
    packages = os.pathsep.join([str(Path(holomorph.__file__).parents[1]), str(SUPPORT)])
    command = [sys.executable, *map(str, arguments)]
    environment = os.environ | {"PYTHONPATH": packages} | variables
    child = subprocess.run(command, capture_output=True, text=True, timeout=600, env=environment)
    assert child.returncode == 0, f"{child.returncode}: {child.stderr[-3000:]}"
    return child.stdout.split()


def run_child(program, *arguments, **variables):
    return ended(["-c", program, *arguments], **variables)


@linux
@needs_library
@pytest.mark.parametrize("name", TINY)
def test_a_request_for_memory_fails(name, tmp_path):
    """The first, the second, and so on up to the last: those of Python and NumPy too."""
    refusals, granted = map(int, run_child(REFUSED, name, tmp_path, LD_PRELOAD=LIBRARY))
    assert refusals > 20 and granted > 100


NO_THREADS = """
import ctypes, os
from computed_bits import TORUS, bits_of_structure

library = ctypes.CDLL(os.environ["HOLOMORPH_FAILING_REQUESTS"])
expected = bits_of_structure(TORUS, {"threads": 1})
for granted in range(8):
    library.fail_thread_after(granted)
    assert bits_of_structure(TORUS, {"threads": 4}) == expected
    library.fail_thread_after(-1)
    assert bits_of_structure(TORUS, {"threads": 4}) == expected
print("done")
"""


@linux
@needs_library
def test_a_thread_that_cannot_be_started():
    """Those that there are do the work."""
    assert run_child(NO_THREADS, LD_PRELOAD=LIBRARY) == ["done"]


# ---- interrupts ------------------------------------------------------------------------------------------------------

INTERRUPTED = """
import random, signal, sys, time
from computed_bits import TORUS, bits_of_structure

options = {"threads": 2, "solver": sys.argv[1]}
expected, start = bits_of_structure(TORUS, options), time.monotonic()
bits_of_structure(TORUS, options)
once, chance, interrupts = time.monotonic() - start, random.Random(7), 0
signal.signal(signal.SIGALRM, signal.default_int_handler)
for _ in range(20):
    try:
        signal.setitimer(signal.ITIMER_REAL, chance.uniform(1e-4, once))
        bits_of_structure(TORUS, options)
        signal.setitimer(signal.ITIMER_REAL, 0)
    except KeyboardInterrupt:
        interrupts += 1
    assert bits_of_structure(TORUS, options) == expected
print(interrupts)
"""


@linux
@pytest.mark.parametrize("solver", ["direct", "multigrid", "paper"])
def test_an_interrupt_at_any_time(solver):
    (interrupts,) = map(int, run_child(INTERRUPTED, solver))
    assert interrupts >= 5


# ---- cancelling ------------------------------------------------------------------------------------------------------

MEDIUM = {
    "closed": (bits_of_structure, TORUS, {"solver": "multigrid", "threads": 2}),
    "paper": (bits_of_structure, TORUS, {"solver": "paper", "threads": 2}),
    "bounded": (bits_of_structure, families.punched(TORUS, 2), {"threads": 2}),
    "tiling": (bits_of_tiling, families.torus(30, 20, shape="triangles", jitter=0.2), {"threads": 2}),
    "levels": (bits_of_levels, TORUS, {}),
}


@pytest.mark.parametrize("name", MEDIUM)
def test_cancelling_at_every_call(name):
    """How many calls there are depends on the time that passes between them."""
    compute, mesh, options = MEDIUM[name]
    expected, last = compute(mesh, options), False
    for call in range(1, 200):
        calls = []

        def stop(fraction, stage, calls=calls, call=call):
            calls.append(stage)
            return len(calls) < call

        try:
            assert compute(mesh, options, stop) == expected
            last = True
        except Cancelled:
            assert len(calls) == call
        if last:
            break
    assert last and call > 1
    assert compute(mesh, options) == expected


# ---- processes and interpreters --------------------------------------------------------------------------------------

POOLED = """
import multiprocessing, sys
from computed_bits import TORUS, bits_of_structure


def compute(solver):
    return bits_of_structure(TORUS, {"solver": solver, "threads": 2})


if __name__ == "__main__":
    solvers = ["direct", "multigrid", "direct", "multigrid"]
    expected = [compute(solver) for solver in solvers]
    with multiprocessing.get_context(sys.argv[1]).Pool(2) as pool:
        assert pool.map_async(compute, solvers).get(timeout=300) == expected
    assert [compute(solver) for solver in solvers] == expected
    print("done")
"""


@linux
@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
def test_processes_of_a_pool(method, tmp_path):
    """After their parent has had threads of its own."""
    program = tmp_path / "pooled.py"  # a child that is not forked loads it again
    program.write_text(POOLED)
    assert ended([program, method]) == ["done"]


SECOND = """
import _xxsubinterpreters as interpreters
import sys
import holomorph

second = interpreters.create()
attempt = f'''
import sys
sys.path[:0] = {sys.path!r}
try:
    import holomorph
    print("loaded")
except ImportError:
    print("refused")
'''
interpreters.run_string(second, attempt)
interpreters.destroy(second)
holomorph.Surface([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
print("done", flush=True)
"""


@pytest.mark.skipif(sys.version_info[:2] != (3, 11), reason="the module's name changes with every Python")
def test_a_second_interpreter_in_the_process():
    """NumPy refuses it, or both work."""
    assert run_child(SECOND)[-1] == "done"

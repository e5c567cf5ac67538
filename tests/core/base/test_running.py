"""How a computation runs: bits, threads, progress, cancelling, refusals, and the command."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import families
import holomorph
import numpy as np
import pytest
from command_runs import run
from computed_bits import assert_same_bits
from holomorph import Cancelled, Error, Surface, TopologyError, conformal_structure
from mesh_files import obj, write_obj
from repository import ROOT, SUPPORT
from solved import CLOSED, solved, surface_of

# ---- same input, same bits ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("threads", [1, 2, 4])
@pytest.mark.parametrize("name", CLOSED)
def test_bits_do_not_depend_on_the_threads(name, threads):
    assert_same_bits(solved(name), conformal_structure(surface_of(CLOSED[name]), threads=threads))


def test_bits_of_a_larger_mesh():
    """Large enough for every parallel loop to be cut into pieces."""
    mesh = families.torus(440, 220, shape="triangles", jitter=0.3)
    default = conformal_structure(surface_of(mesh))
    for threads in (1, 2, 3):
        assert_same_bits(default, conformal_structure(surface_of(mesh), threads=threads))


ANOTHER_PROCESS = """
import hashlib, json, sys
sys.path[:0] = json.loads(sys.argv[1])
from solved import solved
from computed_bits import all_arrays
arrays = all_arrays(solved("genus 3 block"))
print(hashlib.sha256(b"".join(array.tobytes() for array in arrays)).hexdigest())
"""


def test_bits_of_another_process():
    """Nothing depends on addresses, hash seeds or the time."""
    command = [sys.executable, "-c", ANOTHER_PROCESS, json.dumps([path for path in sys.path if path])]
    runs = {subprocess.run(command, capture_output=True, text=True, timeout=120).stdout for _ in range(2)}
    assert len(runs) == 1
    assert len(runs.pop().strip()) == 64


# ---- memory -------------------------------------------------------------------------------------------------------


def output_of(program):
    """The lines that a process of its own prints."""
    paths = {"PYTHONPATH": os.pathsep.join([str(Path(holomorph.__file__).parents[1]), str(SUPPORT)])}
    command = [sys.executable, "-c", program]
    run = subprocess.run(command, capture_output=True, text=True, timeout=120, env=os.environ | paths)
    assert run.returncode == 0, run.stderr
    return run.stdout.splitlines()


@pytest.mark.skipif(sys.platform != "linux", reason="asks Linux for the memory in use, and glibc to keep none")
def test_memory_goes_back_to_the_system():
    """Pages are kept for the next array only while a computation lasts."""
    program = """
import ctypes
import gc
import families
import holomorph


def megabytes(key):
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith(key))


def compute(n):
    mesh = families.torus(n, 300, shape="triangles")
    surface = holomorph.Surface(mesh.vertices, mesh.corners.reshape(-1, 3))
    return holomorph.conformal_structure(surface, solver="multigrid").solver.residual


compute(10)
gc.collect()
before = megabytes("VmRSS:")
compute(800)
gc.collect()
ctypes.CDLL("libc.so.6").malloc_trim(0)
print(before, megabytes("VmRSS:"), megabytes("VmHWM:"))
"""
    before, after, peak = map(float, output_of(program)[0].split())
    assert peak > before + 150  # megabytes of arrays that were large
    assert after < before + 0.2 * (peak - before)


@pytest.mark.skipif(sys.platform != "linux", reason="asks Linux for the memory in use, and glibc to keep none")
def test_a_result_keeps_functions_classes_and_sheets_alone():
    """Half-edges, 42 bytes per triangle, are made again when needed."""
    program = """
import ctypes
import gc
import families
import holomorph


def megabytes():
    gc.collect()
    ctypes.CDLL("libc.so.6").malloc_trim(0)
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith("VmRSS:"))


def surface(n):
    mesh = families.torus(n, 300, shape="triangles")
    return holomorph.Surface(mesh.vertices, mesh.corners.reshape(-1, 3))


holomorph.conformal_structure(surface(200), solver="multigrid")
large = surface(800)
before = megabytes()
structure = holomorph.conformal_structure(large, solver="multigrid")
print(len(large.triangles), (megabytes() - before) * 2**20)
"""
    triangles, kept = map(float, output_of(program)[0].split())
    # Bytes: 8 of the functions, 12 of the sheets at corners, some of the classes.
    assert 16 * triangles < kept < 36 * triangles


@pytest.mark.skipif(sys.platform != "linux", reason="asks Linux for the most memory in use")
def test_more_threads_take_little_more_memory():
    """Each thread has workspace of its own, small beside the mesh."""
    program = """
import families
import holomorph

mesh = families.torus(800, 300, shape="triangles")
surface = holomorph.Surface(mesh.vertices, mesh.corners.reshape(-1, 3))
holomorph.conformal_structure(surface, solver="multigrid", threads=int(sys.argv[1]))
with open("/proc/self/status") as status:
    print(next(int(line.split()[1]) / 1024 for line in status if line.startswith("VmHWM:")))
"""
    one, two = (float(output_of(f"import sys\nsys.argv.append('{n}')\n{program}")[0]) for n in (1, 2))
    assert two < one + 30  # megabytes


@pytest.mark.skipif(sys.platform != "linux", reason="asks Linux to refuse memory")
def test_too_little_memory_is_an_error():
    """Wherever it runs out, nothing else happens, and the same process computes again as soon as there is enough."""
    program = """
import resource
import families
import holomorph

mesh = families.torus(600, 300, shape="triangles", jitter=0.2)
small = families.torus(24, 18, shape="triangles")
for megabytes in (2, 10, 40, 80, 120, 160, 200, 240):
    with open("/proc/self/statm") as sizes:
        used = int(sizes.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + megabytes * 2**20, resource.RLIM_INFINITY))
    try:
        surface = holomorph.Surface(mesh.vertices, mesh.corners.reshape(-1, 3))
        holomorph.conformal_structure(surface, solver="multigrid")
        print("enough")
    except MemoryError as error:
        assert not isinstance(error, holomorph.Error) or "not enough memory for a mesh of this size" in str(error)
        print("too little")
    resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    surface = holomorph.Surface(small.vertices, small.corners.reshape(-1, 3))
    assert holomorph.conformal_structure(surface, solver="multigrid").residuals.periods < 1e-12
"""
    answers = output_of(program)
    assert len(answers) == 8 and answers[0] == "too little"


# ---- progress and cancelling --------------------------------------------------------------------------------------


def large_torus():
    return surface_of(families.torus(500, 300, shape="triangles", jitter=0.2))


def test_progress_rises_from_0_to_1():
    seen = []
    conformal_structure(large_torus(), progress=lambda fraction, stage: seen.append((fraction, stage)))
    fractions = np.array([fraction for fraction, _ in seen])
    assert len(seen) >= 2
    assert (np.diff(fractions) >= 0).all()
    assert fractions.min() >= 0
    assert fractions.max() <= 1
    assert all(isinstance(stage, str) and stage for _, stage in seen)


@pytest.mark.parametrize("answer", [None, True, 0, 1, ""])
def test_only_false_cancels(answer):
    structure = conformal_structure(large_torus(), progress=lambda fraction, stage: answer)
    assert structure.period_matrix.shape == (1, 1)


@pytest.mark.parametrize("call", [1, 2, 5])
def test_cancelling_at_any_call(call):
    calls = []

    def stop(fraction, stage):
        calls.append(stage)
        return len(calls) < call

    with pytest.raises(Cancelled):
        conformal_structure(large_torus(), progress=stop)
    assert len(calls) == call  # after the answer the function is not called again


@pytest.mark.parametrize("last", ["intrinsic Delaunay", "solver"])
def test_cancelling_while_the_homology_is_computed_in_the_background(last):
    with pytest.raises(Cancelled):
        conformal_structure(large_torus(), threads=2, progress=lambda fraction, stage: stage != last)
    one, two = (conformal_structure(large_torus(), threads=threads) for threads in (1, 2))
    assert one.period_matrix.tobytes() == two.period_matrix.tobytes()
    assert one.uv([1]).tobytes() == two.uv([1]).tobytes()


def test_cancelling_the_forms_for_the_uv_map_leaves_the_structure_usable():
    structure = conformal_structure(large_torus())
    with pytest.raises(Cancelled):
        structure.prepare_uv(progress=lambda fraction, stage: False)
    uv = structure.uv([1])
    assert np.isfinite(uv).all()


def test_cancelling_the_balance_leaves_the_structure_usable():
    surface = surface_of(families.block_with_holes(3, refine=2))
    structure, other = conformal_structure(surface), conformal_structure(surface)
    with pytest.raises(Cancelled):
        structure.balanced_coefficients(progress=lambda fraction, stage: False)
    assert structure.balanced_coefficients().tobytes() == other.balanced_coefficients().tobytes()


def test_error_in_the_progress_function_reaches_the_caller():
    def broken(fraction, stage):
        raise RuntimeError("mine")

    with pytest.raises(RuntimeError, match="mine"):
        conformal_structure(large_torus(), progress=broken)


def test_cancelled_is_an_error_of_the_library():
    assert issubclass(Cancelled, Error)


def test_timings_add_up():
    timings = solved("genus 2 block").timings
    assert all(seconds >= 0 for seconds in timings.values())
    assert timings["total"] >= max(seconds for stage, seconds in timings.items() if stage != "total")


def test_solver_is_reported():
    structure = conformal_structure(surface_of(CLOSED["even torus"]), solver="direct")
    assert structure.solver.name.startswith("direct")
    assert structure.solver.reason
    assert structure.solver.residual < 1e-8


# ---- refusals -----------------------------------------------------------------------------------------------------

REFUSED = {
    "two tori": (families.united(families.torus(5, 4), families.torus(6, 5)), r"2 connected components"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_other_topologies_are_refused_by_name(name):
    mesh, message = REFUSED[name]
    with pytest.raises(TopologyError, match=message) as caught:
        conformal_structure(surface_of(mesh))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "options",
    [{"solver": "fastest"}, {"solver": None}, {"threads": 0}, {"threads": -1}, {"threads": 1.5}, {"threads": "two"}],
)
def test_wrong_options(options):
    with pytest.raises(ValueError, match="solver|threads|invalid literal"):
        conformal_structure(surface_of(CLOSED["even torus"]), **options)


def test_options_have_names():
    with pytest.raises(TypeError):
        conformal_structure(surface_of(CLOSED["even torus"]), "direct")


# ---- the command --------------------------------------------------------------------------------------------------


def test_command_reports_every_component(tmp_path):
    mesh = families.united(families.cube(), families.torus(9, 6), families.punctured_torus())
    path, report = write_obj(tmp_path / "several.obj", mesh), tmp_path / "report.json"
    result = run(path, "--report", report)
    assert (result.returncode, result.stderr) == (0, "")
    parts = json.loads(report.read_text())["components"]
    assert [(part["done"], part["genus"], part["boundary_count"]) for part in parts] == [
        (True, 0, 0),
        (True, 1, 0),
        (True, 1, 1),
    ]
    assert "log map" in parts[0]["description"]
    assert "straight" in parts[2]["description"]
    tau = complex(*parts[1]["period_matrix"][0][0])
    structure = conformal_structure(Surface.read(path).components[1])
    assert tau == structure.period_matrix[0, 0]
    assert all(value < 1e-8 for part in parts[1:] for value in part["residuals"].values())
    assert [part["forms"] for part in parts] == [1, 1, 2]
    assert json.loads(report.read_text())["repairs"]["reversed_faces"] == {"count": 0, "first": []}


def test_command_prints_the_report_where_no_file_is_named(tmp_path):
    result = run(write_obj(tmp_path / "torus.obj", families.torus(9, 6)))
    assert result.returncode == 0
    assert json.loads(result.stdout)["components"][0]["genus"] == 1


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("broken.obj", b"v 0 0 zero\n", "line 1"),
        ("flat.obj", obj(families.moved(families.torus(9, 6), scale=0)), "zero area"),
    ],
)
def test_command_fails_with_one_sentence(name, content, message, tmp_path):
    (tmp_path / name).write_bytes(content)
    result = run(tmp_path / name, "--report", tmp_path / "report.json")
    assert result.returncode == 1
    assert message in result.stderr
    assert len(result.stderr.splitlines()) == 1


def test_command_names_the_solvers_that_there_are(tmp_path):
    result = run(write_obj(tmp_path / "torus.obj", families.torus(9, 6)), "--solver", "guess")
    assert result.returncode == 2
    assert result.stderr == "holomorph: solver is 'guess'; one of auto, direct, multigrid, paper is needed\n"


def test_command_cannot_write_its_report(tmp_path):
    path = write_obj(tmp_path / "torus.obj", families.torus(9, 6))
    result = run(path, "--report", "/dev/full")
    assert result.returncode == 1
    assert len(result.stderr.splitlines()) == 1


# ---- Ctrl-C, and what is not a mesh ----------------------------------------------------------------------------------

INTERRUPTED = """
import json, signal, sys
sys.path[:0] = json.loads(sys.argv[1])
import families
from holomorph import conformal_structure
from solved import surface_of
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs start with it ignored
surface = surface_of(families.scaffold(5))
print("begun", flush=True)
try:
    for _ in range(100):
        structure = conformal_structure(surface)
        structure.uv(structure.balanced_coefficients())
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_is_heard_without_a_progress_function():
    child = subprocess.Popen(
        [sys.executable, "-c", INTERRUPTED, json.dumps(sys.path)], stdout=subprocess.PIPE, text=True
    )
    with child:
        assert child.stdout.readline() == "begun\n"
        time.sleep(0.3)
        child.send_signal(signal.SIGINT)
        start = time.monotonic()
        assert child.stdout.readline() == "interrupted\n"
        assert time.monotonic() - start < 2
        assert child.wait() == 0


def test_false_of_numpy_cancels():
    with pytest.raises(Cancelled):
        conformal_structure(surface_of(families.torus(100, 90)), progress=lambda fraction, stage: np.bool_(False))


@pytest.mark.parametrize(
    "wrong",
    [{"threads": 2**40}, {"threads": "two"}, {"threads": np.nan}, {"threads": 0.5}, {"memory_limit": "much"}],
)
def test_options_that_are_no_numbers_are_refused(wrong):
    (name,) = wrong
    with pytest.raises(ValueError, match=f"{name} is"):
        conformal_structure(surface_of(families.torus(6, 5)), **wrong)


@pytest.mark.parametrize("coefficients", [["a"], [None], None, np.ma.masked_array([1.0], [True])])
def test_coefficients_that_are_no_numbers_are_refused(coefficients):
    with pytest.raises(ValueError, match="coefficients"):
        solved("torus of quads").uv(coefficients)


@pytest.mark.parametrize("wrong", [np.array("a"), np.array(1j), np.ma.masked])
def test_uvs_and_forms_that_are_no_numbers_are_refused(wrong):
    structure = solved("torus of quads")
    entries = np.ma.array(np.zeros(max(len(structure.edges), 2 * len(structure.surface.corner_vertices))), wrong.dtype)
    entries[0] = wrong
    with pytest.raises(ValueError, match="uv"):
        structure.quality(entries[: 2 * len(structure.surface.corner_vertices)].reshape(-1, 2))
    with pytest.raises(ValueError, match="form"):
        structure.averaged_star(entries[: len(structure.edges)])


def test_no_memory_is_an_error_of_ours():
    assert issubclass(holomorph.OutOfMemory, Error) and issubclass(holomorph.OutOfMemory, MemoryError)


@pytest.mark.parametrize("name", ["modulus", "modulus_bounds", "capacity_matrix", "capacity_bounds"])
def test_invariants_that_a_surface_has_not_are_errors(name):
    structure = conformal_structure(surface_of(families.punctured_torus()))
    with pytest.raises(TopologyError, match="the surface has genus 1"):
        getattr(structure, name)


# ---- the package as the add-on finds it ---------------------------------------------------------------------------

ADDON_FINDS = """
import importlib
import sys
import types
sys.modules["addon"] = types.ModuleType("addon")
sys.modules["addon"].__path__ = [{path!r}]  # without what registers in Blender
finder = importlib.import_module("addon.native")
print(finder.problem() or finder.load().conformal_structure.__name__)
"""


@pytest.mark.parametrize("text", [None, "", "from ._native import Error"])
def test_a_folder_of_the_package_s_name_does_not_hide_it(tmp_path, text):
    """Beside the add-on, which has the package's build: a folder, someone else's package, the sources alone."""
    (tmp_path / "holomorph").mkdir()
    if text is not None:
        (tmp_path / "holomorph" / "__init__.py").write_text(text)
    program = ADDON_FINDS.format(path=str(ROOT / "addon"))
    paths = os.pathsep.join([str(tmp_path), str(Path(np.__file__).parents[1])])
    command, environment = [sys.executable, "-c", program], os.environ | {"PYTHONPATH": paths}
    run = subprocess.run(command, capture_output=True, text=True, timeout=120, env=environment, cwd=tmp_path)
    assert run.stdout.strip() == "conformal_structure", run.stdout + run.stderr

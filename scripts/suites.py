"""The suites of scripts/test: what each runs, and what it takes. A new suite is a row of SUITES."""

import os
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / "build"
RESULTS = BUILD / "test"
BLENDER = os.environ.get("HOLOMORPH_BLENDER") or "blender"
# After the quickest, the longest ones first, so that two at a time end together.
DEFAULT = ["lint", "native", "core", "blender-3.4", "window", "bpy-5.2", "batch", "package"]
ALL = ["injection", "lint", "native", "blender-3.4", "core", "package", "batch", "asan", "site", "window", "fuzz"]
ALL += ["tidy", "window-new", "window-sid", "tsan", "bpy-5.2", "bpy-5.0", "bpy-4.5", "bpy-4.2"]
ON_DEMAND = ["mutate", "platforms"]  # they compile for an hour
# The part of tests/core that runs under the sanitizers, several times slower: every kind of surface and every solver
# once, on small meshes; tilings and what is made of them, islands, evening; malformed files; cancelling in the middle;
# several Python threads at once.
SANITIZED = [
    *("base/test_threads.py", "files/test_read.py", "mesh/test_invalid_meshes.py"),
    "progressive/test_progressive.py::test_deterministic",
    "progressive/test_progressive.py::test_arrays_that_do_not_fit_are_refused",
    "progressive/test_progressive.py::test_damaged_splits_are_refused",
    "progressive/test_progressive.py::test_damaged_arrays_are_refused_or_valid",
    *("structure/test_bounded.py::test_certificates", "structure/test_truncated.py"),
    "structure/test_log_map.py::test_solvers_agree_and_threads_do_not_matter",
    "flat/test_rectangle.py::test_solvers_agree_and_threads_do_not_matter",
    "solver/test_laplace.py::test_any_vertices_may_be_fixed",
    "base/test_running.py::test_cancelling_at_any_call",
    "structure/test_levels.py::test_deterministic_at_any_number_of_threads",
    "structure/test_paper_bounded.py::test_agrees_with_the_direct_solver",
    "tiles/test_cells.py::test_tori_of_few_tiles",
    "tiles/test_cells.py::test_whatever_folds_they_fit",
    "tiles/test_cells.py::test_squares_with_a_boundary",
    "tiles/test_lines.py::test_on_a_torus_they_are_as_many_as_rows_and_columns",
    "tiles/test_lines.py::test_whatever_folds_they_close",
    "tiles/test_places.py::test_edges_vertices_and_the_boundary_have_them_once",
    "tiles/test_relief.py::test_crossings_are_those_of_exact_arithmetic",
    "tiles/test_relief.py::test_faces_of_boxes_stay_parallel",
    "tiling/test_placement.py::test_a_polygon_has_one_pole_at_most",
    *("flat/test_chosen_islands.py", "flat/test_free_boundary.py"),
    "flat/test_island_map.py::test_islands_stand_upright_and_apart",
    "uv/test_evened_maps.py::test_no_more_area_is_flipped",
    "uv/test_evened_maps.py::test_what_is_kept_stays_bit_for_bit",
]


# Fresh memory is full of junk in the tests of the native core: what nobody wrote is no zero.
JUNK = 165


class Suite(NamedTuple):
    about: str
    commands: list  # all are run, whatever the first finds
    environment: str = "make_test_venv"  # what makes its Pythons, in the words of scripts/environment
    preset: str = "release"  # what scripts/build compiles for it, if anything
    blender: str = ""  # "wanted", or "needed": it is skipped without the program
    python: str = ""  # the version without which it is skipped
    debian: str = ""  # the Debian whose Blender it takes; as root
    times: int = 1  # the minutes of a suite that it may take


def run_in_environment(command, *arguments):
    """The command line that runs shell commands after scripts/environment; "$@" are the arguments."""
    return ["bash", "-euo", "pipefail", "-c", f". scripts/environment; {command}", "-", *arguments]


def pytest_options(suite, timeout=900):
    result = ["--junit-xml", RESULTS / f"{suite}.xml", "-o", f"junit_suite_name={suite}"]
    return ["-p", "no:cacheprovider", "--timeout", str(timeout), *result]


def pytest(suite, *tests, venv="test-cp311", library="cp311", timeout=900, **variables):
    variables |= {"PYTHONPATH": BUILD / "lib" / library} if library else {}
    python = BUILD / "venv" / venv / "bin" / "python"
    settings = [f"{name}={value}" for name, value in variables.items()]
    return ["env", *settings, python, "-m", "pytest", *pytest_options(suite, timeout), *tests]


def native_tests(preset, suite):
    program = BUILD / "cmake" / f"cp311-{preset}" / "tests" / "native" / "native_tests"
    return [
        "env",
        f"MALLOC_PERTURB_={JUNK}",
        program,
        "--gtest_brief=1",
        f"--gtest_output=xml:{RESULTS / suite}.native.xml",
    ]


def in_blender(suite):
    packages = f"HOLOMORPH_TEST_PYTHONPATH={BUILD / 'venv' / 'debian-pytest'}"
    options = ["-b", "--factory-startup", "--python-exit-code", "9", "--python", "tests/blender/run_pytest.py", "--"]
    return ["env", packages, BLENDER, *options, *pytest_options(suite), "tests/blender"]


def sanitized(suite):
    """Tests in C++, then in Python. CHOLMOD's OpenMP has threads all the same: the preset tsan goes without CHOLMOD."""
    settings = ["env", "OPENBLAS_NUM_THREADS=1", "OMP_NUM_THREADS=1", "UBSAN_OPTIONS=print_stacktrace=1"]
    tests = ["tests/native", *(f"tests/core/{name}" for name in SANITIZED)]
    run = run_in_environment('with_sanitizer "$@"', suite, *pytest(suite, *tests, library=""))
    return [[*settings, *native_tests(suite, suite)], run]


def bpy(version, python):
    name = f"bpy-{version}"
    return Suite(
        f"tests/blender in Blender {version} as a Python module.",
        [pytest(name, "tests/blender", venv=name, library="")],
        environment=f"make_bpy_venv {name}",
        python=python,
    )


def window_in(name, debian, blender, compiled_for="", **options):
    """A Python that this machine has not needs a wheel of its own."""
    commands, variables = [], {"HOLOMORPH_BLENDER": ROOT / "scripts" / "debian-blender", "HOLOMORPH_DEBIAN": debian}
    if compiled_for:
        variables["HOLOMORPH_DIST"] = BUILD / "platforms" / debian
        wheel = 'rm -rf "$2"; scripts/build-wheel linux-x64 "$1" "$2/wheels"'
        make = f'{wheel}; python3 scripts/make-zips.py "$2" "$2/wheels/"*'
        commands = [["bash", "-euc", make, "-", compiled_for, variables["HOLOMORPH_DIST"]]]
    return Suite(
        f"The same in Blender {blender}, of Debian {debian}, with the extension installed from its zip.",
        [*commands, pytest(name, "tests/window", **variables)],
        debian=debian,
        **options,
    )


SUITES = {
    "lint": Suite("Format and lint.", [["scripts/lint"]], environment=":", preset=""),
    "tidy": Suite(
        "scripts/lint --tidy: what clang-tidy finds in the sources, such as an optional that is read unasked.",
        [["scripts/lint", "--tidy"]],
        environment=":",
        preset="",
        times=4,
    ),
    "native": Suite(
        "tests/native: unit tests in C++, with assertions; tests/cpp: examples, built on the installed C++ library.",
        [
            native_tests("dev", "native"),
            pytest("native", "tests/cpp", library="cp311-dev", HOLOMORPH_BUILD=BUILD / "cmake" / "cp311-dev"),
        ],
        preset="dev",
    ),
    "core": Suite(
        "tests/core, with the assertions of the native core, without Blender.",
        [
            pytest(
                *("core", "tests/core", "tests/fuzz"),
                library="cp311-dev",
                HOLOMORPH_FAILING_REQUESTS=BUILD
                / "cmake"
                / "cp311-dev"
                / "tests"
                / "native"
                / "libfailing_requests.so",
                MALLOC_PERTURB_=JUNK,
            )
        ],
        preset="dev",
    ),
    "batch": Suite(
        "tests/batch: holomorph batch here, on a Dask cluster, under faults; its page in Chromium, where there is one.",
        [pytest("batch", "tests/batch", venv="batch-cp311")],
        environment="make_batch_venv",
        blender="wanted",
    ),
    "blender-3.4": Suite(
        "tests/blender in Debian's Blender.",
        [in_blender("blender-3.4")],
        environment="make_blender_folder debian-pytest pytest pytest-timeout",
        blender="needed",
    ),
    "bpy-5.2": bpy("5.2", "3.13"),
    "bpy-5.0": bpy("5.0", "3.11"),
    "bpy-4.5": bpy("4.5", "3.11"),
    "bpy-4.2": bpy("4.2", "3.11"),
    "injection": Suite(
        "tests/injection: an error at every line that an operator runs, in each mode, in Blender 3.4 and 5.2.",
        [pytest("injection", "tests/injection", timeout=3600, library="")],
        environment="make_test_venv; make_blender_folder debian-pytest pytest pytest-timeout; make_bpy_venv bpy-5.2",
        blender="needed",
        python="3.13",
        times=8,
    ),
    "package": Suite(
        "tests/package: the zips and wheels, installed in Blender 3.4, 4.2 and 5.2.",
        [pytest("package", "tests/package", library="")],
        environment="make_test_venv; make_bpy_venv bpy-4.2; ! find_python 3.13 >/dev/null || make_bpy_venv bpy-5.2",
        preset="",  # what they install is made by scripts/release, or by their fixture
        blender="wanted",
    ),
    "window": Suite(
        "tests/window: clicks in a real window, on a display of its own.",
        [pytest("window", "tests/window")],
        blender="needed",
    ),
    "window-new": window_in("window-new", "trixie", "4.3", python="3.13"),
    "window-sid": window_in("window-sid", "sid", "5.2", compiled_for="3.14", times=2),
    "site": Suite(
        "scripts/site, and tests/site: its pages in Chromium, the gallery, the lines for PyVista, a notebook.",
        [["scripts/site"], pytest("site", "tests/site", venv="site-test-cp311")],
        environment="make_site_venv; make_site_test_venv",
        blender="needed",
    ),
    "asan": Suite(
        "Tests of native and some of core, with the sanitizers of addresses and undefined behaviour.",
        sanitized("asan"),
        preset="asan",
    ),
    "tsan": Suite("The same with the sanitizer of threads.", sanitized("tsan"), preset="tsan"),
    "fuzz": Suite(
        "tests/fuzz, then three minutes of mutated files and meshes. scripts/fuzz goes on for longer.",
        [
            run_in_environment('with_sanitizer "$@"', "asan", *pytest("fuzz", "tests/fuzz", library="")),
            ["scripts/fuzz", "--minutes", "3"],
        ],
        preset="asan",
    ),
    "mutate": Suite(
        "scripts/mutate: planted faults, of which each must fail a test. Compiles for most of an hour.",
        [["scripts/mutate"]],
        preset="dev",
        times=4,
    ),
    "platforms": Suite(
        "tests/platforms: the extensions of all platforms, under Wine and qemu. Compiles for an hour.",
        [pytest("platforms", "-rA", "tests/platforms", timeout=7200, library="")],
        environment="make_test_venv; make_bpy_venv bpy-4.2",
        preset="",
        times=4,
    ),
}

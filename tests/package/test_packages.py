"""The wheels and zips of scripts/package-extension: complete, accepted by Blender, working away from the checkout."""

import shutil
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import numpy as np
import pytest
from conftest import extension, run, run_extension_program
from repository import ROOT

HERE = Path(__file__).resolve().parent
# What every Linux with glibc has, the C++ run-time library included: Blender itself needs them.
SYSTEM = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "libgcc_s.so.1", "libstdc++.so.6"}
SYSTEM |= {"ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
PLACE = "holomorph: "


def one(folder, pattern):
    found = sorted(folder.glob(pattern))
    assert len(found) == 1, found
    return found[0]


def place_of_package(output):
    return Path(next(line for line in output.splitlines() if line.startswith(PLACE)).removeprefix(PLACE))


def write_torus(path, n=24, m=12):
    u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
    points = np.stack([(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    a, b = i * m + j, (i + 1) % n * m + j
    quads = np.stack([a, b, (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m], -1).reshape(-1, 4) + 1
    with path.open("w") as file:
        np.savetxt(file, points, fmt="v %.17g %.17g %.17g")
        np.savetxt(file, quads, fmt="f %d %d %d %d")


def dynamic(library):
    return subprocess.run(["readelf", "-dlW", library], capture_output=True, text=True, check=True).stdout


def needed(library):
    """The libraries that a shared library asks for."""
    output = dynamic(library)
    return {line.split("[")[1].rstrip("]") for line in output.splitlines() if "(NEEDED)" in line}


def test_the_wheels_are_self_contained(dist, tmp_path):
    for wheel in dist.glob("*.whl"):
        folder = tmp_path / wheel.name
        zipfile.ZipFile(wheel).extractall(folder)
        libraries = sorted(folder.rglob("*.so*"))
        inside = {library.name for library in libraries}
        for library in libraries:
            assert needed(library) <= inside | SYSTEM, library.name
        # The reference BLAS, and a second copy of OpenBLAS under another name, stay out.
        assert not [name for name in inside if name.startswith(("libblas", "liblapack"))]


def test_modules_are_hardened(dist, tmp_path):
    """All functions are found when the module is loaded, in a table that is read-only then: full RELRO. Overruns of
    arrays on the stack, and of copies of known size, end the program."""
    for wheel in dist.glob("*.whl"):
        zipfile.ZipFile(wheel).extractall(tmp_path / wheel.name)
        (module,) = (tmp_path / wheel.name).rglob("_native*.so")
        assert "GNU_RELRO" in dynamic(module) and "BIND_NOW" in dynamic(module)
        symbols = subprocess.check_output(["readelf", "--dyn-syms", "--wide", module], text=True)
        assert "__stack_chk_fail" in symbols


def test_the_extension_is_valid(dist, bpy_python):
    output = run_extension_program(bpy_python, "validate", extension(dist))
    assert "warning" not in output.lower() and "error" not in output.lower(), output


def test_the_extension_installs_and_works(dist, bpy_python, tmp_path):
    output = run(bpy_python, HERE / "install_extension.py", extension(dist), BLENDER_USER_RESOURCES=tmp_path)
    assert tmp_path in place_of_package(output).parents


def test_the_legacy_zip_installs_and_works(dist, blender, tmp_path):
    script = HERE / "install_legacy.py"
    command = [blender, "-b", "--factory-startup", "--python-exit-code", "9", "--python", script, "--"]
    output = run(*command, one(dist, "*blender-3.4.zip"), BLENDER_USER_SCRIPTS=tmp_path)
    assert tmp_path in place_of_package(output).parents


def test_the_same_sources_give_the_same_extension(dist, tmp_path):
    run(sys.executable, ROOT / "scripts" / "make-zips.py", tmp_path, *sorted(dist.glob("*.whl")))
    assert extension(tmp_path).read_bytes() == extension(dist).read_bytes()


@pytest.fixture
def folder_of_ccache():
    """Settings with which ccache knows what scripts/build compiled: its folders are as deep."""
    folder = ROOT / "build" / "cmake" / "pip"
    shutil.rmtree(folder, ignore_errors=True)
    yield {
        "CXX": "c++",
        "CMAKE_CXX_COMPILER_LAUNCHER": shutil.which("ccache") or "",
        "CMAKE_BUILD_PARALLEL_LEVEL": 2,
        "CCACHE_BASEDIR": ROOT,
        "CCACHE_NOHASHDIR": 1,
        "SKBUILD_BUILD_DIR": folder,
    }
    shutil.rmtree(folder, ignore_errors=True)


@pytest.mark.timeout(1300)  # without ccache it compiles everything
@pytest.mark.parametrize("source", ["wheel", "checkout"])
def test_pip_installs_the_package_without_blender(dist, tmp_path, source, folder_of_ccache):
    venv.create(tmp_path / "venv", with_pip=True)
    python = tmp_path / "venv" / "bin" / "python"
    what = one(dist, "*-cp311-*.whl") if source == "wheel" else ROOT
    install = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", what]
    run(*install, seconds=1200, **folder_of_ccache)
    write_torus(tmp_path / "torus.obj")
    run(python, "-m", "holomorph", tmp_path / "torus.obj", "--report", tmp_path / "report.json")
    assert (tmp_path / "report.json").stat().st_size > 0

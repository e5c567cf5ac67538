"""The wheels, source and zips of scripts/package-extension: complete, accepted by Blender, working away from here."""

import email
import json
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
import tomllib
from conftest import run_extension_program, wheels
from packages import extension, run
from repository import ROOT, VERSION

HERE = Path(__file__).resolve().parent
# What every Linux with glibc has, the C++ run-time library included: Blender itself needs them.
SYSTEM = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "libgcc_s.so.1", "libstdc++.so.6"}
SYSTEM |= {"ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
# A function with an array on its stack reads the word before the frame's end, at fs:0x28: mov, sub, cmp or xor.
CANARY = re.compile(rb"\x64[\x48\x4c][\x8b\x2b\x3b\x33].\x25\x28\0\0\0", re.DOTALL)
PLACE = "holomorph: "
INSTALL = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]


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
    for wheel in wheels(dist):
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
    for wheel in wheels(dist):
        zipfile.ZipFile(wheel).extractall(tmp_path / wheel.name)
        (module,) = (tmp_path / wheel.name).rglob("_native*.so")
        assert "GNU_RELRO" in dynamic(module) and "BIND_NOW" in dynamic(module)
        assert len(CANARY.findall(module.read_bytes())) > 100


def test_extensions_are_valid(dist, bpy_python):
    for path in set(dist.glob("holomorph-*.zip")) - set(dist.glob("*blender-3.4.zip")):
        output = run_extension_program(bpy_python, "validate", path)
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
    run(sys.executable, ROOT / "scripts" / "make-zips.py", tmp_path, *wheels(dist))
    assert extension(tmp_path).read_bytes() == extension(dist).read_bytes()


def new_environment(folder, python):
    """The Python of an environment that has nothing but pip."""
    run(python, "-m", "venv", folder)
    return folder / "bin" / "python"


def check_that_it_works(python, tmp_path):
    """@param python that of an environment with the package"""
    write_torus(tmp_path / "torus.obj")
    run(python, "-m", "holomorph", tmp_path / "torus.obj", "--report", tmp_path / "report.json")
    assert json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))["holomorph"] == VERSION
    run(
        python,
        "-c",
        "import holomorph, pathlib; assert (pathlib.Path(holomorph.__file__).parent / 'py.typed').exists()",
    )


def find_python(version):
    found = run("bash", "-c", f". {ROOT}/scripts/environment; find_python {version} || true").strip()
    return found or pytest.skip(f"no Python {version}")


@pytest.mark.parametrize("version", ["3.11", "3.13"])
def test_pip_installs_the_wheel_without_blender(dist, tmp_path, version):
    tag = f"cp{version.replace('.', '')}"
    wheel = next((wheel for wheel in wheels(dist) if f"-{tag}-" in wheel.name), None) or pytest.skip(f"no wheel {tag}")
    python = new_environment(tmp_path / "venv", find_python(version))
    run(python, *INSTALL, wheel)
    check_that_it_works(python, tmp_path)


@pytest.mark.timeout(1300)  # without ccache it compiles everything
def test_pip_installs_the_source(dist, tmp_path):
    """With what it says it needs. Its folders are a checkout's, for ccache to know what scripts/build has compiled."""
    shutil.unpack_archive(one(dist, "*.tar.gz"), tmp_path)
    source = one(tmp_path, "holomorph-*")
    assert {path.name for path in source.iterdir() if path.is_dir()} == {"native"}
    python = new_environment(source / "build" / "venv" / "build-cp311", find_python("3.11"))
    run(python, *INSTALL, *tomllib.loads((source / "pyproject.toml").read_text())["build-system"]["requires"])
    settings = {
        "CXX": "c++",
        "CMAKE_CXX_COMPILER_LAUNCHER": shutil.which("ccache") or "",
        "CMAKE_BUILD_PARALLEL_LEVEL": 2,
        "CCACHE_BASEDIR": source,
        "CCACHE_NOHASHDIR": 1,
        "SKBUILD_BUILD_DIR": source / "build" / "cmake" / "cp311",
    }
    run(python, *INSTALL, "--no-build-isolation", source, seconds=1200, **settings)
    check_that_it_works(python, tmp_path)


def test_the_page_of_the_package_stands_alone(dist):
    """It has an author, its types, and no address that is none on the page of an index."""
    with zipfile.ZipFile(wheels(dist)[0]) as wheel:
        text = wheel.read(f"holomorph-{VERSION}.dist-info/METADATA").decode()
    about, page = email.message_from_string(text), text.partition("\n\n")[2]
    assert about["Author"] and "Typing :: Typed" in about.get_all("Classifier")
    assert all(address.startswith("https://") for address in re.findall(r"\]\((.*?)\)", page))
    assert len(page) > 500

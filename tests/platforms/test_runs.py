"""The modules of other platforms at work: that of Windows under Wine, that of ARM64 Linux under qemu.

They run a part of tests/core: every kind of surface and of map under Wine, for some minutes; under qemu, thirty times
slower, one file of each kind.
"""

import re
import sys

import numpy as np
import pytest
from conftest import extension, run
from families import block_with_holes, torus
from repository import ROOT

FOREIGN_PYTHON = ROOT / "scripts" / "foreign-python"
MAP_MESHES = ROOT / "tests" / "platforms" / "map_meshes.py"
# The module calls the C library for sines, logarithms and roots of other orders; libraries round them otherwise.
ROUNDING = 1e-11
WITH_BLENDER = ["operator", "tile", "refusals", "faces"]
WITH_QEMU = ["topology", "surface", "exact_values", "uv", "cut", "rectangle", "boundary_values"]
WITH_WINE = [
    *WITH_QEMU,
    *["conformal", "bounded", "log_map", "disk", "laplace", "levels", "zeros", "tiling", "islands", "hard_edges"],
    *["read", "invalid_meshes", "values", "faults", "running", "threads"],
]
# The add-on looks for the package in the build folder of the checkout, which has none for Windows.
WITHOUT_WINE = ["tests/core/base/test_running.py::test_a_folder_of_the_package_s_name_does_not_hide_it"]


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    path = tmp_path_factory.mktemp("meshes") / "meshes.npz"
    arrays = {}
    for name, mesh in {"torus": torus(24, 12), "slab": block_with_holes(2, refine=2, jitter=0.1)}.items():
        arrays[f"{name}.points"] = mesh.vertices
        arrays[f"{name}.faces"] = mesh.corners.reshape(mesh.face_count, -1)
    np.savez(path, **arrays)
    return path


@pytest.fixture(scope="module")
def mapped_here(packages, meshes):
    target = meshes.with_name("linux-x64.npz")
    run(sys.executable, MAP_MESHES, meshes, target, PYTHONPATH=packages("linux-x64", "cp311"))
    return np.load(target)


@pytest.mark.parametrize("platform", ["windows-x64", "linux-arm64"])
def test_maps_are_those_of_linux_up_to_rounding(packages, meshes, mapped_here, platform):
    target = meshes.with_name(f"{platform}.npz")
    run(FOREIGN_PYTHON, platform, MAP_MESHES, meshes, target, PYTHONPATH=packages(platform, "cp311"))
    there = np.load(target)
    assert sorted(there) == sorted(mapped_here)
    equal = [name for name in there if there[name].tobytes() == mapped_here[name].tobytes()]
    print(
        f"{platform}: {len(equal)} of {len(there.files)} arrays have the same bits; the others are",
        *set(there) - set(equal),
    )
    for name in there:
        if there[name].dtype.kind in "iub":
            assert name in equal, f"{name}: whole numbers do not depend on rounding"
        else:
            size = np.abs(mapped_here[name]).max(initial=1)
            np.testing.assert_allclose(there[name], mapped_here[name], rtol=0, atol=ROUNDING * size, err_msg=name)


def passed(output):
    """The number of tests passed, of a run in which none failed."""
    return int(re.search(r"(\d+) passed", output)[1])


def some_of_the_core(platform, names, package, *options):
    """The output of these files of tests/core, in which none may fail."""
    found = [path for name in names for path in ROOT.glob(f"tests/core/*/test_{name}.py")]
    files = [path.relative_to(ROOT).as_posix() for path in found]
    command = [FOREIGN_PYTHON, platform, "-m", "pytest", "-q", "-p", "no:cacheprovider", *options, *files]
    return run(*command, PYTHONPATH=package)


def test_some_of_the_core_under_wine(packages):
    options = [f"--deselect={name}" for name in WITHOUT_WINE]
    output = some_of_the_core("windows-x64", WITH_WINE, packages("windows-x64", "cp311"), *options)
    assert passed(output) > 2000, output


def test_blender_for_windows_installs_the_extension(repository, tmp_path):
    install = ROOT / "tests" / "package" / "install_extension.py"
    command = [FOREIGN_PYTHON, "windows-x64", install, f"Z:{extension(repository, 'windows-x64')}"]
    output = run(*command, BLENDER_USER_RESOURCES=f"Z:{tmp_path}")
    assert f"holomorph: Z:{tmp_path}/" in output.replace("\\", "/"), output


def test_some_of_the_add_on_in_blender_for_windows(packages):
    files = [f"tests/blender/test_{name}.py" for name in WITH_BLENDER]
    command = [FOREIGN_PYTHON, "windows-x64", "-m", "pytest", "-q", "-p", "no:cacheprovider", *files]
    output = run(*command, PYTHONPATH=packages("windows-x64", "cp311"))
    assert passed(output) > 100, output


def test_some_of_the_core_under_qemu(packages):
    output = some_of_the_core("linux-arm64", WITH_QEMU, packages("linux-arm64", "cp311"))
    assert passed(output) > 200, output

"""The modules of other platforms at work: that of Windows under Wine, that of ARM64 Linux under qemu.

The tests of the core that are about the sources, or take a program or library that is not there, stay out. Under Wine
all others run; under qemu, thirty times slower, one file of each kind.
"""

import re
import sys

import numpy as np
import pytest
from conftest import ROOT, run

sys.path.insert(0, str(ROOT / "tests" / "core"))
from families import block_with_holes, torus

FOREIGN_PYTHON = ROOT / "scripts" / "foreign-python"
MAP_MESHES = ROOT / "tests" / "platforms" / "map_meshes.py"
# The module calls the C library for sines, logarithms and roots of other orders; libraries round them otherwise.
ROUNDING = 1e-11
ABOUT_SOURCES = ["architecture", "documentation", "types", "plot"]
WITH_ARB = ["automorphisms", "interval_energies"]  # whose Windows library Wine does not load
WITH_QEMU = ["topology", "surface", "exact_values", "uv", "cut", "rectangle", "boundary_values"]


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


def test_the_core_under_wine(packages):
    left_out = [f"--ignore=tests/core/test_{name}.py" for name in ABOUT_SOURCES + WITH_ARB]
    command = [FOREIGN_PYTHON, "windows-x64", "-m", "pytest", "-q", "-p", "no:cacheprovider", *left_out, "tests/core"]
    output = run(*command, PYTHONPATH=packages("windows-x64", "cp311"))
    assert passed(output) > 2000, output


def test_some_of_the_core_under_qemu(packages):
    files = [f"tests/core/test_{name}.py" for name in WITH_QEMU]
    command = [FOREIGN_PYTHON, "linux-arm64", "-m", "pytest", "-q", "-p", "no:cacheprovider", *files]
    output = run(*command, PYTHONPATH=packages("linux-arm64", "cp311"))
    assert passed(output) > 200, output

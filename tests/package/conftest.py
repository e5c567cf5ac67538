"""The packages are made once; each test installs one of them where nothing of the checkout is found."""

import os
from pathlib import Path

import pytest
from packages import packages, run
from repository import ROOT


def run_extension_program(python, *arguments):
    """Blender's program for extensions, from the Blender that this Python has as a module; what it says."""
    scripts = run(python, "-c", "import bpy; print(bpy.utils.system_resource('SCRIPTS'))").splitlines()[-1]
    return run(python, Path(scripts) / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py", *arguments)


def wheels(dist):
    """Those of this computer."""
    return sorted(dist.glob("*linux*_x86_64.whl"))


@pytest.fixture(scope="session")
def dist(tmp_path_factory):
    """The folder with the packages."""
    return packages(Path(os.environ.get("HOLOMORPH_TEST_OUTPUT") or tmp_path_factory.mktemp("package")) / "dist")


@pytest.fixture(params=["4.2", "5.2"])
def bpy_python(request):
    """The Python of a virtual environment that has Blender as a module."""
    python = ROOT / "build" / "venv" / f"bpy-{request.param}" / "bin" / "python"
    if not python.exists():
        pytest.skip(f"no environment with Blender {request.param}")
    return python


@pytest.fixture
def blender():
    """The Blender program."""
    program = os.environ.get("HOLOMORPH_BLENDER")
    if not program:
        pytest.skip("no Blender program")
    return program

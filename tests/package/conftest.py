"""The packages are made once; each test installs one of them where nothing of the checkout is found."""

import os
import subprocess
from pathlib import Path

import pytest
from repository import ROOT

SECONDS = 600


def run(*command, seconds=SECONDS, **environment):
    """Run a program away from the checkout, with a time limit; its output, or a failure that shows it."""
    clean = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "HOLOMORPH_BLENDER")}
    done = subprocess.run(
        # The program "timeout" ends what the command started, too.
        ["timeout", "--kill-after=10", str(seconds), *map(str, command)],
        env={**clean, **{name: str(value) for name, value in environment.items()}},
        cwd="/",
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )
    assert done.returncode == 0, f"{' '.join(map(str, command))}\nexit code {done.returncode}\n{done.stdout}"
    return done.stdout


def run_extension_program(python, *arguments):
    """Blender's program for extensions, from the Blender that this Python has as a module; what it says."""
    scripts = run(python, "-c", "import bpy; print(bpy.utils.system_resource('SCRIPTS'))").splitlines()[-1]
    return run(python, Path(scripts) / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py", *arguments)


def extension(dist):
    """The extension for this computer."""
    return next(dist.glob("holomorph-*-linux_x64.zip"))


def wheels(dist):
    """Those of this computer."""
    return sorted(dist.glob("*linux*_x86_64.whl"))


@pytest.fixture(scope="session")
def dist(tmp_path_factory):
    """The folder with the wheels, the source and the zips: HOLOMORPH_DIST, of a release, or made here."""
    if os.environ.get("HOLOMORPH_DIST"):
        return Path(os.environ["HOLOMORPH_DIST"])
    folder = Path(os.environ.get("HOLOMORPH_TEST_OUTPUT") or tmp_path_factory.mktemp("package")) / "dist"
    run(ROOT / "scripts" / "package-extension", folder)
    return folder


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

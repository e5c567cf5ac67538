"""A Blender with a window on a display of its own, in which a script takes its steps. The add-on in it is that of the
checkout; in Blender 4.2 and later the extension, installed from its zip by test_install.py's first steps."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
from packages import extension, packages
from repository import ROOT, SUPPORT

BLENDER = os.environ.get("HOLOMORPH_BLENDER") or shutil.which("blender")
MODULE = "bl_ext.user_default.holomorph"  # the extension that is installed
SECONDS = 280


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    wanted = os.environ.get("HOLOMORPH_TEST_OUTPUT")
    path = Path(wanted) if wanted else tmp_path_factory.mktemp("window")
    path.mkdir(parents=True, exist_ok=True)
    return path


@pytest.fixture(scope="session")
def takes_extensions():
    """Whether this Blender does."""
    if not BLENDER or not shutil.which("xvfb-run"):
        pytest.skip("there is no Blender program" if not BLENDER else "there is no xvfb-run")
    first = subprocess.run([BLENDER, "--version"], capture_output=True, text=True, check=True).stdout.split()
    return tuple(map(int, first[1].split("."))) >= (4, 2)


def take(name, folder, *options, **environment):
    """What the steps of the script NAME.py saw, in one run of Blender."""
    screen = "-screen 0 1600x1000x24 +extension GLX"
    command = ["xvfb-run", "-a", "-s", screen, BLENDER, "--factory-startup", "--enable-event-simulate"]
    command += ["--window-geometry", "0", "0", "1600", "1000", *options]
    command += ["--python-expr", f"import sys; sys.path.insert(0, {str(SUPPORT)!r})", "--python"]
    environment = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1", **environment}
    environment.pop("PYTHONPATH", None)
    script, log_file = ROOT / "tests" / "window" / f"{name}.py", folder / f"{name}.log"
    with open(log_file, "w") as log:
        subprocess.run(
            ["timeout", "--kill-after=10", str(SECONDS), *command, str(script), "--", str(folder)],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=subprocess.STDOUT,
            timeout=SECONDS + 30,
            check=False,
        )
    written = folder / f"{name}.json"
    assert written.exists(), log_file.read_text(errors="replace")[-3000:]
    seen = json.loads(written.read_text())
    assert "traceback" not in seen, seen["traceback"]
    return seen


@pytest.fixture(scope="session")
def installed(takes_extensions, folder, tmp_path_factory):
    """(the folder of the user's own files, what the steps of the installation saw)."""
    if not takes_extensions:
        pytest.skip("this Blender has no extensions")
    shutil.copy(extension(packages(folder / "dist")), folder / "holomorph.zip")
    own = tmp_path_factory.mktemp("own")
    return own, take("install_steps", folder, BLENDER_USER_RESOURCES=str(own))


@pytest.fixture(scope="session")
def take_steps(takes_extensions, folder, tmp_path_factory, request):
    """take_steps(name): what the steps of the script NAME.py saw, with the add-on."""
    if takes_extensions:
        own, _ = request.getfixturevalue("installed")
        return lambda name: take(name, folder, "--addons", MODULE, BLENDER_USER_RESOURCES=str(own))
    scripts = tmp_path_factory.mktemp("scripts")
    (scripts / "addons").mkdir()
    (scripts / "addons" / "holomorph_addon").symlink_to(ROOT / "addon")
    return lambda name: take(name, folder, "--addons", "holomorph_addon", BLENDER_USER_SCRIPTS=str(scripts))


@pytest.fixture(scope="module")
def seen(take_steps, request):
    """What the steps of a test saw: those of test_NAME.py are taken by NAME_steps.py."""
    return take_steps(f"{request.module.__name__.removeprefix('test_')}_steps")

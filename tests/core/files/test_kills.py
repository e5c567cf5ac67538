"""Writers that are killed at each step, or find the disk full at each page: what was there stays, or what is new is
whole."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from repository import SUPPORT

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes and file systems of Linux")
WRITERS = ("mesh", "progressive mesh", "levels", "command", "compare")
FOLDER = Path(__file__).parent


def told(*arguments):
    """What the script prints."""
    command = [sys.executable, FOLDER / "killed.py", *arguments]
    paths = {"PYTHONPATH": os.pathsep.join([str(SUPPORT), os.environ.get("PYTHONPATH", "")])}
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, env=os.environ | paths)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("name", WRITERS)
def test_killed_at_each_step(name, tmp_path):
    found = told(name, tmp_path, "killed")
    assert len(found) > 4 and found[0] == [-signal.SIGKILL, "old"] and found[-1] == [0, "new"]
    assert all(ended == -signal.SIGKILL for ended, _ in found[:-1])
    assert {part for _, state in found for part in state.split("/")} == {"old", "new"}


@pytest.fixture
def small_disk(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1M", "tmpfs", str(disk)], capture_output=True)
    if mounted.returncode:
        pytest.skip("file systems cannot be mounted here")
    yield disk
    subprocess.run(["umount", str(disk)], check=True)


@pytest.mark.parametrize("name", WRITERS)
def test_full_at_each_page(name, small_disk):
    found = told(name, small_disk, "full")
    assert len(found) > 1 and found[0] == [1, "old"] and found[-1] == [0, "new"]
    assert all(ended == 1 for ended, _ in found[:-1])
    assert {part for _, state in found for part in state.split("/")} == {"old", "new"}

"""With an error at any line that any operator runs, in any mode, Blender goes on and the file is as before.

Each operator runs in processes of its own, in Blender 3.4 and in the newest: one that ends is a failure that names the
line, and the lines behind it are tried in the next process.
"""

import itertools
import json
import os
import re
import shutil
import subprocess

import pytest
from repository import ROOT

PROGRAM = "tests/injection/every_line.py"
MODES = ("OBJECT", "EDIT", "SCULPT", "WEIGHT_PAINT", "POSE")
LIBRARY = ROOT / "build" / "venv" / "debian-pytest"
NEWEST = ROOT / "build" / "venv" / "bpy-5.2" / "bin" / "python"
BLENDER = os.environ.get("HOLOMORPH_BLENDER") or shutil.which("blender")
VERSIONS = {
    "3.4": [BLENDER, "-b", "--factory-startup", "--python-exit-code", "9", "--python", PROGRAM, "--"],
    "5.2": [NEWEST, PROGRAM, "--"],
}
PRESSES = re.findall(r'^    "([a-z ]+)": Press\(', (ROOT / "tests/support/presses.py").read_text(), re.MULTILINE)
SECONDS = 1200  # of a process


def tried(version, press, mode, notes):
    """What is told of the stops, of those at which Blender ended too."""
    told, crashes = [], []
    for _ in range(20):
        first = sum("stop" in each for each in told)
        command = [*VERSIONS[version], notes, press, mode, str(first)]
        environment = os.environ | {"HOLOMORPH_TEST_PYTHONPATH": str(LIBRARY)}
        process = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=SECONDS)
        told = [json.loads(line) for line in notes.read_text().splitlines()] if notes.exists() else []
        if process.returncode == 0:
            break
        assert told and "stop" in told[-1], process.stdout[-3000:] + process.stderr[-3000:]
        crashes.append({**told[-1], "exit code": process.returncode})
    return told, crashes


@pytest.fixture(scope="module")
def figures():
    """Counts that are told in the end."""
    counts = {name: dict.fromkeys(("refused", "operators", "lines", "stops"), 0) for name in VERSIONS}
    yield counts
    print("\n", json.dumps(counts))


@pytest.mark.parametrize(("version", "mode", "press"), [*itertools.product(VERSIONS, MODES, PRESSES)])
def test_every_line(version, mode, press, tmp_path, figures):
    told, crashes = tried(version, press, mode, tmp_path / "notes")
    assert not crashes
    assert [[told[at - 1], each] for at, each in enumerate(told) if each.get("left")] == []
    counts = figures[version]
    counts["refused" if "refused" in told[0] else "operators"] += 1
    if "refused" not in told[0]:
        assert sum("left" in each for each in told) == told[0]["stops"] > 0
        counts["lines"] += told[0]["lines"]
        counts["stops"] += told[0]["stops"]


def test_a_crash_is_told_with_its_line(tmp_path):
    """The program is made to end Blender at its third stop."""
    notes = tmp_path / "notes"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOLOMORPH_TEST_CRASH_AT", "2")
        told, crashes = tried("3.4", "texels", "OBJECT", notes)
    assert [crash["exit code"] != 0 for crash in crashes] == [True]
    file, line, *_ = crashes[0]["stop"]
    assert (ROOT / "addon" / file).is_file() and line > 0
    assert sum("stop" in each for each in told) == told[0]["stops"]

"""Libraries of small meshes, the command as a process, and what it leaves."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from repository import ROOT

FAULTS = ROOT / "tests" / "batch" / "faults"
BALANCED = "[maps]\nmain = 'balanced'\n[output]\nformats = ['npz', 'obj']\n"
DIFFERING = ("seconds", "processor_seconds", "timings")  # entries of a record that are not results
SECONDS = 120  # for a run of the command on a busy machine


def torus_obj(path, around=24, across=12, turn=0.0):
    """A torus of revolution of quads."""
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around + turn, 2 * np.pi * v / across
    radius = 2 + np.cos(b)
    points = np.stack([radius * np.cos(a), np.sin(b), radius * np.sin(a)], axis=-1).reshape(-1, 3)
    corners = [(u + i) % around * across + (v + j) % across + 1 for i, j in ((0, 0), (0, 1), (1, 1), (1, 0))]
    faces = np.stack(corners, axis=-1).reshape(-1, 4)
    text = "v %r %r %r\n" * len(points) % tuple(points.ravel().tolist())
    path.write_text(text + "f %d %d %d %d\n" * len(faces) % tuple(faces.ravel().tolist()))
    return path


def library(folder, count=8):
    """Tori of rising size, two of them in a folder of their own."""
    (folder / "props").mkdir(parents=True)
    for number in range(count):
        torus_obj(folder / ("props" if number < 2 else "") / f"torus_{number}.obj", 12 + 4 * number, 8, number)
    return folder


def command(*arguments):
    return [sys.executable, "-m", "holomorph", "batch", *map(str, arguments)]


def environment(marks=None):
    """With `marks`, a folder, faults are planted."""
    if marks is None:
        return dict(os.environ)
    path = os.pathsep.join([str(FAULTS), os.environ.get("PYTHONPATH", "")])
    return os.environ | {"PYTHONPATH": path, "HOLOMORPH_TEST_MARKS": str(marks)}


def run(*arguments, marks=None, **options):
    """The finished process, its output as text."""
    return subprocess.run(
        command(*arguments), capture_output=True, text=True, timeout=SECONDS, env=environment(marks), **options
    )


def outputs(out, is_killed=False):
    """{path: bytes} of the assets, without what differs from run to run. Nothing else is left, but by a killed run."""
    assert is_killed or not [path for path in (out / ".work").rglob("*") if path.parent != out / ".work"]
    found = {}
    for path in sorted((out / "assets").rglob("*")):
        if path.is_dir():
            continue
        content = path.read_bytes()
        if path.name == "record.json":
            record = {name: value for name, value in json.loads(content).items() if name not in DIFFERING}
            assert all((path.parent / name).stat().st_size == size for name, size in record["files"].items())
            content = json.dumps(record).encode()
        found[str(path.relative_to(out))] = content
    return found


def statuses(out):
    """{asset: status}"""
    records = [json.loads(path.read_bytes()) for path in sorted((out / "assets").rglob("record.json"))]
    return {record["name"]: record["status"] for record in records}


def children(pid):
    """That of all its threads."""
    return [int(child) for of in Path(f"/proc/{pid}/task").glob("*/children") for child in of.read_text().split()]


def started(process, out, least=1):
    """Waits until a process has done some assets; its workers."""
    end = time.monotonic() + SECONDS
    while process.poll() is None and time.monotonic() < end:
        if len(list((out / "assets").rglob("record.json"))) >= least:
            return children(process.pid)
        time.sleep(0.02)
    raise AssertionError("the run ended too early")


def slowed(meshes, folder):
    """The meshes under names at which the planted fault only waits."""
    for path in meshes.rglob("*.obj"):
        target = folder / path.relative_to(meshes).with_name(f"slow_{path.name}")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(path.read_bytes())
    return folder


def renamed(found):
    return {name.replace("slow_", ""): content.replace(b"slow_", b"") for name, content in found.items()}


def compared(found):
    """Without the keys, which the names are a part of, and the sizes of the reports, which hold the names."""
    result = {}
    for path, content in renamed(found).items():
        if path.endswith("record.json"):
            record = json.loads(content)
            content = json.dumps([record["name"], record["status"], sorted(record["files"])]).encode()
        result[path] = content
    return result

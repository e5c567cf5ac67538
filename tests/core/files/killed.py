"""python killed.py WRITER FOLDER killed|full: writes again and again, until it is done, each time killed one step
later, or on a disk with one page more.

A step is what Python tells its audit hooks before it opens, makes, moves or removes a file. Prints as JSON how each
time ended, and what the files are then: "old", "new", or "half", which they should not be.
"""

import json
import os
import signal
import sys
from pathlib import Path

import families
from holomorph import ProgressiveMesh, Surface
from holomorph.__main__ import main
from solved import surface_of

STEPS = ("open", "os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.chmod", "os.link", "os.truncate")
OLD = b"old" * 30_000


def writers(folder):
    """{name: (the files, a function that writes them)}"""
    mesh = folder / "mesh.obj"
    surface_of(families.torus(20, 15)).write(mesh)
    surface = Surface.read(mesh)
    progressive = ProgressiveMesh(surface)
    meshes = [folder / f"new.{ending}" for ending in ("obj", "ply", "glb")]
    levels = [folder / "level1.obj", folder / "level2.obj"]
    files, report = [folder / "out.glb", folder / "out.json"], folder / "report.json"
    command = [str(mesh), "--main", "balanced", "--output", str(files[0]), "--report", str(files[1])]
    return {
        "mesh": (meshes, lambda: [surface.write(path) for path in meshes] and 0),
        "progressive mesh": ([folder / "new.npz"], lambda: progressive.save(folder / "new.npz")),
        "levels": (levels, lambda: [progressive.level(n).write(path) for n, path in zip((400, 200), levels)] and 0),
        "command": (files, lambda: main(command)),
        "compare": ([report], lambda: main(["compare", str(mesh), str(mesh), "--report", str(report)])),
    }


def kill_at(step, folder):
    """Ends the process at this step of those that concern the folder."""
    left = [step]

    def count(event, arguments):
        if event in STEPS and str(folder) in os.fsdecode(
            arguments[0] if isinstance(arguments[0], (str, bytes)) else ""
        ):
            left[0] -= 1
            if left[0] < 0:
                os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(count)


def fill(folder, pages):
    """Leaves so many pages of a disk."""
    found = os.statvfs(folder)
    with open(folder / "filler", "wb") as file:
        os.posix_fallocate(file.fileno(), 0, max((found.f_bavail - pages) * found.f_frsize, 1))


def in_a_child(prepare, write):
    """How a process that writes ended: 0 if all is written, 1 after an error, or by which signal, negative. prepare :
    called there before"""
    child = os.fork()
    if child == 0:
        for stream in (1, 2):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
        status = 1
        try:
            prepare()
            status = write()
        finally:
            os._exit(status or 0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def states(files, write):
    """A function that tells what the files are, without their seconds."""

    def content(path):
        if path.suffix != ".json":
            return path.read_bytes()
        try:
            found = json.loads(path.read_bytes())
        except ValueError:
            return path.read_bytes()
        return [part.pop("timings") and part for part in found.get("components", [])] or found

    in_a_child(lambda: None, write)
    new = {path: content(path) for path in files}

    def state():
        found = ["old" if content(path) == OLD else "new" if content(path) == new[path] else "half" for path in files]
        return found[0] if len(set(found)) == 1 else "/".join(found)

    return state


def run(name, folder, fault):
    files, write = writers(folder)[name]
    state, told, step = states(files, write), [], 0
    while not told or told[-1][0]:
        for path in files:
            path.write_bytes(OLD)
        if fault == "full":
            fill(folder, step)
        ended = in_a_child(lambda step=step: fault == "full" or kill_at(step, folder), write)
        told.append((ended, state()))
        step += 1
        assert fault == "killed" or not list(folder.glob(".*")), "something is left"
    print(json.dumps(told))


if __name__ == "__main__":
    run(sys.argv[1], Path(sys.argv[2]), sys.argv[3])

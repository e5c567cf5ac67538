"""Objects of scenes: Blender reads them into arrays, and writes maps back, in a process of its own."""

import json
import shutil
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

from .._native import InvalidMesh
from ..files import formats, scenes, whole_file
from . import UsageError

ARRAYS = ".npz"  # vertices, corner_vertices, face_offsets, and seams, the (#S, 2) vertices of the marked edges
OBJECTS = "objects.json"  # [[name, file, number of corners], ...]
SCRIPT = Path(__file__).with_name("in_blender.py")


def opened(task):
    """{file: bytes}: the arrays of each mesh object of a scene, and `OBJECTS`. @throws InvalidMesh"""
    with TemporaryDirectory(dir=task.work) as folder:
        try:
            _run(task.blender, task.path, "read", folder)
        except InvalidMesh as error:
            raise InvalidMesh(scenes.fault(task.path) or str(error)) from error
        return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


def objects(folder):
    """[(name, file, number of corners)] of a scene whose files lie in a folder."""
    listed = json.loads((folder / OBJECTS).read_bytes())
    return [(name, folder / file, corners) for name, file, corners in listed]


def program(wanted):
    """The Blender to use. @throws UsageError"""
    found = shutil.which(wanted or "blender")
    if found is None:
        where = f"there is no program {wanted}" if wanted else "no Blender is on the PATH; name one with --blender"
        raise UsageError(f"Scenes are read, and .blend files written, by Blender: {where}")
    return found


def written(task, mesh):
    """The bytes of a .blend file with the maps of `mesh`, an .npz file's bytes: that of the source, or a new one."""
    with TemporaryDirectory(dir=task.work) as folder:
        arrays, target = Path(folder, "mesh.npz"), Path(folder, "mesh.blend")
        arrays.write_bytes(mesh)
        scene, name = task.scene or (None, Path(task.name).stem)
        _run(task.blender, scene, "write", arrays, target, name)
        whole_file.require_room(target)
        return target.read_bytes()


def _run(blender, scene, *arguments):
    """Runs the script in Blender. @throws InvalidMesh where it ends with an error"""
    options = ["--background", "--factory-startup", "--disable-autoexec", "--python-exit-code", "3"]
    file = [] if scene is None else [str(Path(scene).absolute())]
    importers = [name for path in file for name in formats.IMPORTERS[Path(path).suffix.lower()]]
    opened = [] if importers else file
    words = [*file, *map(str, arguments), *importers]
    command = [blender, *options, *opened, "--python", str(SCRIPT), "--", *words]
    run = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
    if run.returncode != 0:
        said = [line for line in run.stderr.splitlines() if line.strip()] or ["nothing"]
        raise InvalidMesh(f"Blender exited with {run.returncode}; its last message: {said[-1].strip()}")

"""Objects of scenes: Blender reads them into arrays, and writes maps back, in a process of its own."""

import json
import shutil
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from .._native import InvalidMesh
from ..files import formats, scenes, whole_file
from .errors import DONE, REFUSED, UsageError

ARRAYS = ".npz"  # vertices, corner_vertices, face_offsets, and seams, the (#S, 2) vertices of the marked edges
OBJECTS = "objects.json"  # [[name, file, number of corners], ...]
SCRIPT = Path(__file__).with_name("in_blender.py")


@dataclass(frozen=True)
class Opening:
    """A task like those of assets: reads the mesh objects of a scene."""

    name: str
    key: str
    path: Path
    size: int
    folder: Path
    work: Path
    blender: str
    problem: str = ""  # why it cannot be read

    def run(self):
        """(record, files), as `task.Task.run`."""
        start = time.perf_counter()
        with TemporaryDirectory(dir=self.work) as folder:
            try:
                if self.problem:
                    raise InvalidMesh(self.problem)
                _run(self.blender, self.path, "read", folder)
            except InvalidMesh as error:
                told = not self.problem and scenes.fault(self.path) or str(error)
                return {"status": REFUSED, "message": told, "seconds": time.perf_counter() - start}, {}
            files = {path.name: path.read_bytes() for path in Path(folder).iterdir()}
        return {"status": DONE, "message": "", "seconds": time.perf_counter() - start}, files

    def objects(self):
        """[(name, file, number of corners)] of what was read."""
        listed = json.loads((self.folder / OBJECTS).read_bytes())
        return [(name, self.folder / file, corners) for name, file, corners in listed]


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
    command = [blender, *options, *opened, "--python", str(SCRIPT), "--"]
    command += [*file, *map(str, arguments), *importers]
    run = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
    if run.returncode != 0:
        said = [line for line in run.stderr.splitlines() if line.strip()] or ["nothing"]
        raise InvalidMesh(f"Blender exited with {run.returncode}; its last message: {said[-1].strip()}")

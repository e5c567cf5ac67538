"""The work on one source, in one process: from the file of a mesh to the files of its maps, from a scene to meshes.
Blender reads the objects of scenes into arrays, and writes maps back, in a process of its own.
"""

import json
import shutil
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from .. import ProgressiveMesh, Surface, __version__
from .._native import Error, InvalidMesh
from ..files import formats, scenes, textures, whole_file
from ..maps.conformal_image import conformal_image
from ..maps.report import part_count
from . import DONE, REFUSED, UsageError, mapping, picture
from .recipe import Recipe

ARRAYS = ".npz"  # vertices, corner_vertices, face_offsets, and seams, the (#S, 2) vertices of the marked edges
OBJECTS = "objects.json"  # [[name, file, number of corners], ...]
SCRIPT = Path(__file__).with_name("in_blender.py")


@dataclass(frozen=True)
class Limits:
    """Limits for each asset: bytes of memory, seconds, and the threads that its process uses."""

    memory: int = 0
    seconds: float = 1800.0
    threads: int = 1


@dataclass(frozen=True)
class Task:
    """An asset to be mapped, or a scene whose objects are to be read.

    path : a mesh file, or the arrays of an object (.npz, see `ARRAYS`), or a scene; recipe : None of a scene alone;
    scene : of an object, the scene's file and the object's name; problem : why the file cannot be read, or empty
    key : of the results, the same for the same source, recipe and version; folder : where they will be; work : where
    they are written first
    """

    name: str
    key: str
    path: Path
    size: int
    folder: Path
    work: Path
    recipe: Recipe | None = None
    scene: tuple | None = None
    blender: str = ""
    limits: Limits = Limits()
    problem: str = ""

    def run(self):
        """(record, files): what the journal notes, and the bytes of each file. Raises MemoryError, OSError"""
        start, used = time.perf_counter(), time.process_time()
        report, files, timings = {"holomorph": __version__, "name": self.name, "components": []}, {}, []
        status, message = DONE, ""
        try:
            if self.problem:
                raise InvalidMesh(self.problem)
            if self.recipe is None:
                files = opened(self)
            else:
                report, files, timings = _mapped(self)
                if not any(part["done"] for part in report["components"]):
                    raise InvalidMesh(report["components"][0]["reason"])
        except MemoryError:
            raise
        except Error as error:
            status, message = REFUSED, str(error)
        if self.recipe:
            files["report.json"] = (json.dumps(report, indent=1, allow_nan=False) + "\n").encode()
        verdict, skipped = report.get("verdict"), [part for part in report["components"] if not part["done"]]
        return {
            "status": status,
            "message": message,
            "verdict": verdict and verdict["level"],
            "skipped": part_count(skipped),
            "seconds": time.perf_counter() - start,
            "processor_seconds": time.process_time() - used,
            "timings": timings,
        }, files


def _mapped(task):
    """The report, the files, and the timings of each part, which are not results: they differ from run to run."""
    recipe, found = mapping.turned(task.recipe)
    surface, seams = _read(task.path, recipe.output.up)
    parts = mapping.map_parts(surface, recipe, seams, task.limits.threads)
    uv = mapping.main_uv(surface, parts, recipe.maps)
    report = mapping.report(surface, parts, recipe, found, name=task.name)
    timings = [entry.pop("timings", None) for entry in report["components"]]
    maps = [part.map for part in parts if part.map]
    is_turned = any(made.turns != 1 for made in maps)
    files = {"picture.png": picture.png(surface, uv, _is_mapped(surface, parts), surface.up, is_turned)}
    if maps:
        files |= _files(task, surface, mapping.moved(uv, surface, parts, recipe, found), parts)
    return report, files, timings


def _read(path, up):
    """The surface, and the (#S, 2) vertices of the edges that are marked as seams, None in mesh files."""
    if path.suffix != ARRAYS:
        return Surface.read(path, up=up), None
    with np.load(path) as arrays:
        mesh = arrays["vertices"], arrays["corner_vertices"], arrays["face_offsets"]
        return Surface.from_polygons(*mesh, strict=False), arrays["seams"]


def _is_mapped(surface, parts):
    """(#T,) bool: triangles of parts that have a map."""
    faces = [part.surface.face_index for part in parts if part.map]
    mapped = np.concatenate([np.empty(0, int), *faces])
    return np.isin(surface.face_index[surface.triangle_faces], mapped)


def _files(task, surface, uv, parts):
    wanted, texture, files = task.recipe.output.formats, task.recipe.output.texture, {}
    image = None if texture is None else textures.image(texture, surface, uv)  # of the levels, too
    written = formats.WRITERS.keys() & set(wanted)
    for name in written:
        files[f"mesh.{name}"] = formats.content(name, surface, uv, image)
    for number, level in enumerate(_levels(task.recipe.levels, surface, uv), 1):
        for name in written:
            files[f"lod{number}.{name}"] = formats.content(name, level.surface, level.uv, image)
        if "npz" in wanted:
            arrays = {"uv": level.uv, "corners": level.corners, "vertex_index": level.surface.vertex_index}
            files[f"lod{number}.npz"] = formats.npz(level.surface, arrays)
    if "npz" in wanted or "blend" in wanted:
        files["mesh.npz"] = formats.npz(surface, _arrays(task.recipe.maps, surface, uv, parts))
    if "blend" in wanted:
        files["mesh.blend"] = blend_file(task, files["mesh.npz"])
    return files


def _levels(wanted, surface, uv):
    """Each with `ratio` of the triangles of the one before, down to what the topology allows."""
    counts = [max(1, round(len(surface.triangles) * wanted.ratio ** (k + 1))) for k in range(wanted.levels)]
    return ProgressiveMesh(surface).levels_of_detail(uv, counts) if counts else ()


def _arrays(maps, surface, uv, parts):
    """What a .npz file holds besides the mesh; indices lead to the elements of the source."""
    numbered = {f"uv_{n}": form for n, form in enumerate(mapping.form_uvs(surface, parts, maps), 1)}
    index = {name: getattr(surface, name) for name in ("vertex_index", "face_index", "corner_index")}
    seams = [part.surface.vertex_index[part.map.seams] for part in parts if part.map]
    arrays = {"uv": uv, **numbered, **index, "seams": np.concatenate(seams)}  # of the main map
    return arrays | {"shape": _shape(surface, parts)} if maps.shape else arrays


def _shape(surface, parts):
    """(#V, 3) conformal images of the parts, NaN where there is none."""
    points = np.full((len(surface.vertex_index), 3), np.nan)
    for part in parts:
        image = conformal_image(part.structure) if part.structure else None
        if image is not None:
            corners = np.searchsorted(surface.corner_index, part.surface.corner_index)
            points[surface.corner_vertices[corners]] = image[part.surface.corner_vertices]
    return points


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


def blender_program(wanted):
    """The Blender to use. @throws UsageError"""
    found = shutil.which(wanted or "blender")
    if found is None:
        where = f"there is no program {wanted}" if wanted else "no Blender is on the PATH; name one with --blender"
        raise UsageError(f"Scenes are read, and .blend files written, by Blender: {where}")
    return found


def blend_file(task, mesh):
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
    words = [*file, *map(str, arguments), *importers]
    command = [blender, *options, *([] if importers else file), "--python", str(SCRIPT), "--", *words]
    run = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
    if run.returncode != 0:
        said = [line for line in run.stderr.splitlines() if line.strip()] or ["nothing"]
        raise InvalidMesh(f"Blender exited with {run.returncode}; its last message: {said[-1].strip()}")
